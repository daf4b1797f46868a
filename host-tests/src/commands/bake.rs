//! `palpate bake`: writes a model's tables as Rust source.

use clap::Args;
use std::process::ExitCode;

/// Writes a model's tables as Rust source.
#[derive(Args, Debug)]
pub struct Arguments {}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(_arguments: &Arguments) -> anyhow::Result<ExitCode> {
    anyhow::bail!("not built yet")
}
