//! Where a body lies in its file, and how small its fillets are, costs no digits: closest points in the file's own
//! frame, against the double-precision oracle of the same body at home.
//!
//! `PALPATE_PROBES` sets the number for long runs.

use crate::scene::from_environment;
use glam::DVec3;
use palpate_bake::{BakedBody, Model};
use palpate_tool::closest::Solver;
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::generate::Random;
use palpate_truth::generate::models::rounded_box;
use palpate_truth::oracle::OraclePoint;
use std::error::Error;
use std::fs;
use std::process::Command;

/// What the answers may be off by, in sizes.
const RIGHT: f64 = 1e-6;

/// How far off closest points are at most, in sizes, of a body that is moved by so many sizes: in their distance from
/// the probe, or from the surface.
fn worst(text: &str, sizes: DVec3) -> f64 {
    let home = Model::parse(text, "home").unwrap();
    assert_eq!(home.centre, DVec3::ZERO);
    let size = f64::from(BakedBody::new(&home, "home").unwrap().size);
    // In millimetres, as a file has it: all digits that the sum has.
    let offset = (1e3 * size * sizes).round();
    let model = Model::parse(&moved(text, offset), "moved").unwrap();
    let baked = BakedBody::new(&model, "moved").unwrap();
    let oracle = BodyOracle::new(&home.patches);
    let mut random = Random::new(7);
    let mut place = || {
        let patch = &home.patches[random.below(home.patches.len())];
        let [u, v] = [random.between(0.0, 1.0), random.between(0.0, 1.0)];
        let on = OraclePoint::evaluate(patch, u, v).point;
        on + random.direction() * size * random.scale(1e-4, 0.5)
    };
    let count = from_environment("PALPATE_PROBES", 60);
    let given: Vec<_> = (0..count).map(|_| place() + 1e-3 * offset).collect();
    // As `closest` does.
    let probes: Vec<_> = given.iter().map(|given| (*given - model.centre).as_vec3()).collect();
    let wide: Vec<_> = probes.iter().map(|probe| probe.as_dvec3()).collect();
    let options = baked.locator_options().reaching(baked.sizes_beyond(&wide));
    let baked = baked.located_for(&wide, &options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    let solver = Solver::new(&body, &baked);
    let mut worst: f64 = 0.0;
    for (given, probe) in given.into_iter().zip(probes) {
        let (found, _) = solver.cold(probe);
        let point = found.point.as_dvec3() + model.centre;
        let truth = oracle.closest(given - 1e-3 * offset);
        let farther = point.distance(given) - truth.distance();
        let off_surface = oracle.closest(point - 1e-3 * offset).distance();
        worst = worst.max(farther.abs() / size).max(off_surface / size);
    }
    worst
}

/// The text of a model with all its points moved, in its unit.
fn moved(text: &str, offset: DVec3) -> String {
    let mut model: toml::Table = text.parse().unwrap();
    for patch in model["patch"].as_array_mut().unwrap() {
        for point in patch["points"].as_array_mut().unwrap().iter_mut().flat_map(|row| row.as_array_mut().unwrap()) {
            for (coordinate, by) in point.as_array_mut().unwrap().iter_mut().zip(offset.to_array()) {
                let at = coordinate.as_float().or_else(|| coordinate.as_integer().map(|at| at as f64)).unwrap();
                *coordinate = toml::Value::Float(at + by);
            }
        }
    }
    model.to_string()
}

/// In its place, its origin in a corner, and up to a hundred sizes off along every axis.
const PLACES: [DVec3; 4] = [DVec3::ZERO, DVec3::splat(0.5), DVec3::new(-10.0, 3.0, 0.5), DVec3::new(99.0, -99.0, 99.0)];

fn is_right(name: &str, text: &str) {
    for sizes in PLACES {
        let worst = worst(text, sizes);
        println!("{name} at {sizes}: {worst:.1e} of the size");
        assert!(worst <= RIGHT, "{name} at {sizes} sizes is off by {worst:e} of its size");
    }
}

#[test]
fn a_box_with_small_fillets_is_right_wherever_it_lies() {
    is_right("box", &rounded_box([120.0, 80.0, 40.0], 0.5));
}

#[test]
fn a_rod_is_right_from_its_end_and_wherever_it_lies() {
    is_right("rod", &rounded_box([5.0, 5.0, 500.0], 1.0));
}

#[test]
fn the_tool_answers_in_the_frame_of_the_file_and_the_tables_say_where_theirs_lies() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let plate = include_str!("../../../models/thin_plate.toml");
    let offset = DVec3::new(3_000.0, -2_000.0, 500.0);
    let run = |command: &str, place: DVec3, options: &[&str]| -> Result<String, Box<dyn Error>> {
        let [model, queries, out] = ["plate.toml", "in.csv", "out"].map(|name| folder.path().join(name));
        fs::write(&model, moved(plate, place))?;
        // Outside, and inside.
        let rows = [DVec3::new(65.0, 3.0, 7.0), DVec3::new(20.0, 13.0, 0.5)].map(|row| row + place);
        let rows = rows.map(|row| format!("{},{},{}\n", row.x, row.y, row.z)).concat();
        fs::write(&queries, format!("qx,qy,qz\n{rows}"))?;
        let mut tool = Command::new(env!("CARGO_BIN_EXE_palpate"));
        tool.arg(command).args(options).arg(&model);
        if command == "closest" {
            tool.arg("--queries").arg(&queries);
        }
        let done = tool.arg("--out").arg(&out).output()?;
        assert!(done.status.code() < Some(2), "{}", String::from_utf8_lossy(&done.stderr));
        Ok(fs::read_to_string(out)?)
    };
    let mut rows = [DVec3::ZERO, offset].into_iter().map(|place| run("closest", place, &["--model"]));
    let (home, away) = (rows.next().ok_or("a run")??, rows.next().ok_or("a run")??);
    for (home, away) in home.lines().zip(away.lines()).skip(1) {
        let numbers = |row: &str| row.split(',').skip(3).take(4).map(str::parse).collect::<Result<Vec<f64>, _>>();
        let [home, away] = [numbers(home)?, numbers(away)?];
        for (axis, by) in [offset.x, offset.y, offset.z, 0.0].into_iter().enumerate() {
            // Nine digits of 3,000.
            assert!((away[axis] - home[axis] - by).abs() <= 5e-6 + RIGHT * 60.0, "{home:?} {away:?}");
        }
    }
    for (place, centre) in [(DVec3::ZERO, DVec3::ZERO), (offset, 1e-3 * offset + DVec3::new(0.03, 0.02, 0.001))] {
        let source = run("bake", place, &[])?;
        let (_, said) = source.split_once("CENTRE: palpate::math::Vec3 = palpate::math::vec3(").ok_or("a centre")?;
        let said = said.split(')').next().unwrap_or_default().split(", ").map(str::parse);
        let said: [f64; 3] = said.collect::<Result<Vec<_>, _>>()?.try_into().map_err(|_| "three numbers")?;
        // To the grain that keeps it exact.
        assert!(DVec3::from_array(said).distance(centre) <= 0.005, "{said:?} is not near {centre}");
    }
    Ok(())
}

#[test]
fn fillets_may_be_as_small_as_the_patches_that_are_refused() {
    is_right("tiny fillets", &rounded_box([100.0, 60.0, 30.0], 2e-3));
}
