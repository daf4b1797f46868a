//! The tool, as a program beside the browser.

use anyhow::{Context as _, ensure};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;
use tempfile::TempDir;

/// The folder of a page that is written once for all tests.
static PAGE: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().to_string_lossy().into_owned();
    palpate(&["page", "--out", &out]).expect("the page is written");
    folder
});

/// The page's address.
pub fn address() -> String {
    format!("file://{}", PAGE.path().join("index.html").display())
}

/// A file of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A variable that the command of the tests sets.
pub fn given(variable: &str) -> anyhow::Result<PathBuf> {
    let path =
        env::var_os(variable).with_context(|| format!("{variable} is not set: run cargo palpate test --page"))?;
    Ok(PathBuf::from(path))
}

/// Runs the tool; what it prints, errors after the rest.
pub fn said(arguments: &[&str]) -> anyhow::Result<(Option<i32>, String)> {
    said_in(&repository(""), arguments)
}

fn said_in(folder: &Path, arguments: &[&str]) -> anyhow::Result<(Option<i32>, String)> {
    let run = Command::new(given("PALPATE_TOOL")?).args(arguments).current_dir(folder).output()?;
    let text = [run.stdout, run.stderr].concat();
    Ok((run.status.code(), String::from_utf8(text)?))
}

/// The same, of a run that must succeed.
pub fn palpate(arguments: &[&str]) -> anyhow::Result<String> {
    palpate_in(&repository(""), arguments)
}

/// The same from a folder.
pub fn palpate_in(folder: &Path, arguments: &[&str]) -> anyhow::Result<String> {
    let (code, text) = said_in(folder, arguments)?;
    ensure!(code.is_some_and(|code| code < 2), "palpate {}: {text}", arguments.join(" "));
    Ok(text)
}
