//! The global start against the oracle.

use crate::scene::{Scene, probes};
use glam::DVec3;
use palpate::math::Vec3;

/// The probes in a list: how far off is the worst, and what did the dearest cost?
fn check(scene: &Scene, name: &str, what: &str, probes: impl Iterator<Item = Vec3>, tolerance: f64) -> u16 {
    let oracle = scene.oracle();
    let size = f64::from(scene.body.size());
    let (mut worst, mut count, mut dearest, mut incomplete, mut total) = (0.0_f64, 0_u32, 0, 0_u32, 0_u64);
    for probe in probes {
        let located = scene.body.locate(probe);
        let truth = oracle.closest(probe.as_dvec3());
        let off = (f64::from((2.0 * located.half_squared).sqrt()) - truth.distance()) / size;
        count += 1;
        worst = worst.max(off);
        dearest = dearest.max(located.evaluations);
        total += u64::from(located.evaluations);
        incomplete += u32::from(!located.complete);
        assert!(
            off < tolerance,
            "{name}: {probe} is off by {off:e} of the size: {located:?}, {:?}",
            truth.feet[truth.nearest]
        );
    }
    println!(
        "{name}, {what}: {count} probes, off by {worst:.1e} of the size at most, {dearest} evaluations at most, {:.1} in the mean, \
         {incomplete} stopped",
        total as f64 / f64::from(count)
    );
    dearest
}

/// Probes up to a fifth of the size behind the surface, along normals at random places.
fn behind(scene: &Scene, count: u32) -> impl Iterator<Item = Vec3> {
    use palpate_host::generate::Random;
    use palpate_host::oracle::Surface;
    let mut random = Random::new(11);
    let size = f64::from(scene.body.size());
    let pick = move || {
        let patch =
            &scene.patches[(random.between(0.0, scene.patches.len() as f64) as usize).min(scene.patches.len() - 1)];
        let surface = Surface::evaluate(patch, random.between(0.0, 1.0), random.between(0.0, 1.0));
        let normal = surface.normal(patch.flip);
        let depth = 0.2 * size * random.between(0.0, 1.0);
        surface.point - if normal.is_finite() { normal } else { DVec3::ZERO } * depth
    };
    std::iter::repeat_with(pick).map(|probe| probe.as_vec3()).take(count as usize)
}

fn convex(name: &str) {
    let scene = Scene::load(name);
    // The bound is enforced: a search is stopped there, and a stopped one would show as a wrong distance.
    assert!(check(&scene, name, "outside", scene.outside(probes(), 3), 1e-5) <= 32);
    assert!(check(&scene, name, "inside", behind(&scene, probes()), 1e-4) <= 32);
}

#[test]
fn the_capped_box_is_found_from_anywhere() {
    convex("capped_box");
}

#[test]
fn the_ellipsoid_is_found_from_anywhere() {
    convex("ellipsoid_body");
}

#[test]
fn the_rounded_cylinder_is_found_from_anywhere() {
    convex("rounded_cylinder");
}

#[test]
fn the_teapot_is_found_from_anywhere() {
    let scene = Scene::load("teapot");
    check(&scene, "teapot", "around", scene.around(probes(), 5), 1e-4);
    check(&scene, "teapot", "behind", behind(&scene, probes()), 1e-4);
}
