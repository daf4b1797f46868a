//! `palpate firmware`: cargo for the boards.

use crate::firmware::{AnyBoard, Progress, SetUpError, Toolchain};
use anyhow::Context;
use clap::Args;
use std::process::{Command, ExitCode};

/// Runs cargo in a board's folder, with a compiler for its target: set up if it is missing.
///
/// `palpate firmware build --release` builds the images as `demo` and `test` do. What a board's own settings say holds
/// too, such as the runner that flashes it: `palpate firmware --board stm32g4 run --release`.
#[derive(Args, Debug)]
#[command(trailing_var_arg = true)]
pub struct Arguments {
    /// The board
    #[arg(long, value_enum, default_value_t)]
    board: AnyBoard,
    /// What cargo is to do, such as `build --release` or `clippy`.
    #[arg(required = true, allow_hyphen_values = true)]
    cargo: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let progress = Progress::new();
    let toolchain = Toolchain::set_up(arguments.board.target(), &progress)?;
    let mut command = command(&toolchain, arguments, &progress)?;
    let status = command.current_dir(arguments.board.folder()?).status().with_context(|| format!("{command:?}"))?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn command(toolchain: &Toolchain, arguments: &Arguments, progress: &Progress) -> Result<Command, SetUpError> {
    let (mut command, rest) = match &arguments.cargo[..] {
        [first, rest @ ..] if first == "clippy" => (toolchain.clippy(progress)?, rest),
        all => (toolchain.cargo(), all),
    };
    if let Some(config) = arguments.board.cargo_config()? {
        command.arg("--config").arg(config);
    }
    command.args(rest);
    // After `--` come the linter's arguments, not cargo's: the folder is named by the environment.
    command.env("CARGO_TARGET_DIR", toolchain.target_folder()?);
    Ok(command)
}
