//! `palpate closest`: closest points with the firmware's own code.

use clap::Args;
use std::process::ExitCode;

/// Closest points with the firmware's own code.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(_arguments: &Arguments) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not built yet")
}
