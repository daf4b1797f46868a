//! A patch with knots so uneven that a radius of it is 10 µm, against a dense search in double precision.

use glam::DVec3;
use palpate::track::{Controller, Probe};
use palpate_bake::{BakedBody, Model};
use palpate_truth::closest::Solver;

/// Of the dense search, and of `f32` at this size.
const EXACT_MM: f64 = 0.001;

/// Probes and distances, mm.
fn rows(text: &str) -> Vec<(DVec3, f64)> {
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect::<Vec<f64>>();
    let rows = text.lines().skip(1).map(numbers);
    rows.map(|row| (DVec3::new(row[0], row[1], row[2]), row[3])).collect()
}

/// Successive ticks at 4 kHz: the tracker once fell 5.6 mm behind for 114 of them.
#[test]
fn uneven_knots_do_not_hold_the_tracker_back() {
    let model = Model::parse(include_str!("../../data/knots.toml"), "knots").unwrap();
    let (cold, tracked) =
        (rows(include_str!("../../data/knots.csv")), rows(include_str!("../../data/knots_track.csv")));
    let local = |at: DVec3| 1e-3 * at - model.centre;
    let probes: Vec<DVec3> = cold.iter().chain(&tracked).map(|(at, _)| local(*at)).collect();
    let baked = BakedBody::new(&model, "knots").unwrap();
    let options = baked.locator_options();
    let baked = baked.located_for(&probes, &options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    let solver = Solver::new(&body, &baked);
    let mut worst = [0.0_f64; 2];
    for (at, distance) in cold {
        let probe = local(at).as_vec3();
        let found = 1e3 * solver.cold(probe).0.point.as_dvec3().distance(probe.as_dvec3());
        worst[0] = worst[0].max((found - distance).abs());
    }
    let mut state = body.start();
    let first = Probe::at(local(tracked[0].0).as_vec3());
    while !state.is_located {
        body.step(&Controller::SecondOrder, &mut state, first, 2.5e-4);
    }
    for (at, distance) in tracked {
        body.step(&Controller::SecondOrder, &mut state, Probe::at(local(at).as_vec3()), 2.5e-4);
        worst[1] = worst[1].max((1e3 * f64::from(state.gap.abs()) - distance).abs());
    }
    println!("cold {:.6} mm, tracked {:.6} mm off", worst[0], worst[1]);
    assert!(worst.iter().all(|off| *off <= EXACT_MM), "{worst:?} mm");
}
