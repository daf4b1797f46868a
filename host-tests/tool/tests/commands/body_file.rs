//! A body's file as the commands write and take it.

use palpate_bake::Random;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn palpate(arguments: &[&str]) -> Result<Output, Box<dyn Error>> {
    Ok(Command::new(env!("CARGO_BIN_EXE_palpate")).args(arguments).output()?)
}

fn in_bodies(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../boards/bodies").join(name).with_extension("palp")
}

/// What a command prints, and how it ends.
fn said(arguments: &[&str]) -> Result<(String, Option<i32>), Box<dyn Error>> {
    let run = palpate(arguments)?;
    assert!(run.status.code().is_some_and(|code| code < 2), "{}", String::from_utf8_lossy(&run.stderr));
    Ok((String::from_utf8(run.stdout)?, run.status.code()))
}

#[test]
fn a_file_bakes_and_checks_as_its_model_does() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let [out, again] = ["capped_box.palp", "again.palp"].map(|name| folder.path().join(name));
    let [out_name, again_name] = [&out, &again].map(|path| path.to_str().unwrap_or_default());
    assert_eq!(said(&["bake", "capped_box", "--out", out_name])?.1, Some(0), "certified");
    let (report, _) = said(&["bake", out_name, "--out", again_name, "--table-report"])?;
    assert!(fs::read(&again)? == fs::read(&out)?, "baked from its file it is another");
    assert!(report.contains("RAM for it           1992 bytes"), "{report}");
    assert_eq!(said(&["check", out_name])?.1, Some(0), "certified");
    assert!(fs::read(in_bodies("capped_box"))? == fs::read(&out)?, "the committed file has drifted");
    Ok(())
}

#[test]
fn the_report_on_a_single_patch_has_the_size_of_its_file() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let [out, source] = ["sphere.palp", "sphere.rs"].map(|name| folder.path().join(name));
    for file in [&out, &source] {
        let (report, _) = said(&["bake", "sphere", "--table-report", "--out", file.to_str().unwrap_or_default()])?;
        let row = |kind: &str| report.lines().find_map(|line| line.strip_prefix(kind)?.split_whitespace().next());
        assert_eq!(row("as a file"), Some(fs::metadata(&out)?.len().to_string().as_str()), "{report}");
        // A face of 57 words and four edges of 13, as palpate.h has them.
        assert_eq!(row("RAM for it"), Some((4 * (57 + 4 * 13)).to_string().as_str()), "{report}");
        // The source is a patch, the file a body of one face.
        let is_source = file == &source;
        assert_eq!(
            [row("each tick"), row("audit").map(|_| "an audit")],
            if is_source { [Some("1"), None] } else { [None, Some("an audit")] }
        );
    }
    Ok(())
}

#[test]
fn a_file_answers_as_its_model_does() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).to_str().unwrap_or_default().to_owned();
    let (file, queries) = (in_bodies("capped_box"), path("queries.csv"));
    let file = file.to_str().unwrap_or_default();
    let mut random = Random::new(19);
    let mut rows = String::from("qx,qy,qz\n");
    for _ in 0..300 {
        let [x, y, z] = [(-20.0, 80.0), (-15.0, 55.0), (-15.0, 50.0)].map(|(low, high)| random.between(low, high));
        rows += &format!("{x},{y},{z}\n");
    }
    fs::write(&queries, rows)?;
    for mode in ["cold", "track"] {
        let closest = |model: &str| said(&["closest", "--model", model, "--queries", &queries, "--mode", mode]);
        assert_eq!(closest(file)?, closest("capped_box")?);
    }
    let sim = |model: &str| said(&["sim", "--device", "woodenhaptics-2016", "--model", model, "--seconds", "0.5"]);
    let (from_file, from_model) = (sim(file)?, sim("capped_box")?);
    assert!(from_model.0.contains("state hash"), "{}", from_model.0);
    assert_eq!(from_file, from_model);
    Ok(())
}

#[test]
fn what_cannot_be_done_with_a_file_is_told() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let broken = folder.path().join("broken.palp");
    let mut bytes = fs::read(in_bodies("capped_box"))?;
    bytes[700] ^= 1;
    fs::write(&broken, &bytes)?;
    let broken = broken.to_str().unwrap_or_default();
    let file = in_bodies("capped_box");
    let file = file.to_str().unwrap_or_default();
    for (arguments, wanted) in [
        (vec!["check", broken], "broken.palp: the file is damaged: its CRC-32 is"),
        (vec!["check", "absent.palp"], "absent.palp: cannot be read"),
        (vec!["bake", file, "--out", "x.palp", "--margin", "2"], "already contains a locator"),
        (vec!["figures", "--model", file], "holds tables only"),
    ] {
        let run = palpate(&arguments)?;
        let error = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.code() == Some(2) && error.contains(wanted), "{arguments:?}: {error}");
    }
    Ok(())
}
