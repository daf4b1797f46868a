//! Counting instructions with valgrind's callgrind: exact, the same from run to run, and quick enough for every query
//! of every contestant. Hardware counters are closed in most virtual machines; single-stepping counts as exactly, but
//! some 70,000 instructions a second are too few for peers that need millions a query.

use crate::firmware::{Progress, apt_install, on_path};
use anyhow::{Context as _, ensure};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The function that is one query, for both options that name it. The patterns differ because callgrind keeps one set
/// of options for each pattern and forgets the first option when the second repeats the pattern.
const COLLECT: &str = "palpate_race::measure::counted*";
const DUMP: &str = "*measure::counted*";

/// Whether valgrind is there.
pub(super) fn is_set_up() -> bool {
    on_path("valgrind").is_some()
}

/// Installs valgrind if it is missing.
pub(super) fn set_up(progress: &Progress) -> anyhow::Result<()> {
    if is_set_up() {
        return Ok(());
    }
    apt_install(&["valgrind"], progress)
        .map_err(anyhow::Error::msg)
        .context("valgrind is missing: it counts the instructions")
}

/// A command that counts each call of [`COLLECT`] into a part of `file`. The program and its arguments are still to be
/// added.
pub(super) fn command(file: &Path) -> Command {
    let mut command = Command::new("valgrind");
    command.args(["--quiet", "--tool=callgrind", "--combine-dumps=yes", "--compress-strings=yes"]);
    command.arg(format!("--toggle-collect={COLLECT}")).arg(format!("--dump-after={DUMP}"));
    command.arg(format!("--callgrind-out-file={}", file.display()));
    command
}

/// The instructions of each call, in order.
pub(super) fn read(file: &Path) -> anyhow::Result<Vec<u64>> {
    let text = fs::read_to_string(file).with_context(|| file.display().to_string())?;
    let mut counts = Vec::new();
    let mut is_call = false;
    for line in text.lines() {
        if let Some(trigger) = line.strip_prefix("desc: Trigger: ") {
            is_call = trigger.starts_with("--dump-after=");
        } else if let Some(totals) = line.strip_prefix("totals: ").filter(|_| is_call) {
            counts.push(totals.trim().parse().with_context(|| format!("{}: {line}", file.display()))?);
            is_call = false;
        }
    }
    ensure!(!counts.is_empty(), "{}: no query was counted", file.display());
    Ok(counts)
}
