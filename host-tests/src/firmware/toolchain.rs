//! A compiler for the board: whichever way is open.

use super::process::{on_path, output};
use super::{Progress, SetUpError, debian, repository, without_outer_cargo};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The board's target.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// How the board's code is compiled.
#[derive(Clone, Debug)]
pub enum Toolchain {
    /// The Rust at hand has the target's library.
    Installed,
    /// Debian's Rust with a library for the target, built here.
    Debian {
        /// Where the library lies.
        sysroot: PathBuf,
        /// The linker.
        linker: PathBuf,
    },
}

impl Toolchain {
    /// Takes the first way that is open: the Rust at hand; the same with the target added by rustup; Debian's Rust.
    ///
    /// # Errors
    /// Why none of them is open.
    pub fn set_up(progress: &Progress) -> Result<Self, SetUpError> {
        if has_target() || (rustup_adds_target(progress) && has_target()) {
            return Ok(Self::Installed);
        }
        debian::set_up(progress)
    }

    /// Where it builds: what one toolchain has built is no use to another.
    pub fn target_folder(&self) -> PathBuf {
        repository().join("target/firmware").join(match self {
            Self::Installed => "installed",
            Self::Debian { .. } => "debian",
        })
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
        if let Self::Debian { .. } = self {
            debian::set_up_clippy(progress)?;
        }
        let mut command = self.program("cargo", debian::CARGO_CLIPPY);
        if let Self::Debian { .. } = self {
            // cargo would look for the subcommand among rustup's first.
            command.env("CARGO", debian::CARGO);
        }
        command.arg("clippy");
        Ok(command)
    }

    fn program(&self, installed: &str, of_debian: &str) -> Command {
        match self {
            Self::Installed => {
                let mut command = Command::new(installed);
                without_outer_cargo(&mut command);
                command
            }
            Self::Debian { sysroot, linker } => {
                let mut command = Command::new(of_debian);
                // These flags are for the target only, and part of cargo's fingerprint: what was built with another
                // library is built again.
                without_outer_cargo(&mut command)
                    .env_remove("RUSTUP_TOOLCHAIN")
                    .env("RUSTC", debian::RUSTC)
                    .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_LINKER", linker)
                    .env("CARGO_TARGET_THUMBV7EM_NONE_EABIHF_RUSTFLAGS", format!("--sysroot={}", sysroot.display()));
                command
            }
        }
    }
}

/// Whether the Rust at hand has the target's library.
fn has_target() -> bool {
    let mut rustc = Command::new("rustc");
    let folder = output(without_outer_cargo(&mut rustc).args(["--print", "target-libdir", "--target", TARGET]));
    folder.is_ok_and(|folder| has_core(Path::new(folder.trim())))
}

/// Whether a folder holds a compiled `core`.
pub(super) fn has_core(folder: &Path) -> bool {
    fs::read_dir(folder)
        .is_ok_and(|entries| entries.flatten().any(|entry| entry.file_name().to_string_lossy().starts_with("libcore-")))
}

/// Asks rustup for the target, if there is a rustup that may install.
fn rustup_adds_target(progress: &Progress) -> bool {
    if on_path("rustup").is_none() || env::var_os("RUSTUP_AUTO_INSTALL").is_some_and(|value| value == "0") {
        return false;
    }
    let add = || output(Command::new("rustup").args(["target", "add", TARGET]));
    match progress.during(&format!("adding the target {TARGET} with rustup"), add) {
        Ok(_) => true,
        Err(error) => {
            progress.say(&format!("rustup did not add it, looking for another way: {error}"));
            false
        }
    }
}
