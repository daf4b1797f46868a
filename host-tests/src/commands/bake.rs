//! `palpate bake`: writes a model's tables as Rust source.

use super::check::{self, Loaded};
use super::output::{print, write_whole};
use crate::bake::source::{self, Origin};
use anyhow::Context as _;
use clap::Args;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes a model's tables as Rust source, to `include!` in a module of the firmware.
///
/// The file defines `pub static PATCHES: [palpate::patch::SplinePatch; N]`. The same model gives the same bytes wherever it lies.
/// Exit status as `check`: 0 certified, 1 usable but not certified (the file is written), 2 bad input (it is not).
#[derive(Args, Debug)]
pub struct Arguments {
    /// The model file (TOML).
    model: PathBuf,
    /// The Rust file to write.
    #[arg(long, value_name = "FILE.rs")]
    out: PathBuf,
    /// Prints the bytes of flash by kind, for each patch.
    #[arg(long)]
    table_report: bool,
}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let loaded = Loaded::read(&arguments.model)?;
    let origin = Origin {
        model_file: &file_name(&arguments.model)?,
        out_file: &file_name(&arguments.out)?,
        model: loaded.text.as_bytes(),
    };
    let text = source::rust_source(&origin, &loaded.baked).context("the tables do not parse as Rust")?;
    write_whole(&arguments.out, text.as_bytes())?;
    if arguments.table_report {
        print(table_report(&loaded)?.as_bytes())?;
    }
    let verdict = check::worst(&loaded.surveys());
    eprintln!("{}: {} patches, {verdict}", arguments.out.display(), loaded.baked.len());
    Ok(check::exit_code(verdict))
}

fn table_report(loaded: &Loaded) -> Result<String, std::fmt::Error> {
    let mut report = String::new();
    writeln!(report, "{:<20} {:>12} {:>8} {:>8} {:>8}   bytes", "patch", "coefficients", "breaks", "record", "total")?;
    let mut line = |label: &str, [coefficients, breaks, record]: [usize; 3]| {
        let total = coefficients + breaks + record;
        writeln!(report, "{label:<20} {coefficients:>12} {breaks:>8} {record:>8} {total:>8}")
    };
    let mut sums = [0; 3];
    for (index, survey) in loaded.surveys().iter().enumerate() {
        let bytes = [survey.bytes.coefficients, survey.bytes.breaks, survey.bytes.record];
        line(&loaded.model.patch_label(index), bytes)?;
        sums = std::array::from_fn(|kind| sums[kind] + bytes[kind]);
    }
    line("all", sums)?;
    Ok(report)
}

fn file_name(path: &Path) -> anyhow::Result<String> {
    let name = path.file_name().with_context(|| format!("{}: not the name of a file", path.display()))?;
    Ok(name.to_string_lossy().into_owned())
}
