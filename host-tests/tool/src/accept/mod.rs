//! Acceptance of a board: whether its bits are the host's, its cycles, the jitter of its ticks, the quality of its
//! sensors, and the reasons of its resets. The expected figures, and advice on deviations, are in
//! `docs/howto/acceptance.md`.
//!
//! [`examine`] asks the device, [`expected`] runs the same script on the host, [`judge`] compares, and [`Report`]
//! prints the result.

mod examine;
mod judge;

use crate::firmware::{Board, Program, Progress, SetUpError};
use anyhow::Context;
pub use examine::{DeviceLine, Found, GREETING, Plan, examine};
pub use judge::{Surroundings, judge};
use palpate::wire::acceptance::Counted;
use palpate_bench::exercise::Runner;
use palpate_bench::exercise::tally::Tally;
use std::fmt::{self, Display, Formatter};
use std::time::Duration;

/// How long a line is waited on before the clock is looked at.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// The image of an emulated board's acceptance.
///
/// # Errors
/// A missing tool, or the compiler's error.
pub fn prepared(board: Board, features: &[&str]) -> Result<Program, SetUpError> {
    Program::prepare(board, "accept", features, &Progress::new())
}

/// Examines the emulated board that runs this image.
///
/// # Errors
/// The board's missing answer.
pub fn on_emulator(program: &Program, plan: &Plan) -> anyhow::Result<Found> {
    let (_running, mut line) = program.start_with_line()?;
    line.set_read_timeout(Some(PATIENCE))?;
    examine(&mut line, plan).with_context(|| format!("the emulated board {}", program.image.board.name()))
}

// One thing that must hold.

/// How it came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It holds.
    Passed,
    /// It does not.
    Failed,
    /// It cannot be determined here.
    NotHere,
}

impl Verdict {
    /// Of a condition.
    pub const fn of(holds: bool) -> Self {
        if holds { Self::Passed } else { Self::Failed }
    }

    /// Its word.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::NotHere => "not here",
        }
    }
}

/// A figure, and what it must be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Check {
    /// Its name.
    pub name: &'static str,
    /// The figure found.
    pub found: String,
    /// The expected figure.
    pub must: String,
    /// How it came out.
    pub verdict: Verdict,
}

impl Check {
    /// A figure that was found.
    pub fn new(name: &'static str, found: String, must: impl Into<String>, holds: bool) -> Self {
        Self { name, found, must: must.into(), verdict: Verdict::of(holds) }
    }

    /// A figure that cannot be determined here, with the reason.
    pub fn not_here(name: &'static str, found: impl Into<String>, must: impl Into<String>) -> Self {
        Self { name, found: found.into(), must: must.into(), verdict: Verdict::NotHere }
    }
}

// What the host makes of the script.

/// A line of the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExpectedLine {
    /// The lap it belongs to.
    pub lap: &'static str,
    /// The lap's tally so far.
    pub tally: Tally,
    /// Whether that is all of the lap.
    pub is_last: bool,
}

#[derive(Default)]
struct Lines(Vec<ExpectedLine>);

impl Runner for Lines {
    fn tick(&mut self, work: impl FnOnce()) {
        work();
    }

    fn line(&mut self, lap: &'static str, tally: &Tally, is_last: bool) {
        self.0.push(ExpectedLine { lap, tally: *tally, is_last });
    }
}

/// Runs the script here, each lap for at most `most` ticks.
pub fn expected(most: u32) -> Vec<ExpectedLine> {
    let mut lines = Lines::default();
    palpate_bench::exercise::run_by(&mut lines, most);
    lines.0
}

// What is printed, and what is posted.

/// A report, as text that is Markdown too.
#[derive(Clone, Debug)]
pub struct Report {
    device: String,
    laps: String,
    /// The checks.
    pub checks: Vec<Check>,
}

impl Report {
    /// The report of a device that was reached this way.
    pub fn new(
        device: &str,
        found: &Found,
        expected: &[ExpectedLine],
        around: &Surroundings<'_>,
        checks: Vec<Check>,
    ) -> Self {
        let unit = match found.identity.counted {
            Counted::Cycles => "cycles",
            Counted::Instructions => "instructions",
        };
        let mut laps = format!(
            "| lap | ticks | state hash | longest tick, {unit} | instructions counted |\n|---|---|---|---|---|\n"
        );
        for (number, (line, theirs)) in expected.iter().zip(&found.lines).enumerate().filter(|(_, (l, _))| l.is_last) {
            let counted = around.counted.and_then(|counted| counted.get(number)).map(|line| line.longest.to_string());
            let counted = counted.unwrap_or_else(|| "–".to_owned());
            laps += &format!(
                "| {} | {} | {:08x} | {} | {counted} |\n",
                line.lap, theirs.ticks, theirs.digest, theirs.longest
            );
        }
        let device = format!(
            "{device}: {:.1} MHz, {} Hz, palpate {}",
            f64::from(found.identity.clock) / 1e6,
            found.identity.rate,
            env!("CARGO_PKG_VERSION")
        );
        Self { device, laps, checks }
    }

    /// The names of what failed.
    pub fn failed(&self) -> Vec<&'static str> {
        self.checks.iter().filter(|check| check.verdict == Verdict::Failed).map(|check| check.name).collect()
    }
}

impl Display for Report {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        writeln!(out, "# Acceptance\n\n{}. No motor can be driven by this image.\n", self.device)?;
        writeln!(out, "| | figure | found | must be |\n|---|---|---|---|")?;
        for Check { name, found, must, verdict } in &self.checks {
            writeln!(out, "| {} | {name} | {found} | {must} |", verdict.word())?;
        }
        writeln!(out, "\n{}", self.laps)?;
        match &self.failed()[..] {
            [] => writeln!(out, "**Accepted.**"),
            failed => writeln!(out, "**Not accepted:** {}.", failed.join(", ")),
        }
    }
}
