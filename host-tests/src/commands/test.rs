//! `palpate test`: sets up what it needs and runs every test.

use clap::Args;
use std::process::ExitCode;

/// Sets up what it needs and runs every test.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(_arguments: &Arguments) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not built yet")
}
