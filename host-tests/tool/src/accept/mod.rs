//! Acceptance of a board: it computes the very bits, in how many cycles, how evenly its ticks come, how well its
//! sensors answer, and why it was reset. What each figure must be, and how to read one that is not, is in
//! `docs/howto/acceptance.md`.
//!
//! [`examine`] asks the device, [`expected`] has what the host makes of the same script, [`judge`] compares, and
//! [`Report`] says it.

mod check;
mod examine;
mod expected;
mod judge;
mod report;

pub use check::{Check, Verdict};
pub use examine::{DeviceLine, Found, GREETING, Plan, examine};
pub use expected::{ExpectedLine, expected};
pub use judge::{Surroundings, judge};
pub use report::Report;

use crate::firmware::{Board, Program, Progress, SetUpError};
use anyhow::Context;
use std::time::Duration;

/// How long a line is waited on before the clock is looked at.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// The image of an emulated board's acceptance.
///
/// # Errors
/// What is missing, or what the compiler says.
pub fn prepared(board: Board, features: &[&str]) -> Result<Program, SetUpError> {
    Program::prepare(board, "accept", features, &Progress::new())
}

/// Examines the emulated board that runs this image.
///
/// # Errors
/// What the board did not say.
pub fn on_emulator(program: &Program, plan: &Plan) -> anyhow::Result<Found> {
    let (_running, mut line) = program.start_with_line()?;
    line.set_read_timeout(Some(PATIENCE))?;
    examine(&mut line, plan).with_context(|| format!("the emulated board {}", program.image.board.name()))
}
