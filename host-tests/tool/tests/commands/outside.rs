//! A crate of somebody else's, as `cargo new` makes it: two dependencies, a few lines of build script, a closest point,
//! and tables that have the bits that were baked.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const BUILD: &str = r#"fn main() -> Result<(), Box<dyn std::error::Error>> {
    for model in ["half_ball.toml", "part.toml"] {
        palpate_bake::Bake::new(model).write_to(std::env::var("OUT_DIR")?)?;
    }
    Ok(())
}
"#;

const MAIN: &str = r#"use palpate::patch::Patch as _;

mod part {
    include!(concat!(env!("OUT_DIR"), "/part.rs"));
}

/// Rational faces, planes, ruled separators and poles.
mod half_ball {
    include!(concat!(env!("OUT_DIR"), "/half_ball.rs"));
}

fn main() {
    for (body, crc) in [(&part::BODY, part::TABLE_CRC), (&half_ball::BODY, half_ball::TABLE_CRC)] {
        assert_eq!((body.table_crc(), body.baked_crc()), (crc, Some(crc)));
    }
    // The same, whatever the model.
    let surface: &half_ball::Surface = half_ball::SURFACE;
    assert_eq!((surface.table_crc(), surface.faces().len()), (half_ball::TABLE_CRC, 8));
    let found = part::BODY.locate(palpate::math::vec3(0.02, 0.03, 0.08));
    let [u, v] = found.parameters;
    println!("{:?}", part::BODY.faces()[usize::from(found.face)].patch.evaluate(u, v).point.to_array());
}
"#;

fn repository() -> PathBuf {
    palpate_tool::repository::root().expect("tests run in it")
}

/// Cargo as a stranger calls it, but without a network, and with one folder for what it builds, so that a second run of
/// the tests finds it built.
fn cargo(folder: &Path, arguments: &[&str]) -> Result<Output, Box<dyn Error>> {
    let mut cargo = Command::new("cargo");
    palpate_tool::firmware::without_outer_cargo(&mut cargo);
    cargo.current_dir(folder).env("CARGO_TARGET_DIR", repository().join("target/outside"));
    Ok(cargo.env("CARGO_NET_OFFLINE", "true").args(arguments).output()?)
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_crate_outside_of_the_repository_bakes_a_shipped_model_and_finds_a_closest_point() -> Result<(), Box<dyn Error>> {
    let temporary = tempfile::tempdir()?;
    let made = cargo(temporary.path(), &["new", "--quiet", "--vcs", "none", "palpate-outside"])?;
    assert!(made.status.success(), "{}", said(&made));
    let folder = temporary.path().join("palpate-outside");

    let [library, bake] = ["", "host-tests/bake"].map(|path| repository().join(path));
    let manifest = fs::read_to_string(folder.join("Cargo.toml"))?;
    assert!(manifest.trim_end().ends_with("[dependencies]"), "cargo new makes another manifest: {manifest}");
    // The profile is for the baking, which takes ten times as long without.
    let more = format!(
        "palpate = {{ path = {library:?} }}\n\n[build-dependencies]\npalpate-bake = {{ path = {bake:?} }}\n\n\
         [profile.dev.package.palpate]\nopt-level = 1\n\n[profile.dev.package.palpate-bake]\nopt-level = 1\n"
    );
    fs::write(folder.join("Cargo.toml"), manifest + &more)?;
    // The versions that are there without a network.
    fs::copy(repository().join("Cargo.lock"), folder.join("Cargo.lock"))?;
    fs::write(folder.join("build.rs"), BUILD)?;
    fs::write(folder.join("src/main.rs"), MAIN)?;
    fs::write(folder.join("half_ball.toml"), palpate_truth::generate::models::half_ball())?;
    let model = include_str!("../../../models/capped_box.toml");
    fs::write(folder.join("part.toml"), model)?;

    let run = cargo(&folder, &["run"])?;
    assert!(run.status.success(), "{}", said(&run));
    assert!(!said(&run).contains("warning"), "{}", said(&run));
    // What the tool says of the same probe, in the model's millimetres. Each search ends within its own steps of the
    // closest point, where the distance is level: it is the distance that agrees, to the spacing of f32.
    fs::write(folder.join("probe.csv"), "qx,qy,qz\n20,30,80\n")?;
    let mut closest = Command::new(env!("CARGO_BIN_EXE_palpate"));
    closest.args(["closest", "--model", "capped_box", "--queries"]).arg(folder.join("probe.csv"));
    let answer = String::from_utf8(closest.output()?.stdout)?;
    let gap: f64 = answer.lines().nth(1).and_then(|row| row.split(',').nth(6)).ok_or("no answer")?.parse()?;
    let printed = String::from_utf8(run.stdout)?;
    let point: Vec<f64> =
        printed.trim().trim_matches(['[', ']']).split(", ").map(str::parse).collect::<Result<_, _>>()?;
    let distance =
        point.iter().zip([0.02, 0.03, 0.08]).map(|(at, probe)| (at - probe) * (at - probe)).sum::<f64>().sqrt();
    assert!(point.len() == 3 && (1e3 * distance - gap).abs() < 1e-4, "{printed}{answer}");

    // A spoilt model is refused by file, patch and entry, and a mended one is taken: cargo watches it.
    let spoilt = model.replacen("degree = [", "degree = [9", 1);
    assert_ne!(spoilt, model);
    fs::write(folder.join("part.toml"), spoilt)?;
    let refused = cargo(&folder, &["build"])?;
    let message = said(&refused);
    assert!(!refused.status.success() && message.contains("Error: part.toml: patch \""), "{message}");
    assert!(message.contains("degree along u is 9"), "{message}");
    fs::write(folder.join("part.toml"), model)?;
    let mended = cargo(&folder, &["build"])?;
    assert!(mended.status.success(), "{}", said(&mended));
    Ok(())
}
