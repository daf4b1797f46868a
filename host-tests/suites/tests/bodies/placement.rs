//! Where a body lies in its file, and how small its fillets are, costs no digits: closest points in the file's own
//! frame, against the double-precision oracle of the same body at home.
//!
//! `PALPATE_PROBES` sets the number for long runs.

use crate::scene::from_environment;
use glam::DVec3;
use palpate_bake::{BakedBody, Model};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::closest::Solver;
use palpate_truth::generate::Random;
use palpate_truth::generate::models::{moved, rounded_box};
use palpate_truth::oracle::OraclePoint;

/// What the answers may be off by, in sizes.
const RIGHT: f64 = 1e-6;

/// How far off closest points are at most, in sizes, of a body that is moved by so many sizes: in their distance from
/// the probe, or from the surface.
fn worst(text: &str, sizes: DVec3) -> f64 {
    let home = Model::parse(text, "home").unwrap();
    assert_eq!(home.centre, DVec3::ZERO);
    let size = f64::from(BakedBody::new(&home, "home").unwrap().size);
    // In millimetres, as a file has it: all digits that the sum has.
    let offset = (1e3 * size * sizes).round();
    let model = Model::parse(&moved(text, offset.to_array()), "moved").unwrap();
    let baked = BakedBody::new(&model, "moved").unwrap();
    let oracle = BodyOracle::new(&home.patches);
    let mut random = Random::new(7);
    let mut place = || {
        let patch = &home.patches[random.below(home.patches.len())];
        let [u, v] = [random.between(0.0, 1.0), random.between(0.0, 1.0)];
        let on = OraclePoint::evaluate(patch, u, v).point;
        on + random.direction() * size * random.scale(1e-4, 0.5)
    };
    let count = from_environment("PALPATE_PROBES", 60);
    let given: Vec<_> = (0..count).map(|_| place() + 1e-3 * offset).collect();
    // As `closest` does.
    let probes: Vec<_> = given.iter().map(|given| (*given - model.centre).as_vec3()).collect();
    let wide: Vec<_> = probes.iter().map(|probe| probe.as_dvec3()).collect();
    let options = baked.locator_options().reaching(baked.sizes_beyond(&wide));
    let baked = baked.located_for(&wide, &options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    let solver = Solver::new(&body, &baked);
    let mut worst: f64 = 0.0;
    for (given, probe) in given.into_iter().zip(probes) {
        let (found, _) = solver.cold(probe);
        let point = found.point.as_dvec3() + model.centre;
        let truth = oracle.closest(given - 1e-3 * offset);
        let farther = point.distance(given) - truth.distance();
        let off_surface = oracle.closest(point - 1e-3 * offset).distance();
        worst = worst.max(farther.abs() / size).max(off_surface / size);
    }
    worst
}

/// In its place, its origin in a corner, and up to a hundred sizes off along every axis.
const PLACES: [DVec3; 4] = [DVec3::ZERO, DVec3::splat(0.5), DVec3::new(-10.0, 3.0, 0.5), DVec3::new(99.0, -99.0, 99.0)];

fn is_right(name: &str, text: &str) {
    for sizes in PLACES {
        let worst = worst(text, sizes);
        println!("{name} at {sizes}: {worst:.1e} of the size");
        assert!(worst <= RIGHT, "{name} at {sizes} sizes is off by {worst:e} of its size");
    }
}

#[test]
fn a_box_with_small_fillets_is_right_wherever_it_lies() {
    is_right("box", &rounded_box([120.0, 80.0, 40.0], 0.5));
}

#[test]
fn a_rod_is_right_from_its_end_and_wherever_it_lies() {
    is_right("rod", &rounded_box([5.0, 5.0, 500.0], 1.0));
}

#[test]
fn fillets_may_be_as_small_as_the_patches_that_are_refused() {
    is_right("tiny fillets", &rounded_box([100.0, 60.0, 30.0], 2e-3));
}
