//! `palpate bake`: writes a model's tables as Rust source, or as a file.

use super::check::{self, Loaded};
use super::output::{print, write_whole};
use super::progress;
use super::soft;
use super::table_report;
use crate::cache::Evidence;
use crate::models::is_baked;
use anyhow::{Context as _, ensure};
use clap::Args;
use glam::DVec3;
use palpate::body::{Body, TickLimit, TickWork};
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate_bake::body::{BakedBody, BodyBytes};
use palpate_bake::file::FileFault;
use palpate_bake::graph;
use palpate_bake::source::{self, Origin};
use palpate_bake::survey::Verdict;
use palpate_sim::plant::middle;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Maximum reach of a locator beyond the bounding box, in sizes.
pub(super) const MAX_MARGIN: f64 = 30.0;

/// Writes a model's tables as Rust source to `include!`, or as a binary file.
///
/// Several patches become `pub static BODY: palpate::body::Body` and `pub const TABLE_CRC: u32`. A single patch becomes
/// `pub static PATCHES: [palpate::patch::SplinePatch; 1]`, without features and locator. The same model gives the same
/// bytes anywhere, on any number of cores.
///
/// A name that ends in .palp gives a binary body file, for palpate::body::Body::from_bytes and every command that takes
/// a model; box.h gives the same as an array of C, box_palp, with BOX_FACES and BOX_EDGES for its buffer and BOX_TOP, a
/// point of its top, away from rims, m.
///
/// --soft: the body deforms. Of a closed body of one elastic material (youngs_modulus_pa, poissons_ratio, density_kg_per_m3,
/// damping_ratio) the modes of lowest frequency that a quadratic displacement of space holds go to a modes file, beside
/// --out or in the current directory: NAME.modes.toml, as closest --modes and sim --modes read it. Rust source gets them
/// too: MODES and MOTION. A file with modes of your own instead of a material is checked.
///
/// Exit status: 0 for a usable body; 1 with --require-certified if it is not certified (the file is written); 2 for bad
/// input (it is not).
#[derive(Args, Debug)]
#[command(group(clap::ArgGroup::new("product").required(true).multiple(true)))]
pub struct Arguments {
    /// Model: a file, or the name of a shipped one.
    model: PathBuf,
    /// Output: Rust source (.rs), a C header (.h), or binary (.palp).
    #[arg(long, value_name = "FILE", group = "product")]
    out: Option<PathBuf>,
    /// Feature graph (Graphviz .dot).
    #[arg(long, value_name = "FILE.dot", group = "product")]
    graph: Option<PathBuf>,
    /// Reach of the locator beyond the bounding box, in body sizes; 0: chosen by the tool. Beyond it a probe uses the
    /// nearest cell's list, without proof.
    #[arg(long, value_name = "SIZES", default_value_t = 0.0, value_parser = sizes)]
    margin: f64,
    /// Table of flash bytes by kind, the size of a body file and its RAM, the proved fraction of the locator, the cost
    /// of a cold start, and the proved worst case of a tick.
    #[arg(long)]
    table_report: bool,
    /// Maximum evaluations in one tick; a model above it is refused. The default is the limit of the bench boards.
    #[arg(long, value_name = "EVALUATIONS", default_value_t = TickLimit::BENCH.evaluations)]
    tick_limit: u32,
    /// Maximum modelled cycles of one tick; a model above it is refused, at the lowest effort too. The default is three
    /// quarters of the period of the slowest bench board at 4 kHz.
    #[arg(long, value_name = "CYCLES", default_value_t = TickLimit::BENCH.cycles)]
    tick_cycles: u32,
    /// Material of a body that deforms, or modes of your own.
    #[arg(long, value_name = "MATERIAL.toml", group = "product")]
    soft: Option<PathBuf>,
    /// Number of modes, 1 to 8.
    #[arg(long, value_name = "M", default_value_t = 4, requires = "soft")]
    modes: usize,
    /// Faces that do not move; default: the body is free.
    #[arg(long, value_name = "FACE", num_args = 1.., requires = "soft")]
    held: Vec<String>,
    /// Exit status 1 if the body is usable but not certified.
    #[arg(long)]
    require_certified: bool,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if let Some(out) = &arguments.out {
        ensure!(
            is_baked(out) || is_header(out) || has_ending(out, "rs"),
            "{}: its ending says what to write: .rs for Rust source, .h for a C header, .palp for a body file",
            out.display()
        );
    }
    let mut loaded = Loaded::read(&arguments.model)?;
    let labels = loaded.body.labels(&loaded.model);
    let is_body = loaded.body.faces.len() > 1;
    // Source of a single patch is no body.
    let is_patch = !is_body && arguments.out.as_ref().is_some_and(|out| has_ending(out, "rs"));
    let (mut report, mut evidence) = (None, None);
    // The automaton has no locator in it.
    if loaded.file.baked().is_some() {
        ensure!(
            arguments.margin == 0.0,
            "{}: --margin has no effect: the file already contains a locator",
            loaded.file.label
        );
    } else if needs_locator(arguments, is_body) {
        let options = loaded.body.locator_options().reaching(arguments.margin);
        let bar = progress::work();
        let progress = |done, all| bar.tell("cells of space", done, all);
        if arguments.table_report {
            let (body, of_locator) = loaded.body.located(&options, &progress)?;
            evidence = Some(Evidence::of(&of_locator));
            (loaded.body, report) = (body, Some(of_locator));
        } else {
            (loaded.body, evidence) = loaded.file.located_with_evidence(loaded.body, &options, None, &progress)?;
        }
    }
    let limit = TickLimit { evaluations: arguments.tick_limit, cycles: arguments.tick_cycles };
    let soft = arguments.soft.as_ref().map(|file| soft::modes(&loaded, file, arguments.modes, &arguments.held, limit));
    let soft = soft.transpose()?;
    let tables = loaded.body.to_body().with_context(|| loaded.file.label.clone())?.fitted(limit);
    check_tick(&loaded.file.label, &tables, limit)?;
    if let Some(out) = arguments.out.as_ref().filter(|out| is_baked(out)) {
        write_whole(out, &file(&loaded)?)?;
    } else if let Some(out) = arguments.out.as_ref().filter(|out| is_header(out)) {
        write_whole(out, array(&file(&loaded)?, &loaded.body, out)?.as_bytes())?;
    } else if let Some(out) = &arguments.out {
        let origin = Origin {
            model_file: &loaded.file.name,
            out_file: &file_name(out)?,
            model: loaded.file.bytes(),
            centre: loaded.model.centre,
            limit,
        };
        let mut text = source::source(&origin, &loaded.model, &loaded.body)?;
        if let Some(soft) = &soft {
            text += &source::modes_source(&soft.modes)?;
        }
        write_whole(out, text.as_bytes())?;
    }
    if let Some(soft) = &soft {
        let path = soft::path(arguments.out.as_deref(), &arguments.model);
        write_whole(&path, soft.file.as_bytes())?;
        print(soft.report.as_bytes())?;
        print(format!("{}\n", path.display()).as_bytes())?;
    }
    if let Some(file) = &arguments.graph {
        write_whole(file, graph::graph(&loaded.body, &loaded.model.name, &labels).as_bytes())?;
    }
    if arguments.table_report {
        let text = match &report {
            Some(report) => table_report::of_body(&loaded.body, report)?,
            None if is_body => String::new(),
            None => table_report::of_patches(&loaded.surveys())?,
        };
        let tick = if is_patch { table_report::of_patch_tick()? } else { table_report::of_tick(&tables, limit, true)? };
        let text = text + &tick + &table_report::on_boards(bytes(&loaded))?;
        // A file has a locator even of a single patch.
        let as_file = if is_body { file(&loaded)? } else { file_of(&arguments.model)? };
        print((text + &table_report::as_file(as_file.len(), &loaded.body)?).as_bytes())?;
    }
    let flaws = loaded.flaws();
    for flaw in &flaws {
        eprintln!("{}: {}", arguments.model.display(), loaded.describe(flaw));
    }
    let verdict = loaded.verdict(&flaws);
    let (faces, edges) = (loaded.body.faces.len(), loaded.body.edges.len());
    eprintln!("{}: {faces} faces, {edges} edges, {verdict}", arguments.model.display());
    if verdict == Verdict::Usable {
        eprintln!("{}", check::not_certified(!is_patch));
    }
    if let Some(evidence) = evidence {
        eprintln!("{evidence}");
    }
    Ok(if arguments.require_certified { check::exit_code(verdict) } else { ExitCode::SUCCESS })
}

/// Refuses a body whose worst tick takes more than the limit.
fn check_tick(label: &str, body: &Body<'_>, limit: TickLimit) -> anyhow::Result<()> {
    let worst = body.worst_tick(TickWork::EACH);
    let place = worst.vertex.and_then(|index| body.vertices().get(usize::from(index)));
    let place = place.map_or_else(String::new, |vertex| {
        let [x, y, z] = vertex.point.to_array().map(|metres| 1e3 * metres);
        format!(" near the vertex at ({x:.3}, {y:.3}, {z:.3}) mm from the middle, where {} edges end", vertex.spokes)
    });
    ensure!(
        worst.cost <= limit.evaluations,
        "{label}: a tick may take {} evaluations{place}, the limit is {}; merge faces that meet there, or raise \
         --tick-limit if the board is fast enough",
        worst.cost,
        limit.evaluations
    );
    let cycles = body.worst_cycles();
    ensure!(
        cycles <= limit.cycles,
        "{label}: a tick may take {cycles} modelled cycles at the lowest effort{place}, the limit is {}; lower the \
         degree of its patches, or raise --tick-cycles if the board is faster or its rate lower",
        limit.cycles
    );
    Ok(())
}

/// Whether the product contains the locator: the source of a single patch has none.
fn needs_locator(arguments: &Arguments, is_body: bool) -> bool {
    let in_file = arguments.out.as_ref().is_some_and(|out| is_body || is_baked(out) || is_header(out));
    in_file || arguments.table_report && is_body
}

/// A model's tables, baked for a board.
pub(super) struct Baked {
    /// The Rust source.
    pub source: String,
    /// Bytes of the tables on a 32-bit target.
    pub bytes: u64,
    /// The middle of the surface in the tables' frame, metres.
    pub middle: Vec3,
    /// Where the tables' frame lies in the model's, metres.
    pub centre: DVec3,
    /// Flaws of the body, and whether it is not certified: a line each.
    pub remarks: String,
}

/// Bakes a model as [`run`] does with its defaults.
///
/// # Errors
/// The reason why it is refused.
pub(super) fn baked(path: &Path, out_file: &str) -> anyhow::Result<Baked> {
    let mut loaded = Loaded::read(path)?;
    let is_body = loaded.body.faces.len() > 1;
    if is_body {
        let options = loaded.body.locator_options();
        let bar = progress::work();
        let progress = |done, all| bar.tell("cells of space", done, all);
        loaded.body = loaded.file.located(loaded.body, &options, None, &progress)?;
    }
    let origin = Origin {
        model_file: &loaded.file.name,
        out_file,
        model: loaded.file.bytes(),
        centre: loaded.model.centre,
        limit: TickLimit::BENCH,
    };
    let source = source::source(&origin, &loaded.model, &loaded.body)?;
    let patches = loaded.body.faces.iter().map(|face| face.patch.to_patch()).collect::<Result<Vec<_>, _>>()?;
    let middle = middle(patches.iter());
    let flaws = loaded.flaws();
    let mut remarks: String = flaws.iter().map(|flaw| loaded.describe(flaw) + "\n").collect();
    if loaded.verdict(&flaws) == Verdict::Usable {
        remarks += &check::not_certified(is_body);
        remarks.push('\n');
    }
    Ok(Baked { source, bytes: bytes(&loaded), middle, centre: loaded.model.centre, remarks })
}

/// A model's body as a file, as [`run`] writes it with its defaults.
///
/// # Errors
/// The reason why the model is refused.
pub(super) fn file_of(path: &Path) -> anyhow::Result<Vec<u8>> {
    Ok(file(&located(path)?)?)
}

/// A model's body as a C header part.h, as [`run`] writes it with its defaults.
///
/// # Errors
/// The reason why the model is refused.
pub(super) fn part_header(path: &Path) -> anyhow::Result<String> {
    let loaded = located(path)?;
    array(&file(&loaded)?, &loaded.body, Path::new("part.h"))
}

/// A model with the default locator.
fn located(path: &Path) -> anyhow::Result<Loaded> {
    let mut loaded = Loaded::read(path)?;
    let options = loaded.body.locator_options();
    let bar = progress::work();
    let progress = |done, all| bar.tell("cells of space", done, all);
    loaded.body = loaded.file.located(loaded.body, &options, None, &progress)?;
    Ok(loaded)
}

/// A body's file as an array of C, named after the header.
fn array(file: &[u8], body: &BakedBody, header: &Path) -> anyhow::Result<String> {
    let name = c_name(header);
    let capitals = name.to_uppercase();
    let [x, y, z] = top(body)?.to_array();
    let mut text = format!(
        "// A body's file as `palpate bake` wrote it.\n#pragma once\n#include <stdint.h>\n\n\
         #define {capitals}_FACES {}\n#define {capitals}_EDGES {}\n\
         #define {capitals}_TOP {{{x:.6}f, {y:.6}f, {z:.6}f}} // of its top, away from rims, m\n\n\
         static const uint8_t {name}_palp[] __attribute__((aligned(4))) = {{\n",
        body.faces.len(),
        body.edges.len()
    );
    for row in file.chunks(20) {
        text.push_str("   ");
        for byte in row {
            let _ = write!(text, " {byte},");
        }
        text.push('\n');
    }
    text.push_str("};\n");
    Ok(text)
}

/// A file's name as a lower-case identifier of C.
fn c_name(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy().to_lowercase();
    let name: String = stem.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' }).collect();
    if name.starts_with(|first: char| first.is_ascii_alphabetic()) { name } else { format!("part_{name}") }
}

/// Cells of a body seen from above, along its longer side.
const CELLS: i32 = 65;

/// The point of the highest hundredth of a body that lies farthest from where the surface falls away, seen from above;
/// of about as far ones the nearest to the middle, m.
fn top(body: &BakedBody) -> anyhow::Result<Vec3> {
    let patches = body.faces.iter().map(|face| face.patch.to_patch()).collect::<Result<Vec<_>, _>>()?;
    let grid = |patch: &SplinePatch<'static>, steps: u16| {
        let (patch, share) = (*patch, move |step| f32::from(step) / f32::from(steps));
        (0..=steps).flat_map(move |i| (0..=steps).map(move |j| patch.evaluate(share(i), share(j)).point))
    };
    let bounds = |points: &mut dyn Iterator<Item = Vec3>| {
        points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)))
    };
    let (low, high) = bounds(&mut patches.iter().flat_map(|patch| grid(patch, 32)));
    let (middle, floor, size) = (0.5 * (low + high), high.z - 0.01 * (high.z - low.z), high - low);
    let (aside, cell) = (|point: Vec3| (point - middle).truncate().length_squared(), size.x.max(size.y) / CELLS as f32);
    // The highest point in each cell; on a level face the one nearest to the cell's middle.
    let mut seen = BTreeMap::new();
    for patch in &patches {
        let (low, high) = bounds(&mut grid(patch, 32));
        // Some points in each of its cells, and those of the bounds.
        let finer = (((high - low).truncate().max_element() / (8.0 * cell)).ceil() as u16).clamp(1, CELLS as u16 / 8);
        for point in grid(patch, 32 * finer) {
            let place = (point - middle).truncate() / cell;
            let [i, j] = place.round().to_array().map(|index| index as i32);
            let rank = point.z - 1e-3 * cell * place.distance_squared(place.round());
            let held = seen.entry((i, j)).or_insert((rank, point));
            if rank > held.0 {
                *held = (rank, point);
            }
        }
    }
    // The outermost cells are beside the body.
    let half = CELLS / 2 + 2;
    let every = || (-half..=half).flat_map(|i| (-half..=half).map(move |j| (i, j)));
    let top_at = |cell: (i32, i32)| seen.get(&cell).map(|(_, point)| *point).filter(|point: &Vec3| point.z >= floor);
    let fallen: Vec<_> = every().filter(|cell| top_at(*cell).is_none()).collect();
    let from_rim = |(i, j): (i32, i32)| fallen.iter().map(|(k, l)| (i - k).pow(2) + (j - l).pow(2)).min().unwrap_or(0);
    let tops: Vec<_> = every().filter_map(|cell| Some((from_rim(cell), top_at(cell)?))).collect();
    let farthest = tops.iter().map(|(distance, _)| *distance).max().unwrap_or_default();
    let far = tops.iter().filter(|(distance, _)| f64::from(*distance).sqrt() >= 0.9 * f64::from(farthest).sqrt());
    let nearest = far.min_by(|(_, a), (_, b)| aside(*a).total_cmp(&aside(*b)));
    nearest.map(|(_, point)| *point).context("a body without a finite point")
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(ending))
}

/// Whether a C header is to be written.
fn is_header(path: &Path) -> bool {
    has_ending(path, "h")
}

/// A loaded model's body as a file.
fn file(loaded: &Loaded) -> Result<Vec<u8>, FileFault> {
    palpate_bake::file::write(loaded.file.digest(), &loaded.model, &loaded.body)
}

/// Bytes of a loaded model's tables on a 32-bit target.
pub(super) fn bytes(loaded: &Loaded) -> u64 {
    let bytes = if loaded.body.faces.len() > 1 {
        BodyBytes::of(&loaded.body).total()
    } else {
        loaded.surveys().iter().map(|survey| survey.bytes.total()).sum()
    };
    bytes as u64
}

fn sizes(text: &str) -> Result<f64, String> {
    let sizes = text.parse().ok().filter(|sizes| (0.0..=MAX_MARGIN).contains(sizes));
    sizes.ok_or_else(|| format!("not a number from 0 to {MAX_MARGIN}"))
}

fn file_name(path: &Path) -> anyhow::Result<String> {
    let name = path.file_name().with_context(|| format!("{}: not the name of a file", path.display()))?;
    Ok(name.to_string_lossy().into_owned())
}
