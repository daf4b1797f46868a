//! Walks around the bodies: the tracker keeps to the right feature, and no switch moves the witness point away.

use crate::scene::Scene;
use glam::DVec3;
use palpate::body::Feature;
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_host::bodies::claims;
use palpate_host::generate::Random;

const TICKS: u32 = 100_000;
/// 0.1 m/s at 4 kHz.
const STEP: f64 = 0.1 / 4000.0;
/// Ticks for which another feature than the owner may be active at a stretch. A probe that changes region is 25 µm beyond the border; the
/// closest points of the sides lag one step behind, and a way over a vertex takes one switch a tick: edge, vertex, edge, face.
const LATE: u32 = 6;

/// A smooth walk outside a convex body: towards one random target after another, pushed away when it would enter.
fn walk(scene: &Scene, seed: u64, mut visit: impl FnMut(Vec3)) {
    let mut random = Random::new(seed);
    let oracle = scene.oracle();
    let centre = 0.5 * (scene.low + scene.high);
    let reach = (scene.high - scene.low).max_element();
    let mut aim = || centre + reach * DVec3::from_array(std::array::from_fn(|_| random.between(-0.7, 0.7)));
    let (mut target, mut velocity) = (aim(), DVec3::ZERO);
    let mut at = centre + reach * DVec3::new(0.6, 0.5, 0.4);
    for _ in 0..TICKS {
        if at.distance(target) < 0.1 * reach {
            target = aim();
        }
        velocity = (velocity + (target - at).normalize() * 0.01 * STEP).clamp_length_max(STEP);
        at += velocity;
        let truth = oracle.closest(at);
        // Keep 0.2 mm off: inside, regions are another matter.
        let away = at - truth.point();
        if truth.is_inside_convex() || truth.distance() < 2e-4 {
            let outward = if truth.is_inside_convex() { -away } else { away }.normalize();
            at = truth.point() + outward * 2e-4;
            velocity -= outward * velocity.dot(outward).min(0.0);
        }
        visit(at.as_vec3());
    }
}

fn check(name: &str) {
    let scene = Scene::load(name);
    let oracle = scene.oracle();
    let size = scene.body.size();
    let mut state = scene.body.start();
    let (mut switches, mut streak, mut longest, mut ticks) = (0_u32, 0_u32, 0_u32, 0_u32);
    let mut visited = std::collections::BTreeSet::new();
    let (mut worst, mut worst_rise) = (0.0_f64, 0.0_f32);
    walk(&scene, 7, |probe| {
        let before = state.witness.surface.point.distance(probe);
        let was_located = state.is_located;
        let step = scene.body.step(&Controller::CERTIFIED, &mut state, Probe::at(probe), 2.5e-4);
        if !was_located {
            return;
        }
        ticks += 1;
        let after = state.witness.surface.point.distance(probe);
        worst_rise = worst_rise.max((after - before) / size);
        switches += u32::from(step.switched);
        visited.insert(state.feature.code());
        let truth = oracle.closest(probe.as_dvec3());
        worst = worst.max((f64::from(after) - truth.distance()) / f64::from(size));
        let claims = claims(&scene.body, &truth, probe);
        let right = claims.features.contains(&state.feature) || claims.margin < 2e-6 * size;
        streak = if right { 0 } else { streak + 1 };
        longest = longest.max(streak);
        assert!(streak <= LATE, "{name}: {probe} belongs to {:?}, not {:?}", claims.features, state.feature);
    });
    let all = scene.body.faces().len() + scene.body.edges().len() + scene.body.vertices().len();
    println!(
        "{name}: {ticks} ticks, {switches} switches, {} of {all} features visited, another feature at most {longest} ticks, distance \
         at most {worst:.1e} of the size too long, rise at most {worst_rise:.1e} of it",
        visited.len()
    );
    // 64 units of the coordinates, as the tracker allows.
    assert!(worst_rise < 64.0 * f32::EPSILON * 2.0, "{name}: rise {worst_rise:e}");
    assert!(
        visited.iter().any(|code| *code == Feature::Face(0).code()) && visited.len() > scene.body.faces().len() / 2
    );
}

#[test]
fn a_walk_around_the_capped_box() {
    check("capped_box");
}

#[test]
fn a_walk_around_the_ellipsoid() {
    check("ellipsoid_body");
}

#[test]
fn a_walk_around_the_rounded_cylinder() {
    check("rounded_cylinder");
}
