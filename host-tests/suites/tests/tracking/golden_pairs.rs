//! Golden poses of tools against bodies, where `data/pairs` lies beside the checkout or below a folder above it.
//! Their oracle works in double precision and shares no code with this repository.

use crate::tools::{located_again, placement};
use glam::{DQuat, DVec3};
use palpate::pair::{Core, DEFAULT_CELLS, Tool, ToolStatus};
use palpate_bake::{BakedBody, Model};
use palpate_suites::repository;
use palpate_truth::oracle::golden;
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(Deserialize)]
struct Row {
    kind: String,
    run: i32,
    qw: f64,
    qx: f64,
    qy: f64,
    qz: f64,
    px: f64,
    py: f64,
    pz: f64,
    distance: f64,
}

fn folder() -> Option<PathBuf> {
    let root = repository("").canonicalize().ok()?;
    root.ancestors().map(|folder| folder.join("shared/data/pairs")).find(|folder| folder.is_dir())
}

/// The tables of a model with their locator, and the middle of its frame.
pub fn bake(file: &Path) -> (BakedBody, DVec3) {
    let model = Model::read(file).expect("a model");
    let baked = BakedBody::new(&model, "golden").expect("a body");
    let options = baked.locator_options();
    (baked.located(&options, &|_, _| ()).expect("a locator").0, model.centre)
}

/// Errors of the distance over the size.
fn sorted(mut errors: Vec<f64>) -> Vec<f64> {
    errors.sort_by(f64::total_cmp);
    errors
}

#[test]
fn golden_poses_are_met_cold_and_in_one_tick_a_row() {
    let Some(folder) = folder() else {
        println!("no golden poses beside the checkout");
        return;
    };
    for (name, model, tool_model) in [
        ("ellipsoid_ellipsoid", "ellipsoid_body", Some("tool_ellipsoid")),
        ("cappedbox_ellipsoid", "capped_box", Some("tool_ellipsoid")),
        ("cappedbox_box", "capped_box", None),
        ("bumpy_box", "bumpy", None),
    ] {
        let rows: Vec<Row> = golden::read(&folder.join(name).with_extension("csv")).expect("golden rows");
        let (tables, centre) = bake(&folder.join(model).with_extension("toml"));
        let body = tables.to_body().expect("its tables fit");
        let core = tool_model.map(|model| bake(&folder.join(model).with_extension("toml")));
        let core_body = core.as_ref().map(|(tables, _)| tables.to_body().expect("its tables fit"));
        let core_centre = core.as_ref().map_or(DVec3::ZERO, |(_, centre)| *centre);
        let core = core_body.as_ref().map_or(Core::Box { half: [0.012, 0.007, 0.004] }, Core::Body);
        let tool = Tool::new(core, 0.0).expect("a tool");
        let (mut cold, mut inside, mut ticks) = (Vec::new(), Vec::new(), Vec::new());
        let (mut state, mut run) = (None, -1);
        for row in &rows {
            let turn = DQuat::from_xyzw(row.qx, row.qy, row.qz, row.qw);
            let origin = DVec3::new(row.px, row.py, row.pz) + turn * core_centre - centre;
            let placement = placement(turn, origin);
            if row.run != run {
                (state, run) = (None, row.run);
            }
            let mut found = state.as_mut().map(|state| body.step_tool(&tool, state, &placement, DEFAULT_CELLS));
            if row.run < 0 || found.is_none_or(|found| located_again(found.status)) {
                let (start, located) = body.locate_tool(&tool, &placement);
                (state, found) = ((row.run >= 0).then_some(start), Some(located));
            }
            let found = found.expect("it was located");
            let error = (f64::from(found.distance) - row.distance).abs() / f64::from(body.size());
            match row.kind.as_str() {
                "tick" => ticks.push(error),
                "inside" => {
                    assert_eq!(found.status, ToolStatus::Inside, "{name}: {}", row.distance);
                    inside.push(error);
                }
                _ => cold.push(error),
            }
        }
        let [cold, inside, ticks] = [cold, inside, ticks].map(sorted);
        let share = |errors: &[f64], part: usize| errors.get(errors.len().saturating_sub(1) * part / 100).copied();
        let [late, worst] = [99, 100].map(|part| share(&ticks, part).unwrap_or(f64::NAN));
        println!(
            "{name}: {} poses off by {:.1e} of the size at most, {} inside by {:.1e}; {} ticks: 99 % within {late:.1e}, \
             all within {worst:.1e}",
            cold.len(),
            share(&cold, 100).unwrap_or_default(),
            inside.len(),
            share(&inside, 100).unwrap_or_default(),
            ticks.len()
        );
        assert!(cold.len() >= 300 && ticks.len() >= 600, "{name}: {} {}", cold.len(), ticks.len());
        assert!(cold.iter().all(|error| *error <= 2e-6) && inside.iter().all(|error| *error <= 1e-6), "{name}");
        if body.is_convex() {
            assert!(late <= 3e-7 && worst <= 1e-5, "{name}: {late:e} {worst:e}");
        } else {
            assert!(share(&ticks, 97).is_some_and(|error| error <= 1e-5), "{name}");
        }
    }
}
