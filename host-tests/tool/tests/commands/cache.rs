//! A model is baked once: what is kept gives the same answers, and what is not whole is not believed.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The answers to one query, with a cache of its own.
fn answers(cache: &Path, model: &str, query: &str) -> Result<String, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let queries = folder.path().join("in.csv");
    fs::write(&queries, format!("qx,qy,qz\n{query}\n"))?;
    let mut tool = Command::new(env!("CARGO_BIN_EXE_palpate"));
    tool.env("PALPATE_CACHE", cache).args(["closest", "--model", model, "--queries"]).arg(&queries);
    let run = tool.output()?;
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    Ok(String::from_utf8(run.stdout)?)
}

fn kept(cache: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut files: Vec<_> =
        fs::read_dir(cache.join("locators"))?.map(|file| Ok(file?.path())).collect::<Result<_, std::io::Error>>()?;
    files.sort();
    Ok(files)
}

#[test]
fn the_same_model_is_baked_once() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let cache = folder.path();
    let first = answers(cache, "thin_plate", "1,2,3")?;
    let [file] = &kept(cache)?[..] else { panic!("one locator is kept") };
    let written = fs::metadata(file)?.modified()?;
    assert_eq!(answers(cache, "thin_plate", "1,2,3")?, first);
    assert_eq!(fs::metadata(file)?.modified()?, written, "read, not written anew");
    // Other probes ask the same tables, unless they lie beyond their reach.
    answers(cache, "thin_plate", "1,2,5")?;
    assert_eq!(kept(cache)?.len(), 1);
    answers(cache, "thin_plate", "1,2,5000")?;
    answers(cache, "capped_box", "1,2,3")?;
    assert_eq!(kept(cache)?.len(), 3);
    // What ships is what was asked.
    let out = cache.join("plate.rs");
    let bake = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .env("PALPATE_CACHE", cache)
        .args(["bake", "thin_plate", "--out"])
        .arg(&out)
        .output()?;
    assert!(bake.status.success());
    assert_eq!(kept(cache)?.len(), 3);
    Ok(())
}

#[test]
fn what_is_not_whole_is_baked_anew() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let cache = folder.path();
    let first = answers(cache, "thin_plate", "1,2,3")?;
    let file = kept(cache)?.remove(0);
    let whole = fs::read(&file)?;
    let mut bent = whole.clone();
    bent[30] ^= 1;
    for spoiled in [Vec::new(), whole[..40].to_vec(), whole[..whole.len() - 1].to_vec(), bent] {
        fs::write(&file, spoiled)?;
        assert_eq!(answers(cache, "thin_plate", "1,2,3")?, first);
        assert_eq!(fs::read(&file)?, whole, "written anew");
    }
    // A folder that cannot be written to keeps nothing, and nothing else comes of it.
    assert_eq!(answers(Path::new("/dev/null"), "thin_plate", "1,2,3")?, first);
    Ok(())
}
