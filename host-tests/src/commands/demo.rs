//! `palpate demo`: runs the firmware image in closed loop with the simulated device.

use clap::Args;
use std::process::ExitCode;

/// Runs the firmware image in closed loop with the simulated device.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(_arguments: &Arguments) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not built yet")
}
