//! The global start against the oracle.

use crate::scene::{Scene, probes, repeat};
use palpate::math::Vec3;
use palpate_bake::locator::LocatorOptions;
use palpate_truth::generate::Random;
use palpate_truth::measured::{grouped, measured_if_listed};

/// Of the size: what is proved convex has no minimum but the global one, and the rounding of `f32` is far below this.
const CONVEX: f64 = 1e-5;
/// Of the size: what counts as a miss on any other body.
const ANY: f64 = 1e-4;

/// Of no consequence: see [`convex`].
const UNBOUNDED: f64 = f64::INFINITY;

/// What became of a probe.
struct Tried {
    probe: Vec3,
    /// Of the size.
    excess: f64,
    evaluations: u16,
    complete: bool,
}

/// Random probes: how far off is the worst, and what did the dearest cost?
fn check(scene: &Scene, what: &str, seed: u64, tolerance: f64, pick: impl Fn(&mut Random) -> Vec3 + Sync) -> u16 {
    let oracle = scene.oracle();
    let tried = repeat(probes(), seed, |random| {
        let probe = pick(random);
        let located = scene.body.locate(probe);
        let [(_, truth), ..] = oracle.nearest(probe.as_dvec3(), 0.0)[..] else { unreachable!() };
        let excess = (f64::from(located.distance()) - truth.distance) / scene.size();
        Tried { probe, excess, evaluations: located.evaluations, complete: located.complete }
    });
    let dearest = tried.iter().map(|tried| tried.evaluations).max().unwrap_or_default();
    let total: u64 = tried.iter().map(|tried| u64::from(tried.evaluations)).sum();
    let worst = tried.iter().map(|tried| tried.excess).fold(0.0, f64::max);
    let misses: Vec<_> = tried.iter().filter(|tried| tried.excess > tolerance).collect();
    println!(
        "{}, {what}: {} probes, {} off by more than 1e-5 of the size and {} by more than 1e-4, {worst:.1e} at most; {dearest} evaluations \
         at most, {:.1} in the mean, {} stopped",
        scene.name,
        tried.len(),
        tried.iter().filter(|tried| tried.excess > 1e-5).count(),
        tried.iter().filter(|tried| tried.excess > 1e-4).count(),
        total as f64 / tried.len() as f64,
        tried.iter().filter(|tried| !tried.complete).count()
    );
    for Tried { probe, excess, evaluations, complete } in misses.iter().take(20) {
        println!("  {probe}: {excess:.2e} of the size after {evaluations} evaluations, complete: {complete}");
    }
    assert!(misses.is_empty(), "{}: {} misses {what}", scene.name, misses.len());
    dearest
}

/// Outside, every probe of a convex body. Inside the bound of the evaluations comes first: near the medial axis, where
/// two closest points or a whole arc of them are as good as the same, it may stop the search. Nothing is felt from
/// there until the probe has been in front, and until then the audit goes on.
fn convex(name: &'static str, inside: f64) {
    let scene = Scene::load(name);
    assert!(scene.body.is_convex(), "{name} is to take the short lists");
    let oracle = scene.oracle();
    // The bound is enforced: a search is stopped there, and a stopped one would show as a wrong distance.
    let dearest = check(scene, "outside", 3, CONVEX, |random| scene.outside(&oracle, random, 0.0).0);
    assert!(dearest <= 32);
    measured_if_listed(
        &format!("{} cold starts outside `{name}`: evaluations at most", grouped(probes().into())),
        dearest,
    );
    assert!(check(scene, "inside", 11, inside, |random| scene.behind(random)) <= 32);
}

#[test]
fn the_capped_box_is_found_from_anywhere() {
    convex("capped_box", CONVEX);
}

#[test]
fn the_ellipsoid_is_found_from_outside() {
    convex("ellipsoid_body", UNBOUNDED);
}

#[test]
fn the_sphere_is_found_from_anywhere() {
    convex("sphere_body", CONVEX);
}

#[test]
fn the_rounded_cylinder_is_found_from_outside() {
    convex("rounded_cylinder", UNBOUNDED);
}

/// Coarser than what ships, for the time it takes, so outside only; the whole is [`the_teapot_is_found_from_anywhere`].
#[test]
fn a_coarse_teapot_is_found_from_outside() {
    let scene = Scene::located("teapot", |body| LocatorOptions { depth: 3, samples: 64, ..body.locator_options() });
    check(&scene, "around", 5, ANY, |random| scene.around(random));
}

#[test]
fn the_teapot_is_found_from_anywhere() {
    let scene = Scene::load("teapot");
    check(scene, "around", 5, ANY, |random| scene.around(random));
    check(scene, "behind", 13, ANY, |random| scene.behind(random));
}

#[test]
fn the_ellipsoid_with_poles_is_weighed() {
    Scene::load("ellipsoid_poles");
}
