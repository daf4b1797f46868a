//! Running other programs.

use super::Progress;
use crate::repository::NoRepository;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::{env, io};
use thiserror::Error;

/// Why the firmware cannot be built or run.
#[derive(Debug, Error)]
pub enum SetUpError {
    /// No repository.
    #[error(transparent)]
    NoRepository(#[from] NoRepository),
    /// No emulator, and none can be had.
    #[error("emulator not available: {0}")]
    NoEmulator(String),
    /// No compiler for the target, and none can be had.
    #[error("compiler for the target not available: {0}")]
    NoToolchain(String),
    /// No browser, and none can be had.
    #[error("browser not available: {0}")]
    NoBrowser(String),
    /// A program ended with an error.
    #[error("`{command}` failed ({status})\n{output}")]
    Failed {
        /// The command line.
        command: String,
        /// Its exit status.
        status: String,
        /// The end of its output.
        output: String,
    },
    /// A file or program could not be reached.
    #[error("{what}: {source}")]
    Io {
        /// Which.
        what: String,
        /// Why.
        source: io::Error,
    },
    /// The image is not what the board can load.
    #[error("{path}: {reason}")]
    Image {
        /// The file.
        path: PathBuf,
        /// The fault of the image.
        reason: String,
    },
}

impl SetUpError {
    /// For `map_err`: names what could not be reached.
    pub fn io(what: impl ToString) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { what: what.to_string(), source }
    }
}

/// Cargo tells the programs it runs about the package and toolchain it runs them for. A cargo run from here works for
/// another package, perhaps with another toolchain: it keeps the user's settings of network and registries, and those of
/// the build itself, because cargo builds everything again where they differ.
pub fn without_outer_cargo(command: &mut Command) -> &mut Command {
    const KEPT: [&str; 7] = [
        "CARGO_HOME",
        "CARGO_HTTP_",
        "CARGO_INCREMENTAL",
        "CARGO_NET_",
        "CARGO_PROFILE_DEV_",
        "CARGO_REGISTR",
        "CARGO_TERM_",
    ];
    for name in env::vars_os().filter_map(|(name, _)| name.into_string().ok()) {
        let is_cargo = name == "CARGO" || name.starts_with("CARGO_") || name.starts_with("RUSTC");
        let is_other = ["RUSTFLAGS", "RUSTDOCFLAGS", "LD_LIBRARY_PATH", "OUT_DIR"].contains(&name.as_str());
        if is_other || (is_cargo && !KEPT.iter().any(|kept| name.starts_with(kept))) {
            command.env_remove(name);
        }
    }
    command
}

/// Runs a program quietly and gives what it wrote to its standard output.
pub(crate) fn output(command: &mut Command) -> Result<String, SetUpError> {
    let shown = format!("{command:?}");
    let output = command.stdin(Stdio::null()).output().map_err(SetUpError::io(&shown))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said);
    let lines: Vec<&str> = said.lines().collect();
    let output_end = lines[lines.len().saturating_sub(60)..].join("\n");
    Err(SetUpError::Failed { command: shown, status: output.status.to_string(), output: output_end })
}

/// The program of this name on the search path.
pub(crate) fn on_path(name: &str) -> Option<PathBuf> {
    env::split_paths(&env::var_os("PATH")?).map(|folder| folder.join(name)).find(|path| path.is_file())
}

/// Installs Debian packages, after saying so. Only where that needs no password.
///
/// # Errors
/// Why not, with the command that a person could run.
pub(crate) fn apt_install(packages: &[&str], progress: &Progress) -> Result<(), String> {
    let list = packages.join(" ");
    let by_hand = format!("sudo apt-get install --no-install-recommends {list}");
    if on_path("apt-get").is_none() {
        return Err(format!("there is no apt-get to install {list} with"));
    }
    let is_root = output(Command::new("id").arg("-u")).is_ok_and(|id| id.trim() == "0");
    let may_sudo = !is_root && output(Command::new("sudo").args(["-n", "true"])).is_ok();
    if !is_root && !may_sudo {
        return Err(format!("no right to install packages; to do it by hand: {by_hand}"));
    }
    let apt = |arguments: &[&str]| {
        let mut command = if is_root { Command::new("apt-get") } else { Command::new("sudo") };
        if !is_root {
            command.args(["-n", "apt-get"]);
        }
        output(
            command
                .env("DEBIAN_FRONTEND", "noninteractive")
                .args(["-qq", "-o", "DPkg::Lock::Timeout=120"])
                .args(arguments),
        )
    };
    progress.during(&format!("installing with apt-get: {list}"), || {
        // Stale lists do not matter as long as the packages are found.
        let updated = apt(&["update"]);
        apt(&[&["install", "-y", "--no-install-recommends"], packages].concat())
            .map(drop)
            .map_err(|error| format!("{error}\n{}", updated.err().map(|e| e.to_string()).unwrap_or_default()))
            .map_err(|error| format!("{}\nto do it by hand: {by_hand}", error.trim_end()))
    })
}

/// Whether a path is there, as an option to chain on.
pub(super) fn existing(path: impl AsRef<Path>) -> Option<PathBuf> {
    path.as_ref().exists().then(|| path.as_ref().to_path_buf())
}
