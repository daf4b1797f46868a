//! Walks around the bodies: the tracker keeps to the right feature, and no switch moves the witness point away.

use crate::scene::{Scene, from_environment};
use crate::tour::{owning, tour};
use glam::DVec3;
use palpate::body::Feature;
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_truth::body_oracle::claims;
use palpate_truth::measured::{grouped, measured_if_listed};
use rayon::prelude::*;

/// Ticks for which another feature than the owner may be active at a stretch. A probe that changes region is a step
/// beyond the border; the closest points of the sides lag a few steps behind, and a way over a vertex takes one switch
/// a tick: edge, vertex, edge, face.
const LATE: u32 = 6;
/// Seconds.
const PERIOD: f64 = 2.5e-4;

/// A tick.
struct Tick {
    probe: Vec3,
    feature: Feature,
    /// From the witness point to the probe after the tick, metres.
    distance: f32,
    /// By how much the distance rose, metres.
    rise: f32,
    switched: bool,
}

/// Points of a line in steps of one length.
fn along(line: &[DVec3], step: f64) -> impl Iterator<Item = DVec3> {
    let mut ahead = 0.0;
    line.windows(2).flat_map(move |pair| {
        let length = pair[0].distance(pair[1]);
        let first = ahead;
        let count = if first < length { ((length - first) / step).floor() as usize + 1 } else { 0 };
        ahead = first + count as f64 * step - length;
        let (from, direction) = (pair[0], (pair[1] - pair[0]).normalize_or_zero());
        (0..count).map(move |index| from + direction * (first + index as f64 * step))
    })
}

/// What the tracker does on the way, from its first located tick.
fn track(scene: &Scene, way: impl Iterator<Item = DVec3>) -> Vec<Tick> {
    let mut state = scene.body.start();
    let mut ticks = Vec::new();
    for probe in way.map(|probe| probe.as_vec3()) {
        let before = state.witness.surface.point.distance(probe);
        let was_located = state.is_located;
        let step = scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD as f32);
        let distance = state.witness.surface.point.distance(probe);
        if was_located {
            let (rise, feature) = (distance - before, state.feature);
            ticks.push(Tick { probe, feature, distance, rise, switched: step.switched });
        }
    }
    ticks
}

fn check(name: &'static str) {
    let scene = Scene::load(name);
    let oracle = scene.oracle();
    let size = scene.size();
    let line = tour(scene);
    let length: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    // Once around, whatever the number of ticks.
    let step = length / f64::from(from_environment("PALPATE_TICKS", 20_000));
    let ticks = track(scene, along(&line, step));
    // Of each tick: whether another feature is active than owns the probe, and how much too long the distance is.
    let judged: Vec<(bool, f64)> = ticks
        .par_iter()
        .map(|tick| {
            let probe = tick.probe.as_dvec3();
            let truth = oracle.nearest(probe, 0.0)[0].1.distance;
            let claims = claims(&scene.body, tick.probe, |face| oracle.height(face, probe) < 0.0);
            let right = claims.features.contains(&tick.feature) || claims.margin < 2e-6 * scene.body.size();
            (!right, (f64::from(tick.distance) - truth) / size)
        })
        .collect();
    let (mut streak, mut longest, mut late) = (0, 0, 0);
    for (wrong, _) in &judged {
        streak = if *wrong { streak + 1 } else { 0 };
        longest = longest.max(streak);
        late += u32::from(*wrong);
    }
    let excess = judged.iter().map(|(_, excess)| *excess).fold(0.0, f64::max);
    let rise = |at_switch: bool| {
        let chosen = ticks.iter().filter(|tick| tick.switched || !at_switch);
        chosen.map(|tick| f64::from(tick.rise) / size).fold(0.0, f64::max)
    };
    let (owners, smooth) = owning(scene);
    let missed: Vec<_> = owners.iter().filter(|owner| !ticks.iter().any(|tick| tick.feature == **owner)).collect();
    let crosses = |[a, b]: &[u16; 2]| {
        let [a, b] = [Feature::Face(*a), Feature::Face(*b)];
        ticks.windows(2).any(|pair| {
            let both = [pair[0].feature, pair[1].feature];
            both == [a, b] || both == [b, a]
        })
    };
    let not_crossed: Vec<_> = smooth.iter().filter(|faces| !crosses(faces)).collect();
    println!(
        "{name}: {} ticks of {:.1} um ({:.2} m/s), {} switches; {} of {} features that own a region visited, {} of {} smooth edges crossed; \
         another feature than the owner in {late} ticks, at most {longest} on end; distance too long by {excess:.1e} of the size at most; \
         it rose by {:.1e} of it at most, at a switch by {:.1e}",
        ticks.len(),
        1e6 * step,
        step / PERIOD,
        ticks.iter().filter(|tick| tick.switched).count(),
        owners.len() - missed.len(),
        owners.len(),
        smooth.len() - not_crossed.len(),
        smooth.len(),
        rise(false),
        rise(true),
    );
    assert!(longest <= LATE, "{name}: another feature for {longest} ticks");
    // 64 units of the coordinates, as the tracker allows; they are up to twice the size.
    assert!(rise(false) < 64.0 * f64::from(f32::EPSILON) * 2.0, "{name}: rise {:e}", rise(false));
    assert!(missed.is_empty(), "{name}: never on {missed:?}");
    assert!(not_crossed.is_empty(), "{name}: never across {not_crossed:?}");
    let count = grouped(from_environment("PALPATE_TICKS", 20_000).into());
    measured_if_listed(&format!("a walk of {count} ticks around `{name}`: ticks on end with another feature"), longest);
    measured_if_listed(
        &format!("a walk of {count} ticks around `{name}`: rise at a switch"),
        format!("{:.1e}", rise(true)),
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
