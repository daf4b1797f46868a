//! From a start on any face, the far side included, the tracker ends at the closest point of a convex body. The law
//! alone does not: over the far side a probe has a second resting place, which only the audit leaves.

use crate::scene::{Scene, from_environment, repeat};
use palpate::track::{Controller, Probe};

/// Of the size: rest of the way that the first-order law has still to go when it counts as there.
const ARRIVED: f64 = 1e-5;
/// Ticks that are waited for: far more than any start takes.
const PATIENCE: u32 = 20_000;

/// Ticks from random places on each face to the closest point of a random probe outside.
fn check(name: &'static str) {
    let scene = Scene::load(name);
    let oracle = scene.oracle();
    let starts = scene.body.faces().len() as u16;
    let probes = from_environment("PALPATE_STARTS", 100);
    let run = |face: u16| {
        repeat(probes, 100 + u64::from(face), |random| {
            let (probe, nearest) = scene.outside(&oracle, random, 0.0);
            let truth = nearest[0].1.distance;
            let mut state =
                scene.body.start_on(face, [random.between(0.0, 1.0) as f32, random.between(0.0, 1.0) as f32]);
            let arrived = (1..=PATIENCE).find(|_| {
                scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 2.5e-4);
                f64::from(state.witness.surface.point.distance(probe)) - truth < ARRIVED * scene.size()
            });
            arrived.unwrap_or_else(|| {
                panic!("{name}: from face {face} the probe {probe} is still at {:?} {:?}", state.feature, state.witness)
            })
        })
    };
    let mut ticks: Vec<u32> = (0..starts).flat_map(run).collect();
    ticks.sort_unstable();
    println!(
        "{name}: {starts} faces, {probes} probes from each: all at the closest point, after {} ticks in the median and {} at most",
        ticks[ticks.len() / 2],
        ticks[ticks.len() - 1]
    );
}

#[test]
fn every_start_on_the_capped_box_leads_to_the_closest_point() {
    check("capped_box");
}

#[test]
fn every_start_on_the_ellipsoid_leads_to_the_closest_point() {
    check("ellipsoid_body");
}

#[test]
fn every_start_on_the_rounded_cylinder_leads_to_the_closest_point() {
    check("rounded_cylinder");
}
