//! The importer of CAD parts: a program of its own, because its reader takes minutes to compile. It is built when a
//! part is first imported.

use crate::firmware::{Progress, SetUpError, output, told, without_outer_cargo};
use crate::repository;
use anyhow::{Context as _, bail};
use std::env;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The importer, built.
#[derive(Debug)]
pub struct Importer {
    path: PathBuf,
}

/// The tolerance of a part that is imported without a word about it, millimetres.
pub const TOLERANCE: f64 = 0.01;

/// Whether a file is a CAD part by its name.
pub fn is_part(path: &Path) -> bool {
    let is = |extension: &str| ["step", "stp"].iter().any(|known| extension.eq_ignore_ascii_case(known));
    path.extension().and_then(|extension| extension.to_str()).is_some_and(is)
}

/// Imports a part within [`TOLERANCE`] and returns the text of the model file; prints the measured deviations on
/// standard error.
///
/// # Errors
/// A faulty part.
pub fn model_of(part: &Path) -> anyhow::Result<String> {
    let importer = Importer::build(&Progress::new())?;
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("model.toml");
    let wishes = Wishes { tolerance: TOLERANCE, solid: None };
    eprint!("{}", importer.import(part, &out, &wishes)?);
    Ok(std::fs::read_to_string(out)?)
}

/// Settings of an import.
#[derive(Clone, Debug)]
pub struct Wishes {
    /// Maximum deviation, millimetres.
    pub tolerance: f64,
    /// Only the solids of this name.
    pub solid: Option<String>,
}

impl Importer {
    /// Builds the importer; after the first time this is quick.
    ///
    /// # Errors
    /// An error of the compiler.
    pub fn build(progress: &Progress) -> Result<Self, SetUpError> {
        let repository = repository::root()?;
        let path = repository.join("target/apart/palpate-cad");
        let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        without_outer_cargo(&mut cargo);
        cargo.current_dir(&repository).args(["build", "--quiet", "--profile", "apart", "--locked"]);
        cargo.args(["--package", "palpate-cad", "--target-dir", "target"]);
        let what = if path.exists() { "building the importer" } else { "building the importer, once, about a minute" };
        progress.during(what, || output(&mut cargo))?;
        Ok(Self { path })
    }

    /// Imports a part into a model file and returns the importer's report.
    ///
    /// # Errors
    /// A faulty part; then no file is written.
    pub fn import(&self, part: &Path, out: &Path, wishes: &Wishes) -> anyhow::Result<String> {
        let mut command = Command::new(&self.path);
        command.arg(part).arg(out).arg(wishes.tolerance.to_string());
        if let Some(solid) = &wishes.solid {
            command.arg("--solid").arg(solid);
        }
        command.arg("--progress").stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().with_context(|| format!("{} does not run", self.path.display()))?;
        let lines = child.stderr.take().map(BufReader::new).into_iter().flat_map(BufRead::lines);
        let message = told(lines.map_while(Result::ok));
        let done = child.wait_with_output()?;
        if !done.status.success() {
            if message.is_empty() {
                bail!("{}: the importer exited with {} and no message", part.display(), done.status);
            }
            bail!(message);
        }
        Ok(String::from_utf8_lossy(&done.stdout).into_owned())
    }
}
