//! palpate for Python: the wheel and its tests, in virtual environments of their own.

use crate::firmware::{SetUpError, on_path, without_outer_cargo};
use crate::repository;
use anyhow::Context as _;
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, ExitCode};

/// The interpreter that runs their script. The script installs everything else and lists it.
const PYTHON: &str = "python3";

/// Whether all their requirements are installed because they ran here before.
pub fn is_set_up() -> bool {
    let builder = repository::root().map(|root| root.join("target/python/builder/complete"));
    on_path(PYTHON).is_some() && builder.is_ok_and(|mark| mark.exists())
}

/// Builds the wheel, installs it in a fresh virtual environment and runs its tests there; `words` go to pytest.
///
/// # Errors
/// Where there is no Python, or no repository.
pub fn test(words: &[String]) -> anyhow::Result<ExitCode> {
    run(words)
}

/// Builds the wheel into a folder, and prints path, size and how to install it.
///
/// # Errors
/// As [`test()`].
pub fn wheel(out: Option<&Path>) -> anyhow::Result<ExitCode> {
    let folder = out.map_or_else(
        || Ok(repository::root()?.join("target/python/wheels")),
        |out| std::path::absolute(out).map_err(SetUpError::io(out.display())),
    )?;
    run(&["--wheel", &folder.to_string_lossy()])
}

fn run<S: AsRef<OsStr>>(words: &[S]) -> anyhow::Result<ExitCode> {
    if on_path(PYTHON).is_none() {
        let missing = format!("there is no {PYTHON}: install Python 3.10 or newer, with venv");
        return Err(SetUpError::NoToolchain(missing).into());
    }
    let mut python = Command::new(PYTHON);
    without_outer_cargo(&mut python);
    // Its tests have this program record a run.
    python.env("PALPATE_TOOL", std::env::current_exe()?);
    python.arg(repository::root()?.join("host-tests/python/run_tests.py")).args(words);
    let status = python.status().with_context(|| format!("{python:?}"))?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
