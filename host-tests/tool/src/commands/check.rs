//! `palpate check`: validates a model and certifies its patches.

use super::output::print;
use super::{progress, table_report};
use crate::models::ModelFile;
use anyhow::Context as _;
use clap::Args;
use palpate::body::{EdgeKind, Effort, TickLimit};
use palpate::track::{Integrator, PerformanceLimits};
use palpate_bake::body::BakedSide;
use palpate_bake::certificate::{Certificate, Finding};
use palpate_bake::flaws::{self, Flaw};
use palpate_bake::locator::LocatorOptions;
use palpate_bake::survey::{Regularity, Survey, Verdict};
use palpate_bake::{BakedBody, Model, Unit};
use palpate_truth::rides::{Lateness, Rides};
use rayon::prelude::*;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Validates a model and certifies each patch.
///
/// A patch is certified if it is proved to be regular, convex (up to rounding), smooth, with normals within 90°, and to
/// lead every probe up to half the body's size above it to its closest point. Unproved properties are sampled and
/// marked. The second table has the limits of performance for explicit Euler at --rate, --distance and --speed. With
/// --rides the tracker rides along the baked body, and the table shows how late it finds the nearest point where that
/// jumps. Exit status: 0 certified, 1 usable but not certified, 2 bad input.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Model: a file, or the name of a shipped one.
    model: PathBuf,
    /// Servo rate, Hz.
    #[arg(long, default_value_t = 4_000.0, value_parser = positive)]
    rate: f32,
    /// Distance of the probe from the surface, mm.
    #[arg(long, default_value_t = 5.0, value_parser = positive)]
    distance: f32,
    /// Speed of the probe, m/s.
    #[arg(long, default_value_t = 0.1, value_parser = positive)]
    speed: f32,
    /// Number of rides along the body.
    #[arg(long, default_value_t = 0, value_name = "N")]
    rides: u32,
}

/// A number above 0.
fn positive(text: &str) -> Result<f32, String> {
    let value: f32 = text.parse().map_err(|_| format!("{text:?} is not a number"))?;
    if value > 0.0 && value < f32::INFINITY { Ok(value) } else { Err("it must be positive and finite".to_owned()) }
}

/// A model with its tables.
pub(super) struct Loaded {
    pub file: ModelFile,
    pub model: Model,
    pub body: BakedBody,
}

impl Loaded {
    /// Reads, validates and bakes a model file.
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        Self::of(ModelFile::read(path)?)
    }

    /// Validates and bakes what was read.
    pub(super) fn of(file: ModelFile) -> anyhow::Result<Self> {
        let model = file.model()?;
        let body = file.body(&model)?;
        Ok(Self { file, model, body })
    }

    /// One for each face.
    pub(super) fn surveys(&self) -> Vec<Survey> {
        let range = self.range();
        self.body.faces.par_iter().map(|face| Survey::new(&face.surface, &face.patch, range)).collect()
    }

    /// The verdict that [`worst`] gives, without surveys: one face that is not certified ends it.
    pub(super) fn verdict(&self, flaws: &[Flaw]) -> Verdict {
        let faces: Vec<_> = self.body.faces.iter().map(|face| (&face.surface, &face.patch)).collect();
        let is_certified = !flaws.iter().any(Flaw::is_wrong) && Certificate::all_hold(&faces, self.range());
        if is_certified { Verdict::Certified } else { Verdict::Usable }
    }

    /// The distance over a face for which it is certified, metres.
    fn range(&self) -> f64 {
        LocatorOptions::default().margin * f64::from(self.body.size)
    }

    /// Flaws of the body as a whole.
    pub(super) fn flaws(&self) -> Vec<Flaw> {
        let surfaces: Vec<_> = self.body.faces.iter().map(|face| face.surface.clone()).collect();
        flaws::find(&surfaces, &self.body.topology)
    }

    /// A flaw in words, in the model's unit and frame.
    pub(super) fn describe(&self, flaw: &Flaw) -> String {
        let (labels, unit) = (self.body.labels(&self.model), self.model.unit);
        let name = |index: usize| labels.get(index).cloned().unwrap_or_default();
        let kind = if flaw.is_wrong() { "flaw" } else { "note" };
        format!("{kind}: {}", flaw.describe(&name, self.model.centre, unit))
    }

    /// Names of the faces.
    pub(super) fn labels(&self) -> Vec<String> {
        self.body.labels(&self.model).iter().map(|label| label.replace('"', "")).collect()
    }
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let loaded = Loaded::read(&arguments.model)?;
    let unit = loaded.model.unit;
    let mut report = String::new();
    let (surveys, labels) = (loaded.surveys(), loaded.labels());
    let wide = labels.iter().map(|label| label.chars().count()).max().unwrap_or_default().max("patch".len());
    verdicts(&mut report, wide, &labels, &surveys)?;
    tables(&mut report, wide, unit, &labels, &surveys)?;
    features(&mut report, &loaded.body)?;
    let flaws = loaded.flaws();
    for flaw in &flaws {
        writeln!(report, "{}", loaded.describe(flaw))?;
    }
    limits(&mut report, arguments, &labels, &surveys)?;
    let body = loaded.body.to_body().with_context(|| loaded.file.label.clone())?;
    let (fitted, boards) = (body.fitted(TickLimit::BENCH), TickLimit::BENCH);
    report += "\n";
    let is_file = loaded.file.baked().is_some();
    let is_patch = loaded.body.faces.len() == 1 && !is_file;
    report += &if is_patch { table_report::of_patch_tick()? } else { table_report::of_tick(&fitted, boards, is_file)? };
    if !is_patch && !fitted.fits(boards) {
        writeln!(
            report,
            "a tick may exceed the bench boards' limit: for a faster board raise `palpate bake --tick-cycles`"
        )?;
    }
    if arguments.rides > 0 {
        ride(&mut report, arguments, &loaded)?;
    }
    let verdict = worst(&surveys, &flaws);
    let certified = surveys.iter().filter(|survey| survey.verdict == Verdict::Certified).count();
    writeln!(
        report,
        "\n{}: {verdict} ({certified} of {} patches certified)",
        arguments.model.display(),
        surveys.len()
    )?;
    if verdict == Verdict::Usable {
        writeln!(report, "{}", not_certified(!is_patch))?;
    }
    print(report.as_bytes())?;
    Ok(exit_code(verdict))
}

/// The verdict on each patch; below it the reasons why it is not certified and possible remedies.
fn verdicts(report: &mut String, wide: usize, labels: &[String], surveys: &[Survey]) -> std::fmt::Result {
    writeln!(
        report,
        "{:<wide$}  {:<21}  {:<14}  {:<14}  {:<14}  {:<26}  {:<14}  outline",
        "patch", "verdict", "regular", "convex", "smooth", "normals within 90 degrees", "no false rest"
    )?;
    for (label, survey) in labels.iter().zip(surveys) {
        let certificate = &survey.certificate;
        writeln!(
            report,
            "{label:<wide$}  {:<21}  {:<14}  {:<14}  {:<14}  {:<26}  {:<14}  {}",
            survey.verdict.to_string(),
            brief(&certificate.regular),
            brief(&certificate.convex),
            brief(&certificate.smooth),
            format!("{} (half angle {:.1})", brief(&certificate.normal_cone), certificate.cone_angle),
            brief(&certificate.equilibrium),
            brief(&certificate.outline)
        )?;
        for reason in &survey.reasons {
            writeln!(report, "    {reason}")?;
        }
    }
    writeln!(
        report,
        "\nproved: of the stored table; up to rounding: apart from the rounding of its numbers to f32; sampled (n): n random probes found \
         nothing wrong, which proves nothing; no: refuted, or not determined"
    )
}

/// The stored form of each patch.
fn tables(report: &mut String, wide: usize, unit: Unit, labels: &[String], surveys: &[Survey]) -> std::fmt::Result {
    writeln!(
        report,
        "\n{:<wide$} {:>6} {:>8} {:>10} {:>10} {:>10} {:>16} {:>9} {:>9} {:>9} {:>7}",
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
    for (label, survey) in labels.iter().zip(surveys) {
        writeln!(
            report,
            "{label:<wide$} {:>6} {:>8} {:>10} {:>10.4} {:>10} {:>16} {:>9.3e} {:>9.3e} {:>9.3e} {:>7}",
            format!("{},{}", survey.degree[0], survey.degree[1]),
            format!("{}x{}", survey.spans[0], survey.spans[1]),
            if survey.rational { "rational" } else { "polynomial" },
            survey.size * unit.per_metre(),
            smoothness(survey.continuity),
            regularity(&survey.regularity),
            survey.shape.second_derivatives.uu,
            survey.shape.second_derivatives.uv,
            survey.shape.second_derivatives.vv,
            survey.bytes.total(),
        )?;
    }
    Ok(())
}

/// How the patches hang together.
fn features(report: &mut String, body: &BakedBody) -> std::fmt::Result {
    let topology = &body.topology;
    let kinds = [EdgeKind::Convex, EdgeKind::Smooth, EdgeKind::Reflex, EdgeKind::Mixed, EdgeKind::Open];
    let [convex, smooth, reflex, mixed, open] = kinds.map(|kind| topology.count(kind));
    let poles = body.faces.iter().flat_map(|face| &face.sides).filter(|side| matches!(side, BakedSide::Pole { .. }));
    writeln!(
        report,
        "\nfeatures: {} faces; {} edges (convex {convex}, smooth {smooth}, reflex {reflex}, mixed {mixed}, open {open}; sampled); \
         {} vertices; {} sides are poles; {} piece(s), {}; {}",
        body.faces.len(),
        body.edges.len(),
        body.vertices.len(),
        poles.count(),
        topology.components(),
        if topology.is_closed() { "closed" } else { "open" },
        if body.is_convex { "convex" } else { "not known to be convex" }
    )?;
    let [low, high] = body.extent().map(|corner| (corner * 1e3).to_array());
    let along = |axis: usize| format!("{} {:.3} to {:.3}", ["x", "y", "z"][axis], low[axis], high[axis]);
    writeln!(
        report,
        "extent: {}, {}, {} mm, in the frame of its tables (a grid of points)",
        along(0),
        along(1),
        along(2)
    )
}

/// A finding without its reason, which follows below.
fn brief(finding: &Finding) -> String {
    match finding {
        Finding::Failed(_) => "no".to_owned(),
        finding => finding.to_string(),
    }
}

/// The limits of performance of each patch.
fn limits(report: &mut String, arguments: &Arguments, labels: &[String], surveys: &[Survey]) -> std::fmt::Result {
    let &Arguments { rate, distance, speed, .. } = arguments;
    writeln!(report, "\nlimits at {rate} Hz, up to {distance} mm away, at {speed} m/s, explicit Euler:")?;
    writeln!(
        report,
        "{:<16} {:>21} {:>19} {:>8} {:>9} {:>11} {:>7} {:>8} {:>9}",
        "patch", "curvature/(1/m)", "tangents/m", "bend", "stable K", "monotone K", "lag/um", "bound/um", "depth/mm"
    )?;
    for (label, survey) in labels.iter().zip(surveys) {
        let shape = &survey.shape;
        let limits = PerformanceLimits::new(shape, Integrator::Euler, rate, 1e-3 * distance);
        let gain = limits.monotone_gain(0.0);
        writeln!(
            report,
            "{label:<16} {:>21} {:>19} {:>8.1} {:>9.0} {:>11.0} {:>7.2} {:>8.2} {:>9}",
            format!("{:.2} to {:.2}", shape.curvature.min, shape.curvature.max),
            format!("{:.4} to {:.4}", shape.min_stretch.sqrt(), shape.max_stretch.sqrt()),
            shape.max_bend,
            limits.stable_gain(),
            gain,
            1e6 * limits.lag(gain, speed),
            1e6 * limits.lag_bound(gain, speed),
            // Rounding may bend a plane a little.
            match 1e3 * limits.depth_limit() {
                depth if depth < 1e6 => format!("{depth:.2}"),
                _ => "no limit".to_owned(),
            }
        )?;
    }
    Ok(())
}

/// How late the tracker has the nearest point.
fn ride(report: &mut String, arguments: &Arguments, loaded: &Loaded) -> anyhow::Result<()> {
    let &Arguments { rate, distance, speed, rides, .. } = arguments;
    let (options, bar) = (loaded.body.locator_options(), progress::work());
    let progress = |depth, _| bar.tell("octree", depth, options.depth);
    let body = loaded.file.located(loaded.body.clone(), &options, None, &progress)?.to_body()?;
    drop(bar);
    let Lateness { ticks, most, excess } = Rides { count: rides, rate, speed, distance: 1e-3 * distance }.along(&body);
    writeln!(
        report,
        "\nmeasured on {rides} rides, {ticks} ticks, from {distance} mm in front, at {speed} m/s and {rate} Hz: the nearest point was late by \
         {most} ticks ({:.2} ms) at most, until then up to {:.4} {} too far",
        1e3 * most as f32 / rate,
        f64::from(excess) * loaded.model.unit.per_metre(),
        loaded.model.unit.symbol()
    )?;
    if body.is_convex() {
        writeln!(
            report,
            "the body is convex: in front of it the witness point follows the nearest point, and there is no audit"
        )?;
    } else {
        let (candidates, pass) = (body.locator().longest_list(), body.audit_ticks());
        let (alone, fitted) = (body.with_effort(Effort::ONE).audit_ticks(), body.fitted(TickLimit::BENCH));
        let [rides, boards] =
            [body.effort(), fitted.effort()].map(|effort| format!("{},{}", effort.steps, effort.candidates));
        writeln!(
            report,
            "proved: a pass of the audit looks at all candidates of the probe's cell, {candidates} at most, within {pass} ticks \
             ({:.0} ms) at effort {rides}, that of these rides, within {} at {boards}, that of the bench boards, within \
             {alone} at 1,1",
            1e3 * pass as f32 / rate,
            fitted.audit_ticks()
        )?;
    }
    Ok(())
}

/// The verdict on a model is that on its worst patch; a certificate of its patches does not hold for a body that
/// intersects itself.
fn worst(surveys: &[Survey], flaws: &[Flaw]) -> Verdict {
    if flaws.iter().any(Flaw::is_wrong) {
        return Verdict::Usable;
    }
    surveys.iter().map(|survey| survey.verdict).max().unwrap_or(Verdict::Usable)
}

/// The meaning of the verdict to a user: a body has an audit, a patch by itself has none.
pub(super) fn not_certified(is_body: bool) -> String {
    let until = if is_body { "until the audit finds a nearer point" } else { "for good: a single patch has no audit" };
    format!(
        "not certified: usable on a device, but no proof covers every probe: tracking may rest at a local minimum {until} \
         (`palpate check` has the reasons)"
    )
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
