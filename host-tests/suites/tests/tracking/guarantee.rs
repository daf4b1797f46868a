//! The guarantee of Theorem 1, on the convex companion of Table I: from everywhere, to the closest point, without ever
//! leaving the patch or moving away.
//!
//! Covered by the theorem are the probes in the patch's external Voronoi region: those straight out from its inside.
//! The box file has others: beyond the rim, and below the open dome. From there the far leg of an arched edge can be a
//! second nearest point, for this patch's normals span more than 90°, and no law that only moves nearer can leave it.
//! Such a rest betrays itself: the probe is behind the surface there. So it is checked of every run that it stays on
//! the patch and never moves away, and that where it rests in front of the surface it rests at the closest point.

use palpate::math::Vec3;
use palpate::patch::{Patch, SplinePatch};
use palpate::track::{Controller, FirstOrder, Outcome, Probe, Witness};
use palpate_bake::{BakedPatch, Model};
use palpate_truth::measured::{grouped, measured};
use palpate_truth::oracle::golden::{ClosestRow, read};
use std::path::{Path, PathBuf};

const STARTS: usize = 21;
const PROBES: usize = 200;
/// The slowest of the certified runs needs less than half of it.
const STEP_LIMIT: usize = 1_000;
/// Relative to the patch's size: what the ticks of a cold start are counted to.
const NEAR: f64 = 1e-6;
/// Those of the law of second order, from any start to any probe over the face.
const MOST_TICKS: usize = 15;
/// A closest point is found when its distance is right to this, relative to the patch's size.
const DISTANCE_TOLERANCE: f64 = 1e-5;
/// Rounding of one evaluation shows at both ends of a step: 2 × 2 units in the last place of the coordinates.
const RISE_ULPS: f64 = 4.0;

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn table1c() -> SplinePatch<'static> {
    let model = Model::read(&here("../models/table1c.toml")).expect("the model is good");
    BakedPatch::all(&model, "table1c.toml").expect("it bakes")[0].to_patch().expect("the table is good")
}

/// What the runs showed at their worst.
#[derive(Default)]
struct Worst {
    runs: usize,
    steps: usize,
    /// Steps until the distance is right to [`NEAR`].
    near: usize,
    rise_ulps: f64,
    distance: f64,
    elsewhere: usize,
    rejected: usize,
}

fn run(controller: &Controller, patch: &SplinePatch, start: [f32; 2], query: Vec3, least: f64, worst: &mut Worst) {
    let distance = |witness: &Witness| (witness.surface.point.as_dvec3() - query.as_dvec3()).length();
    let unit = f64::from(query.abs().max_element().max(patch.size()) * f32::EPSILON);
    let mut witness = Witness::at(patch, start[0], start[1]);
    let mut before = distance(&witness);
    let mut near = 1;
    for steps in 1..=STEP_LIMIT {
        let step = controller.step(patch, &mut witness, Probe::at(query), 1.0);
        let [u, v] = witness.parameters;
        assert!((0.0..=1.0).contains(&u) && (0.0..=1.0).contains(&v), "left the patch: {u}, {v}");
        let now = distance(&witness);
        worst.rise_ulps = worst.rise_ulps.max((now - before) / unit);
        worst.rejected += usize::from(step.outcome == Outcome::Rejected);
        worst.steps = worst.steps.max(steps);
        before = now;
        if (now - least).abs() > NEAR * f64::from(patch.size()) {
            near = steps + 1;
        }
        // Asked for less than f32 can place on this patch: at rest.
        if step.outcome == Outcome::AtRest
            || step.residual() < 4.0 * f32::EPSILON * (patch.size() + step.distance_before())
        {
            break;
        }
    }
    let error = (before - least).abs() / f64::from(patch.size());
    worst.runs += 1;
    if error <= NEAR {
        worst.near = worst.near.max(near);
    }
    worst.distance = worst.distance.max(error);
    if error > DISTANCE_TOLERANCE {
        worst.elsewhere += 1;
        let normal = witness.normal(patch).expect("the patch is regular");
        let gap = (query - witness.surface.point).dot(normal);
        assert!(
            gap < 0.0,
            "rests {gap} m in front of the surface at {:?}, not at the closest point",
            witness.parameters
        );
    }
}

#[test]
fn every_start_converges_without_leaving_the_patch_or_moving_away() {
    every_start_converges(&Controller::FirstOrder(FirstOrder::CERTIFIED), "");
}

#[test]
fn every_start_converges_to_second_order_in_a_few_ticks() {
    let most = every_start_converges(&Controller::SecondOrder, ", second order");
    measured("ticks to 1e-6 of the size from 441 starts on the convex companion, second order: at most", most);
    assert!(most <= MOST_TICKS, "{most} ticks");
}

/// Steps at most until the distance is right to [`NEAR`], for the probes over the face.
fn every_start_converges(controller: &Controller, law: &str) -> usize {
    let patch = table1c();
    let mut near = 0;
    let (mut runs, mut covered, mut elsewhere, mut rejected, mut rise_ulps) = (0, 0, 0, 0, 0.0_f64);
    for (file, least_covered) in [("table1c_near.csv", 200), ("table1c_box.csv", 100), ("table1c_track.csv", 190)] {
        let rows: Vec<ClosestRow> = read(&here("../truth/golden").join(file)).expect("golden data");
        // Spread over the file: the rows of a track are neighbours.
        let stride = (rows.len() / PROBES).max(1);
        let (mut inside, mut outside) = (Worst::default(), Worst::default());
        for row in rows.iter().step_by(stride).take(PROBES) {
            // The file is in centimetres.
            let query = (row.query() * 0.01).as_vec3();
            let is_covered = [row.u, row.v].iter().all(|parameter| *parameter > 0.0 && *parameter < 1.0);
            let worst = if is_covered { &mut inside } else { &mut outside };
            for i in 0..STARTS {
                for j in 0..STARTS {
                    let start = [i as f32 / (STARTS - 1) as f32, j as f32 / (STARTS - 1) as f32];
                    run(controller, &patch, start, query, row.distance * 0.01, worst);
                }
            }
        }
        for (region, worst) in [("covered", &inside), ("not covered", &outside)] {
            println!(
                "{file}{law}, {} probes {region}: at most {} steps, {} to 1e-6, V up by {:.2} ulp, {} of {} runs end elsewhere, \
                 the others within {:.1e} of the size; {} rejected steps",
                worst.runs / (STARTS * STARTS),
                worst.steps,
                worst.near,
                worst.rise_ulps,
                worst.elsewhere,
                worst.runs,
                if worst.elsewhere == 0 { worst.distance } else { DISTANCE_TOLERANCE },
                worst.rejected
            );
            (runs, rejected) = (runs + worst.runs, rejected + worst.rejected);
            rise_ulps = rise_ulps.max(worst.rise_ulps);
            assert!(worst.rise_ulps <= RISE_ULPS, "{file}: V rose by {} ulp", worst.rise_ulps);
            assert_eq!(worst.rejected, 0, "{file}: a step at the certified gain was rejected");
        }
        near = near.max(inside.near);
        assert_eq!(inside.elsewhere, 0, "{file}: off by {:e} of the size", inside.distance);
        assert!(inside.runs >= least_covered * STARTS * STARTS, "{file}: only {} runs covered", inside.runs);
        if file != "table1c_box.csv" {
            assert_eq!(outside.elsewhere, 0, "{file}: off by {:e} of the size", outside.distance);
        }
        (covered, elsewhere) = (covered + inside.runs, elsewhere + outside.elsewhere);
    }
    measured(&format!("runs from 441 starts each on the convex companion{law}"), grouped(runs as u64));
    measured(&format!("of them with the probe over the face, where the theorem holds{law}"), grouped(covered as u64));
    measured(
        &format!("of them with the probe beyond the rim, that rest at another point{law}"),
        grouped(elsewhere as u64),
    );
    measured(&format!("maximum rise of `V` in these runs{law}"), format!("{rise_ulps:.2}"));
    measured(&format!("rejected steps in these runs{law}"), rejected);
    near
}
