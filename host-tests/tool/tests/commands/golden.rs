//! The firmware's numbers against golden points that were computed elsewhere, in double precision.

use glam::DVec3;
use palpate::patch::Patch as _;
use palpate_bake::{BakedPatch, Model};
use palpate_truth::measured::measured;
use palpate_truth::oracle::golden::{self, ClosestRow, EvaluationRow};
use palpate_truth::oracle::{Oracle, OraclePoint};
use serde::Deserialize;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The largest side of the bounding box of both patches, in their unit (cm).
const SIZE: f64 = 10.0;

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../truth/golden").join(name)
}

fn model_file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name)
}

/// A row that `closest` printed.
#[derive(Deserialize)]
struct Printed {
    patch: String,
    u: f64,
    v: f64,
    px: f64,
    py: f64,
    pz: f64,
    gap: f64,
    steps: u32,
    status: String,
}

impl Printed {
    fn point(&self) -> DVec3 {
        DVec3::new(self.px, self.py, self.pz)
    }
}

/// Golden rows, and what `closest` prints for them.
fn rows(model: &str, queries: &str, options: &[&str]) -> Result<Vec<(ClosestRow, Printed)>, Box<dyn Error>> {
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["closest", "--model"])
        .arg(model_file(model))
        .arg("--queries")
        .arg(data(queries))
        .args(options)
        .output()?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let printed: Vec<Printed> =
        csv::Reader::from_reader(run.stdout.as_slice()).deserialize().collect::<Result<_, _>>()?;
    let golden: Vec<ClosestRow> = golden::read(&data(queries))?;
    assert_eq!(printed.len(), golden.len());
    Ok(golden.into_iter().zip(printed).collect())
}

/// Runs `closest` and checks what holds for every row, in any mode.
fn closest(model: &str, queries: &str, options: &[&str]) -> Result<Vec<(ClosestRow, Printed)>, Box<dyn Error>> {
    let rows = rows(model, queries, options)?;
    let model = Model::read(&model_file(model))?;
    let patch = &model.patches[0];
    for (golden, printed) in &rows {
        assert_eq!(printed.patch, "S");
        // p is the surface at the printed (u, v): to the accuracy of the f32 evaluation.
        let on_surface = OraclePoint::evaluate(patch, printed.u, printed.v).point * model.unit.per_metre();
        assert!(on_surface.distance(printed.point()) <= 2e-6 * SIZE, "{} off the surface", golden.query());
        // gap is the distance to the printed point, to the nine digits both are printed with.
        let gap = printed.point().distance(golden.query());
        assert!((gap - printed.gap).abs() <= 1e-8 * SIZE, "gap {} but distance {gap}", printed.gap);
    }
    Ok(rows)
}

/// By how much the distance to the printed point exceeds the golden one, relative to the size; negative if nearer.
fn excess((golden, printed): &(ClosestRow, Printed)) -> f64 {
    (printed.point().distance(golden.query()) - golden.distance) / SIZE
}

/// How far the printed point lies from the golden one, relative to the size.
fn aside((golden, printed): &(ClosestRow, Printed)) -> f64 {
    printed.point().distance(golden.point()) / SIZE
}

#[test]
fn evaluation_in_single_precision_is_within_2e_6_of_the_golden_values() -> Result<(), Box<dyn Error>> {
    let model = Model::read(&model_file("table1.toml"))?;
    let patch = BakedPatch::new(&model.patches[0])?.to_patch()?;
    let rows: Vec<EvaluationRow> = golden::read(&data("table1_eval.csv"))?;
    assert_eq!(rows.len(), 100);
    let mut worst: f64 = 0.0;
    for row in rows {
        let found = patch.evaluate(row.u as f32, row.v as f32);
        // Points relative to the patch's size, tangents to their own length; the rounding of (u, v) to f32 is included.
        let error = |found: palpate::math::Vec3, golden: DVec3, scale: f64| {
            (found.as_dvec3() * model.unit.per_metre()).distance(golden) / scale
        };
        worst = worst
            .max(error(found.point, row.point(), SIZE))
            .max(error(found.tangent_u, row.tangent_u(), row.tangent_u().length()))
            .max(error(found.tangent_v, row.tangent_v(), row.tangent_v().length()));
    }
    measured("evaluation of Table I at 100 golden points: maximum error", format!("{worst:.1e}"));
    assert!(worst < 2e-6, "largest relative error {worst:e}");
    Ok(())
}

#[test]
fn the_oracle_agrees_with_the_golden_points() -> Result<(), Box<dyn Error>> {
    for file in ["table1_near", "table1_box", "table1c_near", "table1c_box", "table1c_track"] {
        let model_name = file.split('_').next().unwrap_or_default();
        let model = Model::read(&model_file(&format!("{model_name}.toml")))?;
        let oracle = Oracle::new(&model.patches[0]);
        let per_metre = model.unit.per_metre();
        for row in golden::read::<ClosestRow>(&data(&format!("{file}.csv")))? {
            let found = oracle.closest(row.query() / per_metre);
            let difference = found.distance * per_metre - row.distance;
            // The golden points carry twelve digits.
            assert!(difference.abs() <= 1e-10 * SIZE, "{file}: {}: off by {difference:e}", row.query());
        }
    }
    Ok(())
}

#[test]
fn cold_queries_find_the_closest_point_of_the_whole_patch() -> Result<(), Box<dyn Error>> {
    let (mut maximum, mut farthest, mut longest) = (0.0_f64, 0.0_f64, 0);
    for file in ["table1_near", "table1_box", "table1c_near", "table1c_box"] {
        let model_name = file.split('_').next().unwrap_or_default();
        let rows = closest(&format!("{model_name}.toml"), &format!("{file}.csv"), &["--mode", "cold"])?;
        let mut steps: Vec<u32> = rows.iter().map(|(_, printed)| printed.steps).collect();
        steps.sort_unstable();
        let worst = rows.iter().map(|row| excess(row).abs()).fold(0.0, f64::max);
        println!("{file}: {worst:.1e} of the size, evaluations median {} worst {}", steps[250], steps[499]);
        assert!(worst <= 1e-5, "{file}: off by {worst:e} of the size");
        assert!(rows.iter().all(|(_, printed)| printed.status == "converged"), "{file}");
        for row in &rows {
            // The distance grows with the square of the way along the surface: most slowly where that is flat.
            let (aside, distance) = (aside(row), row.0.distance / SIZE);
            assert!(aside * aside <= 2.0 * (distance + aside) * 3e-7, "{file}: {}: {aside:e} aside", row.0.query());
            farthest = farthest.max(aside);
        }
        (maximum, longest) = (maximum.max(worst), longest.max(steps[499]));
    }
    measured(
        "cold, 2,000 golden probes of Table I and its companion: maximum error of the point, along the surface",
        format!("{farthest:.1e}"),
    );
    measured("cold, 2,000 golden probes of Table I and its companion: maximum error", format!("{maximum:.1e}"));
    measured("cold, 2,000 golden probes of Table I and its companion: evaluations at most", longest);
    Ok(())
}

#[test]
fn tracking_follows_the_probe_with_one_step_a_row_and_better_with_four() -> Result<(), Box<dyn Error>> {
    for (ticks, limit) in [("1", 1e-5), ("4", 3e-7)] {
        let rows =
            closest("table1c.toml", "table1c_track.csv", &["--mode", "track", "--ticks", ticks, "--effort", "1,1"])?;
        assert_eq!(rows[0].1.status, "converged");
        // A tick at this effort is one step of the controller, and on a patch that is not a closed convex body one
        // evaluation of the audit, and one of a point that is nearer.
        let most = 3 * ticks.parse::<u32>()?;
        assert!(rows[1..].iter().all(|(_, row)| row.status == "tracking" && row.steps <= most));
        let worst = rows[20..].iter().map(|row| excess(row).abs()).fold(0.0, f64::max);
        let claim = format!("following a moving probe, 2,000 golden rows, {ticks} steps a row: maximum error");
        measured(&claim, format!("{worst:.1e}"));
        assert!(worst <= limit, "{ticks} steps a row: off by {worst:e} of the size");
    }
    Ok(())
}

#[test]
fn four_ticks_at_rest_find_the_point_along_the_surface_too() -> Result<(), Box<dyn Error>> {
    let mut worst: f64 = 0.0;
    for file in ["table1c_near.csv", "table1c_box.csv"] {
        let rows = rows("table1c.toml", file, &["--mode", "track", "--ticks", "4"])?;
        // The first row is cold.
        worst = rows[1..].iter().map(aside).fold(worst, f64::max);
    }
    measured("the companion's point, along the surface, after four ticks: maximum error", format!("{worst:.1e}"));
    assert!(worst <= 3e-7, "off by {worst:e} of the size");
    Ok(())
}

/// Cold queries of a body against its golden points. `size` in the model's unit.
fn bodies(model: &str, queries: &str, size: f64, tolerance: f64) -> Result<(), Box<dyn Error>> {
    let rows = rows(model, queries, &[])?;
    assert_eq!(rows.len(), 500);
    let mut worst: f64 = 0.0;
    for (row, printed) in &rows {
        let off = (printed.gap.abs() - row.distance).abs() / size;
        assert!(off <= tolerance && printed.status == "converged", "{}: off by {off:e}", row.query());
        worst = worst.max(off);
    }
    let dearest = rows.iter().map(|(_, row)| row.steps).max().unwrap_or_default();
    measured(&format!("cold, 500 golden probes of `{model}`: maximum error"), format!("{worst:.1e}"));
    measured(&format!("cold, 500 golden probes of `{model}`: evaluations at most"), dearest);
    Ok(())
}

#[test]
fn cold_queries_find_the_closest_point_of_the_capped_box() -> Result<(), Box<dyn Error>> {
    bodies("capped_box.toml", "capped_box_closest.csv", 60.0, 1e-5)
}

#[test]
fn cold_queries_find_the_closest_point_of_ellipsoid_and_teapot() -> Result<(), Box<dyn Error>> {
    bodies("ellipsoid_body.toml", "ellipsoid_closest.csv", 100.0, 1e-5)?;
    bodies("teapot.toml", "teapot_closest.csv", 6.4, 1e-4)
}
