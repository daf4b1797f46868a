//! A copy of this program that outlives a rebuild.

use anyhow::Context as _;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A copy of a program in a folder of its own, deleted when dropped.
///
/// `cargo test` replaces the tool's file where the tests were built with other features than the tool. The path of the
/// running program then names a deleted file, and tests that start the tool would fail.
#[derive(Debug)]
pub struct OwnCopy {
    path: PathBuf,
    _folder: TempDir,
}

impl OwnCopy {
    /// Copies the running program.
    ///
    /// # Errors
    /// If its file cannot be read or copied.
    pub fn new() -> anyhow::Result<Self> {
        Self::of(&std::env::current_exe()?)
    }

    fn of(program: &Path) -> anyhow::Result<Self> {
        let folder = tempfile::Builder::new().prefix("palpate-tool-").tempdir()?;
        let path = folder.path().join(program.file_name().context("the running program has no file name")?);
        fs::copy(program, &path).with_context(|| format!("cannot copy {}", program.display()))?;
        // The keys of the cache hold the time that the program was built.
        if let Ok(built) = fs::metadata(program).and_then(|file| file.modified()) {
            let _ = File::open(&path).and_then(|copy| copy.set_modified(built));
        }
        Ok(Self { path, _folder: folder })
    }

    /// The copy's file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::Command;

    #[test]
    fn the_copy_runs_after_the_program_was_deleted() {
        let folder = tempfile::tempdir().unwrap();
        let program = folder.path().join("program");
        fs::copy(std::env::current_exe().unwrap(), &program).unwrap();
        let copy = OwnCopy::of(&program).unwrap();
        let built = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
        assert_eq!(built(copy.path()), built(&program));
        fs::remove_file(&program).unwrap();
        let run = Command::new(copy.path()).arg("--list").output().unwrap();
        assert!(run.status.success(), "{run:?}");
    }
}
