//! `closest --modes`: golden points of deformed bodies, computed elsewhere in double precision; and bad input.

use serde::Deserialize;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Models with their unit in a metre and their size, metres.
const BODIES: [(&str, f64, f64); 3] =
    [("ellipsoid_body", 1000.0, 0.13), ("capped_box", 1000.0, 0.06), ("rounded_cylinder", 1000.0, 0.06)];

#[derive(Deserialize)]
struct Golden {
    body: String,
    q0: f64,
    q1: f64,
    q2: f64,
    q3: f64,
    x: f64,
    y: f64,
    z: f64,
    distance: f64,
    inside: u8,
}

#[derive(Deserialize)]
struct Printed {
    gap: f64,
    status: String,
}

fn root(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

fn closest(body: &str, modes: &Path, queries: &str, mode: &str) -> Result<Output, Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let input = directory.path().join("in.csv");
    fs::write(&input, queries)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_palpate"));
    command.args(["closest", "--model"]).arg(root(&format!("models/{body}.toml")));
    Ok(command.arg("--modes").arg(modes).arg("--queries").arg(input).args(["--mode", mode]).output()?)
}

fn modes(body: &str) -> PathBuf {
    root(&format!("truth/golden/deform/{body}.modes.toml"))
}

fn printed(run: &Output) -> Result<Vec<Printed>, Box<dyn Error>> {
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    Ok(csv::Reader::from_reader(run.stdout.as_slice()).deserialize().collect::<Result<_, _>>()?)
}

/// The relative errors of the distance, in rising order; panics on a wrong side.
fn errors(mode: &str, body: &str, per_metre: f64, size: f64) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).from_path(root(&format!("truth/golden/deform/{mode}.csv")))?;
    let golden: Vec<Golden> = reader.deserialize().collect::<Result<_, _>>()?;
    let golden: Vec<_> = golden.into_iter().filter(|row| row.body == body).collect();
    let row = |row: &Golden| {
        let [x, y, z] = [row.x, row.y, row.z].map(|at| at * per_metre);
        format!("{x:?},{y:?},{z:?},{:?},{:?},{:?},{:?}\n", row.q0, row.q1, row.q2, row.q3)
    };
    let queries = format!("qx,qy,qz,q0,q1,q2,q3\n{}", golden.iter().map(row).collect::<String>());
    let printed = printed(&closest(body, &modes(body), &queries, mode)?)?;
    assert_eq!(printed.len(), golden.len());
    let mut errors: Vec<_> = golden
        .iter()
        .zip(&printed)
        .map(|(golden, printed)| {
            assert!(matches!(&*printed.status, "converged" | "tracking"), "{}", printed.status);
            // On the surface there is no side.
            let is_known = golden.distance > 1e-6 * size;
            assert!(
                !is_known || (printed.gap < 0.0) == (golden.inside == 1),
                "{body}: wrong side at {}",
                golden.distance
            );
            (printed.gap.abs() / per_metre - golden.distance).abs() / size
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    println!("{body}, {mode}: {} rows, at most {:.1e} of the size", errors.len(), errors[errors.len() - 1]);
    Ok(errors)
}

#[test]
fn deformed_bodies_give_the_golden_distances() -> Result<(), Box<dyn Error>> {
    for (body, per_metre, size) in BODIES {
        let cold = errors("cold", body, per_metre, size)?;
        // Some roundings of coordinates up to the size.
        assert!(cold[cold.len() - 1] <= 3e-7, "{body}: {:e}", cold[cold.len() - 1]);
        let track = errors("track", body, per_metre, size)?;
        assert!(track[track.len() * 99 / 100] <= 1e-6, "{body}: {:e}", track[track.len() * 99 / 100]);
        assert!(track[track.len() - 1] <= 5e-5, "{body}: {:e}", track[track.len() - 1]);
    }
    Ok(())
}

#[test]
fn a_q_beyond_its_budget_is_clamped_and_the_row_says_so() -> Result<(), Box<dyn Error>> {
    let rows = "qx,qy,qz,q0,q1,q2,q3\n80,20,10,0.001464,0,0,0\n80,20,10,0.5,0,0,0\n";
    for mode in ["cold", "track"] {
        let [at_limit, beyond] = &printed(&closest("capped_box", &modes("capped_box"), rows, mode)?)?[..] else {
            return Err("two rows".into());
        };
        assert!((at_limit.gap - beyond.gap).abs() < 1e-4, "{} and {}", at_limit.gap, beyond.gap);
        assert!(!at_limit.status.contains("clamped") && beyond.status.ends_with(" clamped"), "{}", beyond.status);
    }
    Ok(())
}

#[test]
fn bad_modes_and_columns_are_refused_by_name() -> Result<(), Box<dyn Error>> {
    let good = fs::read_to_string(modes("capped_box"))?;
    let directory = tempfile::tempdir()?;
    let file = directory.path().join("bad.modes.toml");
    let rows = "qx,qy,qz,q0,q1,q2,q3\n80,20,10,0,0,0,0\n";
    let line = |key: &str| good.lines().find(|line| line.starts_with(key)).unwrap_or_default().to_owned();
    let with = |key: &str, value: &str| good.replacen(&line(key), &format!("{key} = {value}"), 1);
    for (text, queries, expected) in [
        (good.clone(), "qx,qy,qz,q0,q1,q2\n80,20,10,0,0,0\n", "no column q3 in the header"),
        (
            good.clone(),
            "qx,qy,qz,q0,q1,q2,q3,q4\n80,20,10,0,0,0,0,0\n",
            "column q4 has no mode in the modes file: add the mode",
        ),
        (good.clone(), "qx,qy,qz,q0,q1,q2,q3\n80,20,10,0,nan,0,0\n", "in.csv:2: q1 is NaN"),
        (String::new(), rows, "missing field `budget`"),
        ("budget = 0.01\n".into(), rows, "0 modes: a body has 1 to 8; add a [[mode]]"),
        (format!("budget = 0.01\n{}", "[[mode]]\npoly = []\n".repeat(9)), rows, "9 modes: a body has 1 to 8"),
        (with("budget", "-1.0"), rows, "the file: budget is -1: must be above 0"),
        (with("poly", "[[1.0, 0.0, 0.0]]"), rows, "mode \"squash\": poly has 1 entries: 10"),
        (
            with("poly", &format!("[{}[nan, 0.0, 0.0]]", "[0.0, 0.0, 0.0], ".repeat(9))),
            rows,
            "poly is NaN: must be finite",
        ),
        (
            with("budget", "1e300"),
            rows,
            "mode \"squash\": budget, poly, half and radius give a displacement that is too",
        ),
        (with("half", "0.0"), rows, "half is 0: must be above 0"),
        (with("mass", "0.0"), rows, "mass is 0: must be above 0"),
        (good.replacen(&line("poly"), "", 1), rows, "mode \"squash\": no poly: give 10 vectors"),
        (
            good.replacen(&line("poly"), "[[mode.patch]]\npoints = []", 1),
            rows,
            "displacements of control points are not supported",
        ),
        ("budget = [".into(), rows, "TOML parse error at line 1"),
    ] {
        fs::write(&file, &text)?;
        let run = closest("capped_box", &file, queries, "cold")?;
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{expected}: {message}");
        assert!(message.contains(expected), "{expected:?}: {message}");
        assert!(run.stdout.is_empty());
    }
    Ok(())
}

const RUBBER: &str = "youngs_modulus_pa = 2e5\npoissons_ratio = 0.45\ndensity_kg_per_m3 = 1100\ndamping_ratio = 0.1\n";

fn bake(folder: &Path, arguments: &[&str]) -> Result<Output, Box<dyn Error>> {
    Ok(Command::new(env!("CARGO_BIN_EXE_palpate")).arg("bake").args(arguments).current_dir(folder).output()?)
}

#[test]
fn a_material_gives_modes_that_closest_and_the_compiler_take() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let folder = directory.path();
    fs::write(folder.join("rubber.toml"), RUBBER)?;
    let run = bake(folder, &["capped_box", "--soft", "rubber.toml", "--held", "bottom", "--out", "grip.rs"])?;
    let printed = String::from_utf8_lossy(&run.stdout);
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(
        printed.contains("frequency Hz") && printed.contains("share held") && printed.contains("budget"),
        "{printed}"
    );
    let modes = folder.join("grip.modes.toml");
    let rows = "qx,qy,qz,q0,q1,q2,q3\n80,20,10,0,0,0,0\n80,20,10,0.0005,0.0005,0.0005,0.0005\n80,20,10,1,0,0,0\n";
    let found = self::printed(&closest("capped_box", &modes, rows, "cold")?)?;
    assert!((found[0].gap - 20.0).abs() < 1e-4 && (found[1].gap - 20.0).abs() > 1e-3);
    assert!(found[2].status.ends_with("clamped"));
    let source = fs::read_to_string(folder.join("grip.rs"))?;
    assert!(source.contains("pub static MODES: [palpate::field::Mode; 4]"));
    assert!(source.contains("pub const MOTION: [palpate::field::Modal; 4]"));
    // Those of the foam box that ships.
    let foam = root("soft/foam.toml");
    let foam = foam.to_str().ok_or("a path")?;
    let run = bake(folder, &["capped_box", "--soft", foam, "--held", "bottom", "--modes", "8", "--out", "foam.rs"])?;
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let source = fs::read_to_string(folder.join("foam.rs"))?;
    let at = source.find("/// Modes of deformation").ok_or("no modes")?;
    let shipped = fs::read_to_string(root("../boards/bodies/capped_box_modes.rs"))?;
    assert!(
        shipped.ends_with(&source[at..]),
        "boards/bodies/capped_box_modes.rs has drifted: its first line has the command"
    );
    // Modes of one's own are checked, and go on as they are.
    let run = bake(folder, &["capped_box", "--soft", "grip.modes.toml", "--out", "again.palp"])?;
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    assert_eq!(fs::read(folder.join("again.modes.toml"))?, fs::read(modes)?);
    Ok(())
}

#[test]
fn materials_faces_and_bodies_without_modes_are_refused_by_name() -> Result<(), Box<dyn Error>> {
    let directory = tempfile::tempdir()?;
    let folder = directory.path();
    let with = |line: &str, by: &str| RUBBER.replace(line, by);
    let modes = fs::read_to_string(modes("capped_box"))?;
    let frequency = modes.lines().find(|line| line.starts_with("frequency")).unwrap_or_default();
    let budget = modes.lines().find(|line| line.starts_with("budget")).unwrap_or_default();
    for (material, arguments, expected) in [
        (with("2e5", "nan"), &["capped_box"][..], "youngs_modulus_pa is NaN: must be above 0"),
        (with("0.45", "0.5"), &["capped_box"], "poissons_ratio is 0.5: must be above -1, at most 0.49"),
        (with("1100", "0"), &["capped_box"], "density_kg_per_m3 is 0: must be above 0"),
        (with("0.1", "-1.0"), &["capped_box"], "damping_ratio is -1: must be from 0"),
        (with("youngs_modulus_pa = 2e5\n", ""), &["capped_box"], "missing field `youngs_modulus_pa`"),
        (with("damping_ratio", "damping"), &["capped_box"], "unknown field `damping`"),
        (RUBBER.to_owned(), &["capped_box", "--held", "lid"], "--held lid: capped-box has no such face; it has "),
        (RUBBER.to_owned(), &["capped_box", "--modes", "9"], "--modes 9: a body has 1 to 8"),
        (RUBBER.to_owned(), &["table1"], "an open body has no volume"),
        (modes.replacen(frequency, "", 1), &["capped_box"], "mode \"squash\": no frequency: a body that moves"),
        (modes.replacen(budget, "budget = 0.1", 1), &["capped_box"], "may fold space"),
    ] {
        fs::write(folder.join("material.toml"), &material)?;
        let mut all = arguments.to_vec();
        all.extend(["--soft", "material.toml"]);
        let run = bake(folder, &all)?;
        let message = String::from_utf8_lossy(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{expected}: {message}");
        assert!(message.contains(expected), "{expected:?}: {message}");
        assert_eq!(fs::read_dir(folder)?.count(), 1, "{expected}");
    }
    let run = bake(folder, &["capped_box", "--soft", "nowhere.toml"])?;
    assert_eq!(run.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&run.stderr).contains("nowhere.toml: cannot be read"));
    Ok(())
}
