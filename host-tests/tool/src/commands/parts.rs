//! `palpate parts`: what CAD parts become, a row each.

use super::check::Loaded;
use super::output::print;
use super::progress;
use crate::cad::{self, Importer};
use crate::firmware::Progress;
use crate::processor;
use crate::queries;
use crate::reach::Reach;
use anyhow::{Context as _, ensure};
use clap::Args;
use palpate_bake::BakedBody;
use palpate_bake::body::BodyBytes;
use serde::Deserialize;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Imports and bakes CAD parts and prints a table with one row each.
///
/// Columns: faces and patches; largest deviation of patches and part, either way; flash bytes; bake time in processor
/// seconds over all cores and clock seconds; fraction of the locator's leaves with a proof of the way down (`bake
/// --table-report` has the rest). If PART.csv lies beside PART.step, with columns qx,qy,qz,dist,inside: the largest
/// error of a cold query's distance, with a locator that reaches every row, and the rows on the wrong side. If PART_track.csv does: the largest error at one
/// tick per row. Last, patches for each face, the import's processor seconds, and the most memory taken so far, import or
/// bake.
///
/// A folder stands for the parts in it. A list (public.toml) names parts of public repositories; --checkouts has each
/// repository as OWNER/NAME. The reason of a part that is refused follows the table. Exit status 1 if a part is refused or
/// absent.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Parts: .step or .stp files, models, folders, or lists
    #[arg(value_name = "PART.step", required = true)]
    parts: Vec<PathBuf>,
    /// Folder with the repositories of a list
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    checkouts: PathBuf,
}

/// A list of public parts.
#[derive(Deserialize)]
struct List {
    part: Vec<Public>,
}

/// A part of a public repository.
#[derive(Deserialize)]
struct Public {
    repository: String,
    path: PathBuf,
}

/// The files that an argument stands for.
fn files(of: &Path, checkouts: &Path) -> anyhow::Result<Vec<PathBuf>> {
    if of.is_dir() {
        let mut files: Vec<_> = fs::read_dir(of)?.flatten().map(|entry| entry.path()).collect();
        files.retain(|file| cad::is_part(file));
        files.sort();
        return Ok(files);
    }
    if of.extension().is_some_and(|extension| extension == "toml")
        && let Ok(List { part }) = toml::from_str(&fs::read_to_string(of)?)
    {
        return Ok(part.iter().map(|part| checkouts.join(&part.repository).join(&part.path)).collect());
    }
    Ok(vec![of.to_path_buf()])
}

/// The names of the columns.
const HEADER: &str = "\
| part | faces | patches | deviation, mm | flash, bytes | bake, processor s | clock s | proved, % | cold, mm | wrong side | track, mm | patches a face | import, processor s | memory, MB |
|---|---|---|---|---|---|---|---|---|---|---|---|---|---|
";

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    print(HEADER.as_bytes())?;
    let mut refused = String::new();
    for argument in &arguments.parts {
        for part in files(argument, &arguments.checkouts).with_context(|| argument.display().to_string())? {
            match row(&part) {
                Ok(row) => print(row.as_bytes())?,
                Err(error) => {
                    let name = part.file_stem().unwrap_or(part.as_os_str()).to_string_lossy();
                    print(format!("| {name} |{}\n", " – |".repeat(13)).as_bytes())?;
                    writeln!(refused, "{}: {error:#}", part.display())?;
                }
            }
        }
    }
    print(refused.as_bytes())?;
    Ok(ExitCode::from(u8::from(!refused.is_empty())))
}

fn row(part: &Path) -> anyhow::Result<String> {
    if cad::is_part(part) {
        // The compiler's time is not the import's.
        Importer::build(&Progress::new())?;
    }
    let before = processor::seconds_of_children();
    let mut loaded = Loaded::read(part)?;
    let imported = processor::seconds_of_children().zip(before).map(|(now, before)| now - before);
    let options = loaded.body.locator_options();
    let bar = progress::work();
    let (begun, spent) = (Instant::now(), processor::seconds());
    let (body, report) =
        loaded.body.located(&options, &|done, all| bar.tell("cells of space", done, all)).context("no locator")?;
    let seconds = begun.elapsed().as_secs_f64();
    let spent = processor::seconds().zip(spent).map(|(now, before)| now - before);
    drop(bar);
    loaded.body = body;
    let name = part.file_stem().unwrap_or(part.as_os_str()).to_string_lossy();
    let faces = said(&loaded.file.text, " faces (");
    let patches = loaded.model.patches.len();
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    let deviation = deviation(&loaded.file.text);
    let proved = 100.0 * report.leaves_by.proved as f64 / report.leaves as f64;
    let mut row = format!(
        "| {name} | {} | {patches} | {} | {} | {} | {seconds:.1} | {proved:.0} |",
        or_none(faces.map(|faces| format!("{faces:.0}"))),
        or_none(deviation.map(|deviation| format!("{deviation:.4}"))),
        BodyBytes::of(&loaded.body).total(),
        or_none(spent.map(|spent| format!("{spent:.1}"))),
    );
    let memory = processor::megabytes();
    let cold = errors(&loaded, &part.with_extension("csv"), Mode::Cold)?;
    let track = errors(&loaded, &part.with_file_name(format!("{name}_track.csv")), Mode::Track)?;
    match cold {
        Some(Errors { greatest, wrong_side }) => write!(row, " {greatest:.4} | {wrong_side} |")?,
        None => row.push_str(" – | – |"),
    }
    match track {
        Some(Errors { greatest, .. }) => write!(row, " {greatest:.4} |")?,
        None => row.push_str(" – |"),
    }
    let share = or_none(faces.map(|faces| format!("{:.1}", patches as f64 / faces)));
    let imported = or_none(imported.map(|seconds| format!("{seconds:.1}")));
    writeln!(row, " {share} | {imported} | {} |", or_none(memory.map(|memory| format!("{memory:.0}"))))?;
    Ok(row)
}

/// The largest deviation either way, mm, by a model's first lines.
pub(super) fn deviation(text: &str) -> Option<f64> {
    ["patches from part ", "part from patches "].into_iter().filter_map(|way| after(text, way)).reduce(f64::max)
}

/// The number before some words of a model's first lines.
fn said(text: &str, words: &str) -> Option<f64> {
    let line = text.lines().take_while(|line| line.starts_with('#')).find(|line| line.contains(words))?;
    line.split(words).next()?.rsplit(' ').next()?.parse().ok()
}

/// The number behind some words of a model's first lines.
fn after(text: &str, words: &str) -> Option<f64> {
    let line = text.lines().take_while(|line| line.starts_with('#')).find(|line| line.contains(words))?;
    line.split(words).nth(1)?.split(' ').next()?.parse().ok()
}

#[derive(Clone, Copy)]
enum Mode {
    Cold,
    Track,
}

/// How far answers are off.
struct Errors {
    /// Of a distance, in the model's unit.
    greatest: f64,
    /// Rows with the wrong side, of those that are farther from the surface than the maximum error.
    wrong_side: usize,
}

/// The firmware's answers beside the distances of a file, if it is there.
fn errors(loaded: &Loaded, path: &Path, mode: Mode) -> anyhow::Result<Option<Errors>> {
    if !path.is_file() {
        return Ok(None);
    }
    let queries = queries::read(path, &loaded.model, 0)?;
    let known = known(path)?;
    ensure!(queries.len() == known.len(), "{}: rows without a distance", path.display());
    // As `closest` does it: the tables that ship, and others for what lies beyond their reach.
    let probes: Vec<_> = queries.iter().map(|query| query.probe).collect();
    let far = |body: BakedBody, options: &_, probes: &_| Ok(body.located_for(probes, options, &|_, _| ())?);
    let reach = Reach::new(loaded.body.clone(), &probes, far)?;
    let solvers = reach.solvers();
    let per_metre = loaded.model.unit.per_metre();
    let mut state = None;
    let mut greatest: f64 = 0.0;
    let mut sides = Vec::new();
    for (query, (distance, inside)) in queries.iter().zip(known) {
        let found = match (mode, &mut state) {
            (Mode::Track, Some(state)) => solvers.of_all().track(state, query.probe, 1),
            (Mode::Track, None) => {
                let (found, start) = solvers.of_all().cold(query.probe);
                state = Some(start);
                found
            }
            (Mode::Cold, _) => solvers.of(query.probe).cold(query.probe).0,
        };
        let point = (found.point.as_dvec3() + loaded.model.centre) * per_metre;
        greatest = greatest.max((point.distance(query.given) - distance).abs());
        if inside.is_some_and(|inside| inside != found.is_inside) {
            sides.push(distance);
        }
    }
    let wrong_side = sides.into_iter().filter(|distance| *distance > greatest).count();
    Ok(Some(Errors { greatest, wrong_side }))
}

/// The columns `dist` and `inside`, which may be empty.
fn known(path: &Path) -> anyhow::Result<Vec<(f64, Option<bool>)>> {
    let file = path.display();
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).with_context(|| file.to_string())?;
    let header = reader.headers().with_context(|| file.to_string())?.clone();
    let column = |name: &str| header.iter().position(|field| field == name);
    let distance = column("dist").with_context(|| format!("{file}: no column dist"))?;
    let inside = column("inside");
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.with_context(|| file.to_string())?;
        let field = record.get(distance).unwrap_or_default();
        let side = inside.and_then(|inside| record.get(inside)).filter(|side| !side.is_empty());
        let distance = field.parse().with_context(|| format!("{file}: dist is \"{field}\", not a number"))?;
        rows.push((distance, side.map(|side| side == "1")));
    }
    Ok(rows)
}
