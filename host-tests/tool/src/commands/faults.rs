//! `palpate faults`: plants the failures of the page in the simulated arm.

use crate::faults::{Found, Reaction, Shown, TABLE, plant};
use anyhow::ensure;
use clap::Args;
use std::process::ExitCode;

/// Plants each failure of the faults page in a simulated device and compares detection and time with the page.
///
/// Exit status: 0, or 1 if a failure is not detected as the page states.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Simulated device.
    #[arg(long, default_value = "woodenhaptics-2016")]
    device: String,
}

/// Runs the command.
///
/// # Errors
/// Another device than the arm.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    ensure!(
        arguments.device == "woodenhaptics-2016",
        "{}: failures are planted in woodenhaptics-2016 only; leave --device out",
        arguments.device
    );
    println!("{:<8}{:<52}{:>12}{:>12}{:>12}  result", "part", "failure", "promised ms", "found ms", "motion mm");
    let mut is_good = true;
    for row in TABLE {
        let head = format!("{:<8}{:<52}", row.part, row.failure);
        if let Shown::Gap(reason) = row.shown {
            println!("{head}{:>36}  not detected: {reason}", "");
            continue;
        }
        let Some(found) = plant(row) else {
            println!("{head}{:>12}{:>24}  test {}", row.within_ms, "", row.test);
            continue;
        };
        let Found { off_ms, fault, motion_mm } = found;
        let time = off_ms.map_or_else(|| "never".to_owned(), |time| time.to_string());
        let is_as_stated = row.is_as_stated(&found);
        is_good &= is_as_stated;
        let verdict = match (is_as_stated, row.reaction) {
            (true, Reaction::Latched(fault)) => format!("off, {}: {fault}", fault.code()),
            (true, Reaction::Hold) => "off, hold".to_owned(),
            (true, Reaction::NoStart) => "no start".to_owned(),
            (false, _) => format!("NOT AS STATED: {fault:?}"),
        };
        println!("{head}{:>12}{time:>12}{motion_mm:>12.3}  {verdict}", row.within_ms);
    }
    Ok(if is_good { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
