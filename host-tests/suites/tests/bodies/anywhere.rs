//! Single queries near and far around bodies that nobody tuned anything to: the distance, the side, and that what is
//! called converged is. `PALPATE_PROBES` sets how many, `PALPATE_MODEL` names a file to be asked instead.

use crate::scene::from_environment;
use glam::DVec3;
use palpate_bake::locator::StoredSurface;
use palpate_bake::topology::bounding_box;
use palpate_bake::{BakedBody, Model};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::closest::{Found, Solver, Status};
use palpate_truth::generate::Random;
use palpate_truth::generate::bodies::{self, DrawnBody};
use palpate_truth::measured::{grouped, measured_if_listed};
use palpate_truth::oracle::{Oracle, OraclePoint};
use rayon::prelude::*;
use std::path::PathBuf;

/// Of the size and the distance: what a search at the resolution of `f32` leaves.
const EXACT: f64 = 1e-5;
/// Probes within this of the surface, in sizes, are on it as far as `f32` can tell.
const ON_SURFACE: f64 = 1e-6;
/// Farthest probes, in sizes.
const FAR: f64 = 5.0;

/// A probe, what was found, its distance in metres, by how much that is off, and whether it is inside.
type Asked<'a> = (&'a DVec3, (Found, f64, f64, Option<bool>));

/// A third each near the surface, in the box around the body, and far off.
fn draw(model: &Model, [low, high]: [DVec3; 2], random: &mut Random) -> DVec3 {
    let size = (high - low).max_element();
    match random.below(3) {
        0 => {
            let patch = &model.patches[random.below(model.patches.len())];
            // A fifth of them over a border.
            let mut place = || match random.below(10) {
                0 => 0.0,
                1 => 1.0,
                _ => random.between(0.0, 1.0),
            };
            let [u, v] = [place(), place()];
            OraclePoint::evaluate(patch, u, v).point + random.direction() * size * random.scale(1e-4, 0.2)
        }
        1 => low + (high - low) * DVec3::from_array(std::array::from_fn(|_| random.between(-0.3, 1.3))),
        _ => 0.5 * (low + high) + random.direction() * size * random.between(0.5, FAR),
    }
}

/// What is wrong with single queries around a body, line by line.
fn wrong(model: &Model, name: &str, count: u32) -> Vec<String> {
    let mut random = Random::new(71);
    let bounds: [DVec3; 2] = bounding_box(&model.patches).into();
    let probes: Vec<DVec3> = (0..count).map(|_| draw(model, bounds, &mut random).as_vec3().as_dvec3()).collect();
    let baked = BakedBody::new(model, name).unwrap_or_else(|error| panic!("{error}"));
    let options = baked.locator_options();
    let baked = baked.located_for(&probes, &options, &|_, _| ()).unwrap_or_else(|error| panic!("{error}"));
    let body = baked.to_body().unwrap_or_else(|error| panic!("{error}"));
    let (solver, oracle) = (Solver::new(&body, &baked), BodyOracle::new(&model.patches));
    let (size, is_closed) = (f64::from(body.size()), baked.topology.is_closed());
    let query = |probe: &DVec3| {
        let (found, _) = solver.cold(probe.as_vec3());
        let distance = oracle.nearest(*probe, 0.0)[0].1.distance;
        let off = (found.point.as_dvec3().distance(*probe) - distance) / (size + distance);
        let inside = (is_closed && distance > ON_SURFACE * size).then(|| oracle.is_inside(*probe)).flatten();
        (found, distance, off, inside)
    };
    let asked: Vec<Asked<'_>> = probes.par_iter().map(|probe| (probe, query(probe))).collect();
    let far = asked.iter().filter(|(_, (found, ..))| found.status == Status::Far);
    let of = |status: Status| {
        let those = asked.iter().filter(move |(_, (found, ..))| found.status == status);
        those.map(|(_, (_, _, off, _))| off.abs()).fold(0.0, f64::max)
    };
    println!(
        "{name}: {count} queries, off by {:.1e} at most where converged; {} are far, off by {:.1e} at most; {} sides are sure",
        of(Status::Converged),
        far.count(),
        of(Status::Far),
        asked.iter().filter(|(_, (_, _, _, inside))| inside.is_some()).count()
    );
    let is_wrong = |(_, (found, _, off, inside)): &&Asked<'_>| {
        (found.status == Status::Converged && off.abs() > EXACT)
            || inside.is_some_and(|inside| inside != found.is_inside)
    };
    let line = |(probe, (found, distance, off, inside)): &Asked<'_>| {
        format!("{name}: {probe:?}: {distance:e} m, off by {off:.1e}, inside {inside:?}; {found:?}")
    };
    asked.iter().filter(is_wrong).map(line).collect()
}

fn none_wrong(wrong: &[String]) {
    assert!(wrong.is_empty(), "{} are wrong: {}", wrong.len(), wrong[..wrong.len().min(5)].join("\n"));
}

#[test]
fn single_queries_around_ten_bodies_are_right_near_and_far() {
    let count = from_environment("PALPATE_PROBES", 200);
    let query = |DrawnBody { name, text }: &DrawnBody| {
        wrong(&Model::parse(text, name).unwrap_or_else(|error| panic!("{error}")), name, count)
    };
    let all: Vec<DrawnBody> = bodies::ten().into_iter().chain([bodies::tetrahedron()]).collect();
    none_wrong(&all.iter().flat_map(query).collect::<Vec<_>>());
}

/// An open patch as wavy as its net allows, of 80 mm, with weights up to `heaviest`: near its corners there are minima
/// inside, on two sides and at the corner itself, all within a step of the locator's grid.
pub fn wavy(seed: u64, heaviest: f64) -> String {
    let mut random = Random::new(seed);
    let place = [0.0, 2.7, 12.0, 28.0, 50.0, 67.0, 78.0, 80.0];
    let mut point = |x: f64, y: f64| {
        let z = random.between(-8.0, 8.0);
        let weight = if heaviest > 1.0 { random.scale(1.0, heaviest) } else { 1.0 };
        format!("[{x}, {y}, {z}, {weight}]")
    };
    let mut row = |x: &f64| format!("[{}]", place.map(|y| point(*x, y)).join(", "));
    let rows: Vec<_> = place.iter().map(&mut row).collect();
    let knots = "[0.0, 0.0, 0.0, 0.0, 0.1, 0.35, 0.6, 0.92, 1.0, 1.0, 1.0, 1.0]";
    format!(
        "unit = \"mm\"\n[[patch]]\ndegree = [3, 3]\nknots_u = {knots}\nknots_v = {knots}\npoints = [{}]\n",
        rows.join(", ")
    )
}

#[test]
fn single_queries_around_open_wavy_patches_are_right_near_and_far() {
    let count = from_environment("PALPATE_PROBES", 2_000);
    let query = |seed: u64| {
        let model = Model::parse(&wavy(seed, 1.0), "wavy").unwrap_or_else(|error| panic!("{error}"));
        wrong(&model, "wavy", count)
    };
    none_wrong(&(0..2).flat_map(query).collect::<Vec<_>>());
}

/// Of the size: a rest in `f32`.
const AT_REST: f64 = 1e-6;

/// Where a patch is nearly an arc around the probe, the distance hardly changes along it and no step promises much.
#[test]
fn what_is_called_complete_near_a_focus_is_at_rest() {
    let count = from_environment("PALPATE_PROBES", 2_000);
    let run = |heaviest: f64| {
        let model = Model::parse(&wavy(3, heaviest), "wavy").unwrap_or_else(|error| panic!("{error}"));
        let (patch, mut random) = (&model.patches[0], Random::new(5));
        let mut focus = || {
            let at = OraclePoint::evaluate(patch, random.between(0.0, 1.0), random.between(0.0, 1.0));
            let curvature = at.principal_curvatures(false)[random.below(2)];
            (at.point - at.normal(false) * random.between(0.97, 1.01) / curvature).as_vec3().as_dvec3()
        };
        let near = |probe: &DVec3| probe.length() < 0.08;
        let probes: Vec<DVec3> = std::iter::repeat_with(&mut focus).filter(near).take(count as usize).collect();
        let baked = BakedBody::new(&model, "wavy").unwrap();
        let options = baked.locator_options();
        let baked = baked.located_for(&probes, &options, &|_, _| ()).unwrap();
        let body = baked.to_body().unwrap();
        let oracle = Oracle::new(patch);
        let surfaces: Vec<_> = baked.faces.iter().map(|face| StoredSurface::new(&face.patch)).collect();
        let left = |probe: &DVec3| {
            let found = body.locate(probe.as_vec3());
            let [lower, upper] = [[0.0; 2], [1.0; 2]];
            let surface = &surfaces[usize::from(found.face)];
            let rest = surface.descend(*probe, found.parameters.map(f64::from), [lower, upper]).distance;
            let nearest = oracle.closest(*probe).distance.min(rest);
            let off = [rest, nearest].map(|from| (f64::from(found.distance()) - from) / f64::from(body.size()));
            (off, found.complete)
        };
        let (complete, given_up): (Vec<_>, Vec<_>) = probes.par_iter().map(left).partition(|(_, complete)| *complete);
        let [worst, off] = [0, 1].map(|from| complete.iter().map(|(off, _)| off[from]).fold(0.0, f64::max));
        println!(
            "weights to {heaviest}: {} complete, {worst:.1e} from rest at most; {} not",
            complete.len(),
            given_up.len()
        );
        assert!(given_up.len() < probes.len() / 10, "{} are given up", given_up.len());
        assert!(worst < AT_REST, "{worst:.1e} of the size from rest");
        let what = format!("{} cold queries at foci of a wavy patch, weights to {heaviest}", grouped(count.into()));
        measured_if_listed(&format!("{what}: maximum error"), format!("{off:.1e}"));
        measured_if_listed(&format!("{what}: given up"), given_up.len());
    };
    [1.0, 10.0].into_iter().for_each(run);
}

#[test]
#[ignore = "for the file that PALPATE_MODEL names"]
fn single_queries_around_a_model_file_are_right_near_and_far() {
    let file = PathBuf::from(std::env::var_os("PALPATE_MODEL").expect("PALPATE_MODEL names a file"));
    let model = Model::read(&file).unwrap_or_else(|error| panic!("{error}"));
    none_wrong(&wrong(&model, &file.display().to_string(), from_environment("PALPATE_PROBES", 200)));
}
