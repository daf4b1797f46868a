//! Inside or outside, from the feature that holds the closest point, on bodies drawn from a seed: against the winding
//! number of polyhedra, and the profile of bodies of revolution. Sharp, skinny, hollow and saddle-shaped vertices, each
//! the pole of some patch.
//!
//! `PALPATE_PROBES` and `PALPATE_BODIES` set the numbers for long runs.

mod axes;
mod shapes;

use glam::{DVec2, DVec3};
use palpate_bake::{BakedBody, Model};
use palpate_truth::closest::Solver;
use palpate_truth::generate::Random;
use shapes::{Shape, hull, star};

fn from_environment(name: &str, default: usize) -> usize {
    std::env::var(name).ok().and_then(|count| count.parse().ok()).unwrap_or(default)
}

/// Probes within this of the surface, in sizes, are on it as far as `f32` can tell.
const ON_SURFACE: f64 = 1e-6;
/// The distance is right to this, in sizes: what a search at the resolution of `f32` leaves.
const EXACT: f64 = 1e-5;

/// A probe around a body: anywhere, near a vertex, or near a vertex and hardly off it.
fn draw(shape: &Shape, vertices: &[DVec3], random: &mut Random) -> DVec3 {
    let [low, high] = shape.bounds();
    let size = (high - low).max_element();
    if random.happens(0.5) {
        let at = DVec3::from_array(std::array::from_fn(|_| random.between(-0.45, 1.45)));
        return low + (high - low) * at;
    }
    vertices[random.below(vertices.len())] + random.direction() * size * random.scale(1e-4, 0.4)
}

/// How many probes of a body come out wrong.
fn wrong(shape: &Shape, random: &mut Random) -> usize {
    let text = shape.model(random);
    let model = Model::parse(&text, "drawn").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let baked = BakedBody::new(&model, "drawn").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let vertices = shape.vertices();
    let probes: Vec<_> = (0..from_environment("PALPATE_PROBES", 200))
        .map(|_| (1e-3 * draw(shape, &vertices, random) - model.centre).as_vec3())
        .collect();
    let wide: Vec<_> = probes.iter().map(|probe| probe.as_dvec3()).collect();
    let options = baked.locator_options();
    let baked = baked.located_for(&wide, &options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    let solver = Solver::new(&body, &baked);
    let mut wrong = 0;
    for probe in probes {
        let (found, _) = solver.cold(probe);
        let (distance, is_inside) = shape.truth(1e3 * (probe.as_dvec3() + model.centre));
        let size = 1e3 * f64::from(body.size());
        let off = (1e3 * found.point.as_dvec3().distance(probe.as_dvec3()) - distance) / size;
        let is_wrong_side = distance > ON_SURFACE * size && is_inside.is_some_and(|inside| inside != found.is_inside);
        if is_wrong_side || off.abs() > EXACT {
            println!(
                "{probe:?}: inside {is_inside:?}, found {:?}; {distance} mm away, off by {off:.1e} of the size, {:?}, {} evaluations",
                found.is_inside, found.status, found.evaluations
            );
            wrong += 1;
        }
    }
    if wrong > 0 {
        println!("{text}");
    }
    wrong
}

fn none_wrong(seed: u64, bodies: usize, draw: impl Fn(usize, &mut Random) -> Shape) {
    let bodies = from_environment("PALPATE_BODIES", bodies);
    let mut random = Random::new(seed);
    let wrong: usize = (0..bodies).map(|index| wrong(&draw(index, &mut random), &mut random)).sum();
    assert_eq!(wrong, 0);
}

/// Squeezed along one axis or two: needles and flakes.
fn squeezed(faces: Vec<[DVec3; 3]>, random: &mut Random) -> Vec<[DVec3; 3]> {
    let scale = DVec3::new(1.0, random.scale(0.05, 1.0), random.scale(0.05, 1.0));
    faces.into_iter().map(|face| face.map(|corner| corner * scale)).collect()
}

#[test]
fn tetrahedra_and_octahedra_have_an_inside() {
    none_wrong(1, 6, |index, random| {
        let points: Vec<_> = if index % 2 == 0 {
            (0..4).map(|_| random.direction() * random.between(15.0, 30.0)).collect()
        } else {
            [DVec3::X, DVec3::Y, DVec3::Z]
                .iter()
                .flat_map(|axis| [*axis, -*axis])
                .map(|axis| axis * random.between(15.0, 30.0))
                .collect()
        };
        Shape::Polyhedron(squeezed(hull(&points), random))
    });
}

#[test]
fn convex_polyhedra_have_an_inside() {
    none_wrong(2, 3, |_, random| {
        let points: Vec<_> = (0..8).map(|_| random.direction() * random.between(15.0, 30.0)).collect();
        Shape::Polyhedron(squeezed(hull(&points), random))
    });
}

#[test]
fn polyhedra_with_valleys_and_saddles_have_an_inside() {
    none_wrong(3, 2, |_, random| Shape::Polyhedron(star(random)));
}

#[test]
fn cones_and_conical_pits_have_an_inside() {
    none_wrong(4, 4, |index, random| {
        let [radius, height] = [random.between(5.0, 20.0), random.between(5.0, 40.0)];
        let ends = match index % 4 {
            // A cone on a disc, a needle, a double cone, a cylinder with a pit.
            0 => vec![DVec2::ZERO, DVec2::new(radius, 0.0), DVec2::new(0.0, height)],
            1 => vec![DVec2::ZERO, DVec2::new(1.0, 0.0), DVec2::new(0.0, 40.0)],
            2 => vec![DVec2::new(0.0, -height), DVec2::new(radius, 0.0), DVec2::new(0.0, 0.3 * height)],
            _ => vec![DVec2::ZERO, DVec2::new(radius, 0.0), DVec2::new(radius, height), DVec2::new(0.0, 0.4 * height)],
        };
        Shape::Revolved(ends)
    });
}
