//! What the host makes of the script.

use palpate_exercise::Runner;
use palpate_exercise::tally::Tally;

/// A line of the script.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExpectedLine {
    /// The lap it belongs to.
    pub lap: &'static str,
    /// What the lap came to so far.
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

/// Runs the script here, of each lap at most so many ticks.
pub fn expected(most: u32) -> Vec<ExpectedLine> {
    let mut lines = Lines::default();
    palpate_exercise::run_by(&mut lines, most);
    lines.0
}
