//! What is printed, and what is posted.

use super::{Check, ExpectedLine, Found, Surroundings, Verdict};
use palpate::wire::acceptance::Counted;
use std::fmt::{self, Display, Formatter};

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
