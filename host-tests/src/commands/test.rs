//! `palpate test`: sets up what it needs and runs every test.

use crate::firmware::{self, Board, Choice, Progress, Transport, WITH_FIRMWARE};
use anyhow::Context;
use clap::Args;
use std::env;
use std::process::{Command, ExitCode};

/// Sets up what it needs and runs every test: host, emulator, drift and budgets.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Leaves the emulator out: only what plain `cargo test` runs.
    #[arg(long)]
    without_emulator: bool,
    /// Passed on to `cargo test`.
    #[arg(last = true)]
    cargo_test: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let progress = Progress::new();
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    firmware::without_outer_cargo(&mut cargo);
    cargo.current_dir(firmware::repository()).args(["test", "--workspace"]).args(&arguments.cargo_test);
    cargo.env_remove(WITH_FIRMWARE);
    if !arguments.without_emulator {
        for board in Board::ALL {
            let ready = firmware::prepare(&Choice { board, ..Choice::default() }, &progress)
                .context("the tests on the emulated boards cannot run (--without-emulator leaves them out)")?;
            progress.say(&format!("{}: {}", board.core(), ready.qemu.version));
            for transport in [Transport::Uart, Transport::Fifo] {
                let image = ready.images.of(transport);
                progress.say(&format!(
                    "image {}: {} bytes of flash, {} bytes of RAM",
                    transport.binary(),
                    image.flash,
                    image.ram
                ));
            }
        }
        cargo.env(WITH_FIRMWARE, "1");
    }
    let status = cargo.status().with_context(|| format!("{cargo:?}"))?;
    Ok(if status.success() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
