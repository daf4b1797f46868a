//! Rows of successive ticks around ten bodies that nobody tuned anything to, and around those that ship: the errors of
//! distance and normal. The table stands in `docs/reference/measured.md`.

use crate::ring::Ring;
use crate::scene::Scene;
use glam::DVec3;
use palpate::body::BodyWitness;
use palpate::math::Vec3;
use palpate::track::{Controller, Probe};
use palpate_bake::{BakedBody, Model};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::closest::{Found, Solver, Status};
use palpate_truth::generate::bodies::{DrawnBody, ten};
use palpate_truth::measured::{Spread, measured_table};
use rayon::prelude::*;

/// Metres in front of the surface.
const GAP: f64 = 5e-4;
/// Ticks a second.
const RATE: f64 = 4_000.0;
/// The probe's speeds, m/s.
const SPEEDS: [f64; 2] = [0.3, 1.0];
/// Rings around each body, each in a plane of its own through the origin.
const RINGS: u64 = 4;

/// Of the size: errors of the distance in a row that is not late.
const EXACT: f64 = 1e-5;

/// A line of the table: errors at one and at four ticks a row, in sizes.
struct Line {
    body: &'static str,
    speed: f64,
    rows: usize,
    errors: [Spread; 2],
    /// Rows that were felt, though all are in free air.
    felt: usize,
    /// The most rows on end that are off by more than [`EXACT`] at one tick a row.
    late: usize,
    is_convex: bool,
}

/// The distance to a probe, and a row that says which it was.
struct Row {
    probe: Vec3,
    distance: f64,
}

fn lines(drawn: &DrawnBody) -> Vec<Line> {
    let model = Model::parse(&drawn.text, drawn.name).unwrap_or_else(|error| panic!("{error}"));
    let oracle = BodyOracle::new(&model.patches);
    let baked = BakedBody::new(&model, drawn.name).unwrap_or_else(|error| panic!("{error}"));
    let rings: Vec<Ring> = (0..RINGS).map(|seed| Ring::around(&oracle, DVec3::ZERO, seed, GAP)).collect();
    let rows = |ring: &Ring, speed: f64| -> Vec<Row> {
        let row = |probe: DVec3| Row {
            probe: probe.as_vec3(),
            distance: oracle.nearest(probe.as_vec3().as_dvec3(), 0.0)[0].1.distance,
        };
        ring.rows(speed / RATE).map(row).collect()
    };
    let tracks: Vec<(f64, Vec<Vec<Row>>)> =
        SPEEDS.iter().map(|speed| (*speed, rings.iter().map(|ring| rows(ring, *speed)).collect())).collect();
    let probes: Vec<DVec3> =
        tracks.iter().flat_map(|(_, tracks)| tracks.iter().flatten().map(|row| row.probe.as_dvec3())).collect();
    let options = baked.locator_options();
    let baked = baked.located_for(&probes, &options, &|_, _| ()).unwrap_or_else(|error| panic!("{error}"));
    let body = baked.to_body().unwrap_or_else(|error| panic!("{error}"));
    let solver = Solver::new(&body, &baked);
    let size = f64::from(body.size());
    let line = |(speed, tracks): (f64, Vec<Vec<Row>>)| {
        let (mut felt, mut late, mut streak) = (0, 0, 0);
        let errors = [1, 4].map(|ticks| {
            let followed = tracks.iter().flat_map(|track| {
                let mut state = None;
                track.iter().map(|row| (row, follow(&solver, &mut state, row, ticks))).collect::<Vec<_>>()
            });
            Spread::of(
                followed
                    .map(|(row, found)| {
                        felt += usize::from(found.status == Status::GodObject);
                        let error = (found.point.as_dvec3().distance(row.probe.as_dvec3()) - row.distance).abs() / size;
                        streak = if ticks == 1 && error > EXACT { streak + 1 } else { 0 };
                        late = late.max(streak);
                        error
                    })
                    .collect(),
            )
        });
        let rows = tracks.iter().map(Vec::len).sum();
        Line { body: drawn.name, speed, rows, errors, felt, late, is_convex: body.is_convex() }
    };
    tracks.into_iter().map(line).collect()
}

/// The first row cold, the others from where the one before ended.
fn follow(solver: &Solver<'_>, state: &mut Option<BodyWitness>, row: &Row, ticks: u32) -> Found {
    match state {
        Some(state) => solver.track(state, row.probe, ticks),
        None => {
            let (found, started) = solver.cold(row.probe);
            *state = Some(started);
            found
        }
    }
}

#[test]
fn rings_around_ten_bodies_are_followed() {
    let lines: Vec<Line> = ten().par_iter().flat_map_iter(lines).collect();
    let cells = lines.iter().map(|Line { body, speed, rows, errors: [one, four], .. }| {
        let of = |Spread { median, most, all_but_a_thousandth, worst }: &Spread| {
            [median, most, all_but_a_thousandth, worst].map(|error| format!("{error:.1e}")).join(" | ")
        };
        format!("{body} | {speed:.1} | {rows} | {} | {}", of(one), of(four))
    });
    measured_table(
        "body | m/s | rows | median | 99 % | 99.9 % | most | median, 4 | 99 %, 4 | 99.9 %, 4 | most, 4",
        cells,
    );
    // A tick in which the witness point of an edge's face is held there, and the probe is beyond.
    for Line { body, speed, felt, rows, late, is_convex, .. } in lines {
        println!("{body} at {speed} m/s: {felt} rows of {rows} felt in free air, {late} on end late");
        // Where the nearest point jumps, the audit finds the other one in a tick or two.
        assert!(late <= if is_convex { 0 } else { 2 }, "{body} at {speed} m/s: {late} rows on end are late");
        assert!(felt <= 1, "{body} at {speed} m/s: {felt} rows of {rows} felt in free air");
    }
}

/// Over every ridge that a ring crosses, in front of each convex body that ships: the normal turns with the closest
/// point, by up to ten degrees a tick.
#[test]
fn the_normal_at_a_ridge_is_that_of_the_closest_point() {
    for name in ["capped_box", "ellipsoid_body", "rounded_cylinder", "sphere_body"] {
        let scene = Scene::load(name);
        let oracle = scene.oracle();
        let worst = (0..RINGS).into_par_iter().map(|seed| {
            let mut state = scene.body.start();
            let ring = Ring::around(&oracle, 0.5 * (scene.low + scene.high), seed, 4e-4);
            let tick = |(index, probe): (usize, DVec3)| {
                let probe = probe.as_vec3();
                for _ in 0..if index == 0 { 100 } else { 1 } {
                    scene.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 1.0 / RATE as f32);
                }
                let towards = probe.as_dvec3() - oracle.nearest(probe.as_dvec3(), 0.0)[0].1.point;
                state.normal.as_dvec3().angle_between(towards).to_degrees()
            };
            ring.rows(0.3 / RATE).enumerate().map(tick).fold(0.0, f64::max)
        });
        let worst = worst.reduce(|| 0.0, f64::max);
        println!("{name}: the normal is off by {worst:.3} degrees at most");
        assert!(worst <= 0.1, "{name}: {worst} degrees");
    }
}
