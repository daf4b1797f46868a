//! A compiler for the board: whichever way is open.

use super::process::{on_path, output};
use super::way::{Way, has_core};
use super::{Progress, SetUpError, debian, without_outer_cargo};
use crate::repository::{self, NoRepository};
use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

/// How a board's code is compiled.
#[derive(Clone, Debug)]
pub struct Toolchain {
    target: &'static str,
    way: Way,
}

impl Toolchain {
    /// Takes the first way that is open: the Rust at hand; the same with the target added by rustup; Debian's Rust.
    ///
    /// # Errors
    /// Why none of them is open.
    pub fn set_up(target: &'static str, progress: &Progress) -> Result<Self, SetUpError> {
        // Before anything is installed in vain.
        repository::root()?;
        let way = if has_target(target) || (rustup_adds_target(target, progress) && has_target(target)) {
            Way::Installed
        } else {
            debian::set_up(target, progress)?
        };
        Ok(Self { target, way })
    }

    /// Whether a way is open without installing or building anything.
    pub fn is_at_hand(target: &str) -> bool {
        has_target(target) || debian::is_at_hand(target)
    }

    /// The target triple.
    pub const fn target(&self) -> &'static str {
        self.target
    }

    /// Where it builds: what one toolchain has built is no use to another.
    ///
    /// # Errors
    /// Outside of the repository.
    pub fn target_folder(&self) -> Result<PathBuf, NoRepository> {
        Ok(repository::root()?.join("target/firmware").join(match self.way {
            Way::Installed => "installed",
            Way::Debian { .. } => "debian",
        }))
    }

    /// This toolchain's cargo, with nothing left of the cargo that runs this program.
    pub fn cargo(&self) -> Command {
        self.program("cargo", debian::CARGO)
    }

    /// `cargo clippy`, complete with that word.
    ///
    /// # Errors
    /// If Debian's clippy is not there and cannot be installed.
    pub fn clippy(&self, progress: &Progress) -> Result<Command, SetUpError> {
        if let Way::Debian { .. } = self.way {
            debian::set_up_clippy(progress)?;
        }
        let mut command = self.program("cargo", debian::CARGO_CLIPPY);
        if let Way::Debian { .. } = self.way {
            // cargo would look for the subcommand among rustup's first.
            command.env("CARGO", debian::CARGO);
        }
        command.arg("clippy");
        Ok(command)
    }

    fn program(&self, installed: &str, of_debian: &str) -> Command {
        match &self.way {
            Way::Installed => {
                let mut command = Command::new(installed);
                without_outer_cargo(&mut command);
                command
            }
            Way::Debian { sysroot, linker } => {
                let mut command = Command::new(of_debian);
                // These flags are for the target only, and part of cargo's fingerprint: what was built with another
                // library is built again.
                let variable = |what: &str| {
                    let target = self.target.to_uppercase().replace(['-', '.'], "_");
                    format!("CARGO_TARGET_{target}_{what}")
                };
                without_outer_cargo(&mut command)
                    .env_remove("RUSTUP_TOOLCHAIN")
                    .env("RUSTC", debian::RUSTC)
                    .env(variable("LINKER"), linker)
                    .env(variable("RUSTFLAGS"), format!("--sysroot={}", sysroot.display()));
                command
            }
        }
    }
}

/// Whether the Rust at hand has the target's library.
fn has_target(target: &str) -> bool {
    let mut rustc = Command::new("rustc");
    let folder = output(without_outer_cargo(&mut rustc).args(["--print", "target-libdir", "--target", target]));
    folder.is_ok_and(|folder| has_core(Path::new(folder.trim())))
}

/// Asks rustup for the target, if there is a rustup that may install.
fn rustup_adds_target(target: &str, progress: &Progress) -> bool {
    if on_path("rustup").is_none() || env::var_os("RUSTUP_AUTO_INSTALL").is_some_and(|value| value == "0") {
        return false;
    }
    let add = || output(Command::new("rustup").args(["target", "add", target]));
    match progress.during(&format!("adding the target {target} with rustup"), add) {
        Ok(_) => true,
        Err(error) => {
            progress.say(&format!("rustup did not add it, looking for another way: {error}"));
            false
        }
    }
}
