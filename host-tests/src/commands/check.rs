//! `palpate check`: validates a model and says what is known of each patch.

use super::output::print;
use crate::bake::survey::{Regularity, Survey, Verdict};
use crate::bake::{BakedPatch, Model, ModelError};
use clap::Args;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Validates a model and says what is known of each patch.
///
/// Second-derivative bounds are proved; regularity is sampled, 12 intervals a span. Convexity, outline and normal cone
/// are not proved yet, so no patch is certified. Exit status: 0 certified, 1 usable but not certified, 2 bad input.
#[derive(Args, Debug)]
pub struct Arguments {
    /// The model file (TOML).
    model: PathBuf,
}

/// A model with its tables.
pub(super) struct Loaded {
    pub text: String,
    pub model: Model,
    pub baked: Vec<BakedPatch>,
}

impl Loaded {
    /// Reads, validates and bakes a model file.
    pub(super) fn read(path: &Path) -> Result<Self, ModelError> {
        let file = path.display().to_string();
        let text = fs::read_to_string(path).map_err(|cause| ModelError::Read { file: file.clone(), cause })?;
        let model = Model::parse(&text, &file)?;
        let baked = BakedPatch::all(&model, &file)?;
        Ok(Self { text, model, baked })
    }

    pub(super) fn surveys(&self) -> Vec<Survey> {
        self.model.patches.iter().zip(&self.baked).map(|(patch, baked)| Survey::new(patch, baked)).collect()
    }
}

/// Runs the command.
///
/// # Errors
/// What went wrong, for the person at the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let loaded = Loaded::read(&arguments.model)?;
    let unit = loaded.model.unit;
    let mut report = String::new();
    writeln!(
        report,
        "{:<16} {:>6} {:>8} {:>10} {:>10} {:>10} {:>16} {:>9} {:>9} {:>9} {:>7}  verdict",
        "patch",
        "degree",
        "spans",
        "kind",
        format!("size/{}", unit.symbol()),
        "smooth",
        "regular(sampled)",
        "f_uu/m",
        "f_uv/m",
        "f_vv/m",
        "bytes"
    )?;
    let surveys = loaded.surveys();
    for (index, survey) in surveys.iter().enumerate() {
        writeln!(
            report,
            "{:<16} {:>6} {:>8} {:>10} {:>10.4} {:>10} {:>16} {:>9.3e} {:>9.3e} {:>9.3e} {:>7}  {}",
            loaded.model.patch_label(index),
            format!("{},{}", survey.degree[0], survey.degree[1]),
            format!("{}x{}", survey.spans[0], survey.spans[1]),
            if survey.rational { "rational" } else { "polynomial" },
            survey.size * unit.per_metre(),
            smoothness(survey.continuity),
            regularity(&survey.regularity),
            survey.bounds.uu,
            survey.bounds.uv,
            survey.bounds.vv,
            survey.bytes.total(),
            survey.verdict
        )?;
        for reason in &survey.reasons {
            writeln!(report, "    {reason}")?;
        }
    }
    let verdict = worst(&surveys);
    writeln!(report, "{}: {verdict}", arguments.model.display())?;
    print(report.as_bytes())?;
    Ok(exit_code(verdict))
}

/// The verdict on a model is that on its worst patch.
pub(super) fn worst(surveys: &[Survey]) -> Verdict {
    surveys.iter().map(|survey| survey.verdict).max().unwrap_or(Verdict::Usable)
}

pub(super) fn exit_code(verdict: Verdict) -> ExitCode {
    match verdict {
        Verdict::Certified => ExitCode::SUCCESS,
        Verdict::Usable => ExitCode::from(1),
    }
}

fn smoothness(continuity: [Option<usize>; 2]) -> String {
    let [along_u, along_v] =
        continuity.map(|continuity| continuity.map_or_else(|| "inf".to_owned(), |order| order.to_string()));
    format!("C{along_u},C{along_v}")
}

fn regularity(regularity: &Regularity) -> String {
    match regularity {
        Regularity::Regular { least_sine } => format!("sine {least_sine:.3}"),
        Regularity::Singular { parameters: [u, v] } => format!("no, {u:.3},{v:.3}"),
    }
}
