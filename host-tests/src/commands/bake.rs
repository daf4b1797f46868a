//! `palpate bake`: writes a model's tables as Rust source.

use super::check::{self, Loaded};
use super::output::{print, write_whole};
use crate::bake::body::{BakedBody, BodyBytes};
use crate::bake::graph;
use crate::bake::source::{self, Origin};
use anyhow::Context as _;
use clap::Args;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Writes a model's tables as Rust source, to `include!` in a module of the firmware.
///
/// A model of several patches becomes a body: `pub static BODY: palpate::body::Body` and `pub const TABLE_CRC: u32`. One of a single
/// patch becomes `pub static PATCHES: [palpate::patch::SplinePatch; 1]`. The same model gives the same bytes wherever it lies.
/// Exit status as `check`: 0 certified, 1 usable but not certified (the file is written), 2 bad input (it is not).
#[derive(Args, Debug)]
#[command(group(clap::ArgGroup::new("product").required(true).multiple(true)))]
pub struct Arguments {
    /// The model file (TOML).
    model: PathBuf,
    /// The Rust file to write.
    #[arg(long, value_name = "FILE.rs", group = "product")]
    out: Option<PathBuf>,
    /// The file to write the automaton to, as Graphviz: features, and between which of them the tracker switches.
    #[arg(long, value_name = "FILE.dot", group = "product")]
    graph: Option<PathBuf>,
    /// Prints the bytes of flash by kind.
    #[arg(long)]
    table_report: bool,
}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let loaded = Loaded::read(&arguments.model)?;
    let labels = loaded.body.labels(&loaded.model);
    if let Some(out) = &arguments.out {
        let origin = Origin {
            model_file: &file_name(&arguments.model)?,
            out_file: &file_name(out)?,
            model: loaded.text.as_bytes(),
        };
        let text = match &loaded.body.faces[..] {
            [only] => source::rust_source(&origin, std::slice::from_ref(&only.patch))
                .context("the tables do not parse as Rust")?,
            _ => source::body_source(&origin, &loaded.body, &labels)?,
        };
        write_whole(out, text.as_bytes())?;
    }
    if let Some(file) = &arguments.graph {
        write_whole(file, graph::graph(&loaded.body, &loaded.model.name, &labels).as_bytes())?;
    }
    if arguments.table_report {
        print(table_report(&loaded.body)?.as_bytes())?;
    }
    let verdict = check::worst(&loaded.surveys());
    eprintln!("{}: {} faces, {verdict}", arguments.model.display(), loaded.body.faces.len());
    Ok(check::exit_code(verdict))
}

fn table_report(body: &BakedBody) -> Result<String, std::fmt::Error> {
    let mut report = String::new();
    let bytes = BodyBytes::of(body);
    for (kind, bytes) in bytes.by_kind() {
        writeln!(report, "{kind:<16} {bytes:>8}")?;
    }
    writeln!(report, "{:<16} {:>8} bytes of flash on a 32-bit target", "all", bytes.total())?;
    Ok(report)
}

fn file_name(path: &Path) -> anyhow::Result<String> {
    let name = path.file_name().with_context(|| format!("{}: not the name of a file", path.display()))?;
    Ok(name.to_string_lossy().into_owned())
}
