//! `palpate check`: validates a model and says what is known of each patch.

use clap::Args;
use std::process::ExitCode;

/// Validates a model and says what is known of each patch.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(_arguments: &Arguments) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not built yet")
}
