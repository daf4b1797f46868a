//! `palpate closest`: closest points with the firmware's own code.

use super::bake::MAX_MARGIN;
use super::output::{print, write_whole};
use super::progress;
use crate::models::ModelFile;
use crate::queries;
use crate::reach::Reach;
use clap::{Args, ValueEnum};
use palpate::body::Effort;
use palpate_bake::modes;
use palpate_truth::closest::{Found, Status};
use std::path::PathBuf;
use std::process::ExitCode;

/// Closest points by the firmware's own single-precision code.
///
/// Reads the columns qx,qy,qz (others and lines starting with # are ignored) in the model's unit. Writes a row per
/// query, in the same sequence: patch,u,v,px,py,pz,gap,steps,status,error_bound. patch is the name, or the index of an unnamed
/// patch; gap is the distance from the query to p, negative inside a closed body; steps counts patch evaluations.
///
/// cold: every row by itself. The locator names the parts of patches that can own the closest point, and a second-order
/// search runs in each. status: converged; step-limit if a search was stopped short of its minimum; far if the query is
/// beyond the locator's reach, where its lists are not proved. Of a model or part this command widens the locator for
/// such queries, as bake --margin, and prints a note; a .palp keeps its own, as do a device and Python. error_bound, of a
/// step-limit row: a bound of the error of |gap| to the stored single-precision surface, by a search in double precision.
///
/// --modes: the body deforms; every row has its own q. cold then goes on from the search with ticks of the tracker. A q beyond the
/// budget of the file is set to it, and the row's status ends with "clamped".
///
/// track: rows are successive servo ticks of one probe. The first row is cold; each other row is --ticks ticks of the
/// tracker at --effort, and more after a jump above an eighth of the body's size, to locate it again. status: tracking, or
/// god-object in contact: p then stays where the probe went in, and the sign of gap is its own.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Model: a file, or the name of a shipped one.
    #[arg(long)]
    model: PathBuf,
    /// Queries (CSV with a header).
    #[arg(long, value_name = "IN.csv")]
    queries: PathBuf,
    /// Modes of deformation: the queries then have columns q0,q1,… too, metres.
    #[arg(long, value_name = "MODES.toml")]
    modes: Option<PathBuf>,
    /// Relation of the rows.
    #[arg(long, value_enum, default_value_t = Mode::Cold)]
    mode: Mode,
    /// Servo ticks per row, for --mode track.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    ticks: u32,
    /// Steps and evaluations of the audit that a tick may spend, each 1 to 255; default: that of the boards.
    #[arg(long, value_name = "STEPS,CANDIDATES", value_parser = effort, default_value = "4,8")]
    effort: Effort,
    /// Output; default: standard output.
    #[arg(long, value_name = "OUT.csv")]
    out: Option<PathBuf>,
}

fn effort(text: &str) -> Result<Effort, String> {
    let number = |text: &str| text.parse().ok().filter(|number| *number > 0_u8);
    let found = text
        .split_once(',')
        .and_then(|(steps, candidates)| Some(Effort { steps: number(steps)?, candidates: number(candidates)? }));
    found.ok_or_else(|| "an effort is two whole numbers from 1 to 255, such as 4,8".into())
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Mode {
    /// Every row by itself.
    Cold,
    /// Rows are successive ticks of one probe.
    Track,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let file = ModelFile::read(&arguments.model)?;
    let model = file.model()?;
    let per_metre = model.unit.per_metre();
    let modes = arguments.modes.as_ref().map(|path| modes::read(path, &model)).transpose()?;
    let queries = queries::read(&arguments.queries, &model, modes.as_ref().map_or(0, Vec::len))?;
    let baked = file.body(&model)?;
    let probes: Vec<_> = queries.iter().map(|query| query.probe).collect();
    let bar = progress::work();
    let progress = |done, all| bar.tell("cells of space", done, all);
    let options = baked.locator_options();
    let shipped = file.located(baked, &options, None, &progress)?;
    let far = |body, options: &_, probes: &_| file.located(body, options, Some(probes), &progress);
    let reach = Reach::new(shipped, &probes, far)?.with_effort(arguments.effort);
    drop(bar);
    if reach.queries_beyond > 0 && file.baked().is_none() {
        eprintln!(
            "{}: {} of {} queries lie beyond the locator's default reach: answered with a locator that reaches them, as by \
             bake --margin {:.1}",
            file.label,
            reach.queries_beyond,
            probes.len(),
            (0.1 * (10.0 * reach.margin).ceil()).min(MAX_MARGIN)
        );
    }
    let solvers = reach.solvers();
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["patch", "u", "v", "px", "py", "pz", "gap", "steps", "status", "error_bound"])?;
    let mut state = None;
    let mut deformed_state = None;
    for query in queries {
        let (mut is_clamped, probe, ticks) = (false, query.probe, arguments.ticks);
        let (own, common) = (solvers.of(probe), solvers.of_all());
        let found = match (&modes, arguments.mode) {
            (Some(modes), mode) => {
                is_clamped = !own.deformed(modes).holds(&query.q);
                match (mode, &mut deformed_state) {
                    (Mode::Track, Some(state)) => common.deformed(modes).track(state, probe, &query.q, ticks),
                    (Mode::Track, None) => start(&mut deformed_state, common.deformed(modes).cold(probe, &query.q)),
                    (Mode::Cold, _) => own.deformed(modes).cold(probe, &query.q).0,
                }
            }
            (None, Mode::Track) => match &mut state {
                Some(state) => common.track(state, probe, ticks),
                None => start(&mut state, common.cold(probe)),
            },
            (None, Mode::Cold) => own.cold(probe).0,
        };
        let point = (found.point.as_dvec3() + model.centre) * per_metre;
        let [u, v] = found.parameters;
        let distance = point.distance(query.given);
        let gap = if found.is_inside { -distance } else { distance };
        let numbers = [u, v, point.x, point.y, point.z, gap].map(significant);
        let status = match found.status {
            Status::Converged => "converged",
            Status::StepLimit => "step-limit",
            Status::Far => "far",
            Status::Tracking => "tracking",
            Status::GodObject => "god-object",
        };
        let status = if is_clamped { format!("{status} clamped") } else { status.to_owned() };
        let bound = match found.status {
            Status::StepLimit if modes.is_none() => significant(own.error_bound(&found, probe) * per_metre),
            _ => String::new(),
        };
        let (label, steps) = (model.patch_label(found.patch), found.evaluations.to_string());
        let fields =
            [label.as_str()].into_iter().chain(numbers.iter().map(String::as_str)).chain([&*steps, &*status, &*bound]);
        writer.write_record(fields)?;
    }
    let text = writer.into_inner()?;
    match &arguments.out {
        Some(path) => write_whole(path, &text)?,
        None => print(&text)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// Keeps the state of a track's first row.
fn start<S>(state: &mut Option<S>, (found, first): (Found, S)) -> Found {
    *state = Some(first);
    found
}

/// Nine significant digits: enough to tell any two `f32` apart.
pub(super) fn significant(value: f64) -> String {
    let scientific = format!("{value:.8e}");
    let exponent: i32 = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()).unwrap_or(0);
    if value == 0.0 || !(-5..9).contains(&exponent) {
        return scientific;
    }
    format!("{value:.*}", (8 - exponent) as usize)
}
