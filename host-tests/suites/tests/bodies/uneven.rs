//! A patch with knots so uneven that a radius of it is 10 µm, against a dense search in double precision; and patches
//! with weights so uneven that bounds of their derivatives certify short steps only.

use crate::anywhere::wavy;
use glam::DVec3;
use palpate::patch::Patch as _;
use palpate::track::{Contact, Controller, FirstOrder, Probe, Witness};
use palpate_bake::{BakedBody, Model};
use palpate_truth::closest::Solver;
use palpate_truth::generate::Random;
use palpate_truth::measured::{grouped, measured};
use palpate_truth::oracle::{Oracle, OraclePoint};

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

/// Successive ticks at 4 kHz and 0.3 m/s, in front of the patch and behind it, where it is not touched.
#[test]
fn uneven_weights_do_not_hold_the_tracker_back() {
    let (mut random, mut off) = (Random::new(9), Vec::new());
    for seed in 0..4 {
        let model = Model::parse(&wavy(seed, 10.0), "weights").unwrap();
        let oracle = Oracle::new(&model.patches[0]);
        let mut place = || DVec3::from_array([(); 3].map(|()| random.between(-0.05, 0.05)));
        let mut probes = Vec::new();
        for _ in 0..4 {
            let (from, to) = (place(), place());
            let stride = (to - from).normalize() * (0.3 / 4_000.0);
            probes.extend((0..100).map(|tick| (from + stride * f64::from(tick)).as_vec3().as_dvec3()));
        }
        let baked = BakedBody::new(&model, "weights").unwrap();
        let options = baked.locator_options();
        let baked = baked.located_for(&probes, &options, &|_, _| ()).unwrap();
        let body = baked.to_body().unwrap();
        let mut state = body.start();
        for (tick, at) in probes.iter().enumerate() {
            let probe = Probe::at(at.as_vec3());
            for _ in 0..if tick % 100 == 0 { 400 } else { 1 } {
                body.step(&Controller::SecondOrder, &mut state, probe, 2.5e-4);
            }
            if state.contact != Contact::Touching {
                let found = state.witness.surface.point.as_dvec3().distance(*at);
                off.push((found - oracle.closest(*at).distance) / f64::from(body.size()));
            }
        }
    }
    off.sort_by(f64::total_cmp);
    let of = |share: f64| off[(off.len() as f64 * share) as usize];
    println!("{} rows: off by {:.1e} of the size in the median, {:.1e} at 95 %", off.len(), of(0.5), of(0.95));
    assert!(off.len() > 1_000 && of(0.95) < 1e-6, "{:.1e}", of(0.95));
}

/// A flat dome of 60 mm by 60 mm, its weights drawn from 1 to this.
fn dome(heaviest: f64) -> String {
    let mut random = Random::new(4);
    let mut point = |i: usize, j: usize| {
        let [x, y] = [i, j].map(|index| 20.0 * index as f64);
        let z = 12.0 - ((x - 30.0).powi(2) + (y - 30.0).powi(2)) / 200.0;
        format!("[{x:?}, {y:?}, {z}, {}]", if heaviest > 1.0 { random.scale(1.0, heaviest) } else { 1.0 })
    };
    let rows = [0, 1, 2, 3].map(|i| format!("[{}]", [0, 1, 2, 3].map(|j| point(i, j)).join(", ")));
    format!("unit = \"mm\"\n[[patch]]\ndegree = [3, 3]\npoints = [{}]\n", rows.join(", "))
}

/// From a grid of starts to the closest point of probes straight out, as Figure 7: the runs that arrive.
#[test]
fn uneven_weights_cost_the_papers_law_many_steps() {
    const LAWS: [(&str, Controller); 2] =
        [("the paper's law", Controller::FirstOrder(FirstOrder::CERTIFIED)), ("second order", Controller::SecondOrder)];
    for heaviest in [1.0, 10.0] {
        let model = Model::parse(&dome(heaviest), "dome").unwrap();
        let baked = BakedBody::new(&model, "dome").unwrap();
        let options = baked.locator_options();
        let baked = baked.located_for(&[], &options, &|_, _| ()).unwrap();
        let body = baked.to_body().unwrap();
        let (patch, oracle, size) = (&body.faces()[0].patch, Oracle::new(&model.patches[0]), f64::from(body.size()));
        let mut random = Random::new(2);
        let mut target = || {
            let at = OraclePoint::evaluate(&model.patches[0], random.between(0.1, 0.9), random.between(0.1, 0.9));
            let probe = at.point + 0.1 * size * at.normal(false);
            (oracle.closest(probe).point.distance(at.point) < 1e-6 * size).then_some((probe, at.point))
        };
        let targets: Vec<_> = (0..200).filter_map(|_| target()).take(5).collect();
        assert_eq!((body.faces().len(), targets.len()), (1, 5));
        for (name, law) in &LAWS {
            let mut steps: Vec<u64> = Vec::new();
            for (run, (probe, closest)) in (0..36 * targets.len()).map(|run| (run % 36, &targets[run / 36])) {
                let mut at = Witness::at(patch, (run / 6) as f32 / 5.0, (run % 6) as f32 / 5.0);
                let mut off = || {
                    law.step(patch, &mut at, Probe::at(probe.as_vec3()), 1.0);
                    patch.evaluate(at.parameters[0], at.parameters[1]).point.as_dvec3().distance(*closest)
                };
                steps.extend((1..20_000).find(|_| off() <= 1e-4 * size));
            }
            steps.sort_unstable();
            assert!(steps.len() > 90, "{} of 180 arrive", steps.len());
            let claim = format!("steps to 1e-4 of the size on a dome, weights to {heaviest}, {name}: median");
            measured(&claim, grouped(steps[steps.len() / 2]));
        }
    }
}
