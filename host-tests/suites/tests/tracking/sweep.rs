//! Millions of controller steps over generated convex patches: no step leaves the patch, none moves away, every run
//! over the face converges.
//!
//! `PALPATE_STEPS=100000000 cargo test --release --test tracking sweep -- --nocapture` is the long mode; without the
//! variable two million steps are done.

use glam::DVec3;
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate::track::{Controller, FirstOrder, Gain, Integrator, Law, Outcome, Probe, Witness};
use palpate_bake::BakedPatch;
use palpate_truth::generate::{ConvexPatch, Kind, Random};
use palpate_truth::measured::{grouped, measured};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::env;

const SHORT: u64 = 2_000_000;
/// Patches swept before the steps are looked at.
const ROUND: u64 = 20;
/// Starts for each probe, and probes for each patch.
const RUNS: [usize; 2] = [12, 40];
/// A servo at 4 kHz, for the laws whose gain is a rate.
const PERIOD: f32 = 1.0 / 4_000.0;
/// Far probes over flat, strongly skewed patches are the slowest: the certified gain is small there.
const STEP_LIMIT: usize = 20_000;
const DISTANCE_TOLERANCE: f64 = 1e-5;
/// Rounding of the evaluations at both ends of a step, in units in the last place of the coordinates or the size.
/// Horner's rule at degrees (5, 5) rounds 2 · (5 + 5) times, by half a unit of partial sums up to twice the result, and
/// the division by the weight doubles that: at most 40 at each end. The longer a step, the less its ends round alike:
/// of 10⁸ the law of first order lets `V` rise by 38 at most, that of second order by 48.
const RISE_ULPS: f64 = 80.0;

#[derive(Default)]
struct Counts {
    patches: u64,
    runs: u64,
    steps: u64,
    rejected: u64,
    rise_ulps: f64,
    distance: f64,
    most_steps: usize,
    /// Runs on patches whose normals span more than 90°, and those that ended elsewhere.
    wide: u64,
    wide_elsewhere: u64,
    kinds: BTreeMap<Kind, u64>,
    transitions: [[u64; 7]; 7],
}

/// A probe straight out from a point of the patch, with that point's distance.
fn probe_over(patch: &ConvexPatch, size: f64, random: &mut Random) -> (DVec3, f64) {
    // A tenth each on the border and in a corner.
    let [u, v] = [(); 2].map(|()| match random.below(10) {
        0 => 0.0,
        1 => 1.0,
        _ => random.between(0.0, 1.0),
    });
    let (point, normal) = patch.point_and_normal(u, v);
    let distance = size * random.scale(1e-3, 2.0);
    (point + normal * distance, distance)
}

/// A probe anywhere around the patch.
fn probe_anywhere(patch: &ConvexPatch, size: f64, random: &mut Random) -> DVec3 {
    patch.point_and_normal(0.5, 0.5).0 + random.direction() * size * random.between(0.0, 2.0)
}

/// Steps until the controller rests, and checks each step.
fn run(
    controller: &Controller,
    patch: &SplinePatch,
    witness: &mut Witness,
    query: Vec3,
    counts: &mut Counts,
) -> (f64, usize) {
    let distance = |witness: &Witness| (witness.surface.point.as_dvec3() - query.as_dvec3()).length();
    let reach = query.abs().max_element().max(witness.surface.point.abs().max_element());
    let unit = f64::from(reach.max(patch.size()) * f32::EPSILON);
    let mut before = distance(witness);
    let mut steps = 0;
    while steps < STEP_LIMIT {
        steps += 1;
        let last = witness.mode;
        let step = controller.step(patch, witness, Probe::at(query), PERIOD);
        let [u, v] = witness.parameters;
        assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v), "left the patch: {u}, {v}");
        counts.transitions[last as usize][witness.mode as usize] += 1;
        counts.steps += 1;
        counts.rejected += u64::from(step.outcome == Outcome::Rejected);
        let now = distance(witness);
        counts.rise_ulps = counts.rise_ulps.max((now - before) / unit);
        before = now;
        if step.outcome == Outcome::AtRest || step.residual() < 2e-6 * (patch.size() + step.distance_before()) {
            break;
        }
    }
    (before, steps)
}

fn sweep_patch(controller: &Controller, [starts, probes]: [usize; 2], kind: Kind, seed: u64) -> Counts {
    let mut random = Random::new(seed);
    let drawn = ConvexPatch::draw(kind, &mut random);
    let patch = BakedPatch::without_shape(&drawn.surface).expect("it bakes").to_patch().expect("its table is good");
    let size = f64::from(patch.size());
    let is_wide = drawn.widest_cosine() < 0.0;
    let mut counts = Counts { patches: 1, ..Counts::default() };
    counts.kinds.insert(kind, 1);
    for _ in 0..probes {
        let (query, least) = probe_over(&drawn, size, &mut random);
        let query = query.as_vec3();
        let mut witness = Witness::at(&patch, 0.5, 0.5);
        for start in 0..starts {
            // Half of the runs start anew, half where the probe jumped away from the witness point.
            let [u, v] = [(); 2].map(|()| [0.0, 1.0, random.between(0.0, 1.0)][random.below(3)] as f32);
            if start % 2 == 0 {
                witness = Witness::at(&patch, u, v);
            } else {
                let anywhere = probe_anywhere(&drawn, size, &mut random).as_vec3();
                run(controller, &patch, &mut witness, anywhere, &mut counts);
            }
            let (distance, steps) = run(controller, &patch, &mut witness, query, &mut counts);
            let error = (distance - least).abs() / size;
            counts.runs += 1;
            counts.most_steps = counts.most_steps.max(steps);
            if is_wide {
                counts.wide += 1;
                counts.wide_elsewhere += u64::from(error > DISTANCE_TOLERANCE);
            } else {
                assert!(
                    error <= DISTANCE_TOLERANCE,
                    "{controller:?}, {kind:?}, seed {seed}: {query} is off by {error:e} of the size"
                );
                counts.distance = counts.distance.max(error);
            }
        }
    }
    counts
}

impl Counts {
    fn add(&mut self, other: Self) {
        for (sum, more) in [
            (&mut self.patches, other.patches),
            (&mut self.runs, other.runs),
            (&mut self.steps, other.steps),
            (&mut self.rejected, other.rejected),
            (&mut self.wide, other.wide),
            (&mut self.wide_elsewhere, other.wide_elsewhere),
        ] {
            *sum += more;
        }
        self.rise_ulps = self.rise_ulps.max(other.rise_ulps);
        self.distance = self.distance.max(other.distance);
        self.most_steps = self.most_steps.max(other.most_steps);
        for (kind, more) in other.kinds {
            *self.kinds.entry(kind).or_default() += more;
        }
        for (sum, more) in self.transitions.iter_mut().flatten().zip(other.transitions.iter().flatten()) {
            *sum += more;
        }
    }
}

#[test]
fn no_step_leaves_the_patch_or_moves_away_and_every_run_converges() {
    sweep(&Controller::FirstOrder(FirstOrder::CERTIFIED), "");
}

#[test]
fn no_step_of_second_order_leaves_the_patch_or_moves_away_and_every_run_converges() {
    sweep(&Controller::SecondOrder, ", second order");
}

fn sweep(controller: &Controller, law: &str) {
    let wanted: u64 =
        env::var("PALPATE_STEPS").map_or(SHORT, |steps| steps.parse().expect("PALPATE_STEPS is a number"));
    let mut counts = Counts::default();
    // In rounds of a fixed size: how many patches are swept must not depend on which thread is the quicker.
    for round in 0.. {
        let seeds = round * ROUND..(round + 1) * ROUND;
        let swept: Vec<Counts> = seeds
            .into_par_iter()
            .map(|seed| sweep_patch(controller, RUNS, Kind::ALL[seed as usize % Kind::ALL.len()], seed))
            .collect();
        swept.into_iter().for_each(|swept| counts.add(swept));
        if counts.steps >= wanted {
            break;
        }
    }
    println!(
        "{} steps in {} runs on {} patches {:?}: V up by {:.2} ulp at most, {} rejected steps; distances off by {:.1e} of the \
         size at most, {} steps at most; {} of {} runs on patches with normals over 90° apart end elsewhere",
        counts.steps,
        counts.runs,
        counts.patches,
        counts.kinds,
        counts.rise_ulps,
        counts.rejected,
        counts.distance,
        counts.most_steps,
        counts.wide_elsewhere,
        counts.wide
    );
    for (from, row) in counts.transitions.iter().enumerate().skip(1) {
        println!("from mode {from}: {:?}", &row[1..]);
        for (to, count) in row.iter().enumerate().skip(1) {
            // A witness point held at one side is not at the opposite one a step later.
            let opposite = matches!((from, to), (1, 2) | (2, 1) | (3, 4) | (4, 3));
            assert!(*count > 0 || opposite, "from mode {from} to mode {to} never");
            assert!(*count == 0 || !opposite, "from mode {from} to mode {to}: {count} times");
        }
    }
    assert!(counts.rise_ulps <= RISE_ULPS, "V rose by {} ulp", counts.rise_ulps);
    assert_eq!(counts.rejected, 0, "a step at the certified gain was rejected");
    let row = |what: &str, value: String| {
        measured(&format!("{} steps over generated patches{law}: {what}", grouped(wanted)), value)
    };
    row("patches", grouped(counts.patches));
    row("maximum rise of `V`", format!("{:.1}", counts.rise_ulps));
    row("rejected steps", counts.rejected.to_string());
    row("maximum error of a distance", format!("{:.1e}", counts.distance));
}

#[test]
fn every_law_gain_and_integrator_stays_on_the_patch_never_moves_away_and_converges() {
    for law in [Law::MeasureNumbers, Law::Covariant] {
        for integrator in [Integrator::Euler, Integrator::Heun, Integrator::RungeKutta4] {
            for gain in [Gain::Certified, Gain::Constant(2_000.0), Gain::Exponential(1e6)] {
                let controller =
                    Controller::FirstOrder(FirstOrder::CERTIFIED.law(law).integrator(integrator).gain(gain));
                let mut total = Counts::default();
                for seed in 0..10 {
                    total.add(sweep_patch(&controller, [4, 4], Kind::ALL[seed as usize % 5], seed));
                }
                println!(
                    "{law:?} {integrator:?} {gain:?}: {} steps in {} runs, at most {}; V up by {:.2} ulp, {} rejected",
                    total.steps, total.runs, total.most_steps, total.rise_ulps, total.rejected
                );
                assert!(total.rise_ulps <= RISE_ULPS, "{controller:?}: V rose by {} ulp", total.rise_ulps);
                // The certificate is Euler's. The others are capped by it and checked after the step.
                assert!(
                    total.rejected == 0 || integrator != Integrator::Euler,
                    "{controller:?}: {} rejected",
                    total.rejected
                );
            }
        }
    }
}
