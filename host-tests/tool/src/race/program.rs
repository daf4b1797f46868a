//! The contestants' program: building and running it.

use super::callgrind;
use super::scene::Scene;
use crate::firmware::{Progress, SetUpError, output, without_outer_cargo};
use crate::repository;
use anyhow::{Context as _, ensure};
use serde::Deserialize;
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Contestants compiled into the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Who {
    /// palpate and Newton's method: seconds to compile.
    Own,
    /// The peers as well, and the host's instruction for the square root for palpate: minutes.
    All,
}

/// The program, built.
#[derive(Debug)]
pub struct Program {
    path: PathBuf,
}

/// Result of one contestant on one scene.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// Its name.
    pub contestant: String,
    /// Its answers, query by query.
    pub answers: Vec<Line>,
}

/// Instructions spent by one contestant on one scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counted {
    /// Its name.
    pub contestant: String,
    /// Instructions, query by query.
    pub instructions: Vec<u64>,
}

/// A line of the program's output.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Line {
    contestant: String,
    pub kind: Kind,
    pub a: Option<f64>,
    pub b: Option<f64>,
    pub c: Option<f64>,
    pub nanoseconds: Option<u64>,
}

/// Kind of an answer.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    None,
    Parameters,
    Point,
}

impl Program {
    /// Builds the program.
    ///
    /// # Errors
    /// An error of the compiler.
    pub fn build(who: Who, progress: &Progress) -> Result<Self, SetUpError> {
        let (features, what) = match who {
            Who::Own => ("", "building palpate's contestants"),
            Who::All => ("peers", "building the contestants, once some minutes"),
        };
        let root = repository::root()?;
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        without_outer_cargo(&mut cargo);
        cargo.current_dir(&root).args(["build", "--quiet", "--profile", "abort", "--locked"]);
        cargo.args(["--package", "palpate-race", "--features", features, "--target-dir", "target"]);
        progress.during(what, || output(&mut cargo))?;
        Ok(Self { path: root.join("target/abort/palpate-race") })
    }

    /// Runs the contestants of these names, or all, by the clock.
    pub(super) fn time(&self, scene: &Scene, only: &[&str]) -> anyhow::Result<Vec<Run>> {
        let folder = tempfile::tempdir()?;
        let mut command = Command::new(&self.path);
        read(&output(add_arguments(&mut command, scene, folder.path(), "time", only)?)?)
    }

    /// Counts the instructions of each query, or of one in [`Scene::stride`], for the contestants of these names or for
    /// all.
    ///
    /// # Errors
    /// If valgrind or the program does not run.
    pub fn count(&self, scene: &Scene, only: &[&str]) -> anyhow::Result<Vec<Counted>> {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("callgrind");
        let mut command = callgrind::command(&file);
        command.arg(&self.path);
        let runs = read(&output(add_arguments(&mut command, scene, folder.path(), "count", only)?)?)?;
        let counts = callgrind::read(&file)?;
        let each = scene.queries.len().div_ceil(scene.stride());
        ensure!(
            counts.len() == runs.len() * each,
            "{} queries were counted, of {} contestants with {} each",
            counts.len(),
            runs.len(),
            each
        );
        let counted =
            |(run, counts): (Run, &[u64])| Counted { contestant: run.contestant, instructions: counts.to_vec() };
        Ok(runs.into_iter().zip(counts.chunks(each)).map(counted).collect())
    }
}

fn add_arguments<'a>(
    command: &'a mut Command,
    scene: &Scene,
    folder: &Path,
    how: &str,
    only: &[&str],
) -> anyhow::Result<&'a mut Command> {
    let file = folder.join("scene");
    fs::write(&file, scene.to_text()?)?;
    Ok(command.arg(file).args([scene.task.name(), how]).args(only))
}

fn read(text: &str) -> anyhow::Result<Vec<Run>> {
    let mut runs: Vec<Run> = Vec::new();
    for line in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let line: Line = line.context("the contestants' output")?;
        match runs.last_mut() {
            Some(run) if run.contestant == line.contestant => run.answers.push(line),
            _ => runs.push(Run { contestant: line.contestant.clone(), answers: vec![line] }),
        }
    }
    Ok(runs)
}
