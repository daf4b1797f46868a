//! `palpate wheel`: the wheel for Python.

use crate::in_python;
use clap::Args;
use std::path::PathBuf;
use std::process::ExitCode;

/// Builds the wheel for Python, without its tests; prints its path, size and how to install it.
///
/// Installs missing tools in a virtual environment in target/python and lists them.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Folder for the wheel; default: target/python/wheels
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// Where there is no Python, or no repository.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    in_python::wheel(arguments.out.as_deref())
}
