//! `palpate pair`: closest pairs of a body and a tool with the firmware's own code.

use super::closest::{Mode, significant};
use super::output::{print, write_whole};
use super::progress;
use crate::models::ModelFile;
use crate::queries;
use anyhow::{Context as _, ensure};
use clap::Args;
use glam::{DMat3, DQuat, DVec3};
use palpate::body::Body;
use palpate::pair::{Closest, Core, DEFAULT_CELLS, Tool, ToolWitness};
use palpate::track::Placement;
use palpate_bake::{BakedBody, Model};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Closest pairs of a body and a tool by the firmware's own single-precision code.
///
/// A tool is a convex core and a radius. Reads the pose of the tool's frame in the body's from the columns qw,qx,qy,qz
/// (a unit quaternion) and px,py,pz (others and lines starting with # are ignored). All lengths, read, written and on
/// the command line, are in the unit of --model. Writes a row per pose, in the same sequence:
/// distance,bx,by,bz,tx,ty,tz,steps,status. distance is that of body and core less the radius; bx,by,bz is the point on
/// the body, tx,ty,tz the point of the core in the tool's frame; steps counts patch evaluations.
///
/// cold: every row by itself. status: converged; inside if body and core intersect: between smooth convex bodies
/// distance is then minus the depth, otherwise the depth is at least minus distance; behind if the
/// points rest on the far side of a convex body; step-limit if a search was stopped short.
///
/// track: rows are successive servo ticks of one tool. The first row is cold; each other row is --ticks ticks, and a
/// cold one after a jump above 3 % of the body's size or where the tracker reports behind. status: tracking, or as
/// above.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Model of the body: a file, or the name of a shipped one.
    #[arg(long)]
    model: PathBuf,
    /// Core of the tool: point, segment:H along z, box:X,Y,Z (half lengths), or a model of a convex body.
    #[arg(long, value_name = "TOOL")]
    tool: String,
    /// Radius of the ball around the core.
    #[arg(long, value_name = "R", default_value_t = 0.0, allow_hyphen_values = true)]
    radius: f64,
    /// Poses (CSV with the columns qw,qx,qy,qz,px,py,pz).
    #[arg(long, value_name = "IN.csv")]
    poses: PathBuf,
    /// Relation of the rows.
    #[arg(long, value_enum, default_value_t = Mode::Cold)]
    mode: Mode,
    /// Ticks per row, for --mode track.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    ticks: u32,
    /// Cells of the audit per tick on bodies that are not convex, for --mode track.
    #[arg(long, default_value_t = DEFAULT_CELLS)]
    cells: u16,
    /// Output; default: standard output.
    #[arg(long, value_name = "OUT.csv")]
    out: Option<PathBuf>,
}

/// A body's tables with their locator, and the middle of its model's frame.
struct Baked {
    tables: BakedBody,
    centre: DVec3,
    per_metre: f64,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let file = ModelFile::read(&arguments.model)?;
    let model = file.model()?;
    let poses = queries::read_poses(&arguments.poses, &model)?;
    let baked = bake(&file, &model)?;
    let per_metre = baked.per_metre;
    let body = baked.tables.to_body()?;
    let metres = |length: f64| (length / per_metre) as f32;
    let tool_body;
    let (core, centre) = match half_lengths(&arguments.tool)? {
        Some(half) => match half.map(metres) {
            [x, y, z] if arguments.tool.starts_with("box") => (Core::Box { half: [x, y, z] }, DVec3::ZERO),
            [_, _, half] if half > 0.0 => (Core::Segment { half }, DVec3::ZERO),
            _ => (Core::Point, DVec3::ZERO),
        },
        None => {
            let file = ModelFile::read(Path::new(&arguments.tool)).with_context(|| {
                format!("--tool {}: give point, segment:H, box:X,Y,Z, or a convex body's model", arguments.tool)
            })?;
            let baked = bake(&file, &file.model()?)?;
            tool_body = baked.tables.to_body()?;
            (Core::Body(&tool_body), baked.centre)
        }
    };
    let tool = Tool::new(core, metres(arguments.radius))
        .with_context(|| format!("--tool {} --radius {}", arguments.tool, arguments.radius))?;
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["distance", "bx", "by", "bz", "tx", "ty", "tz", "steps", "status"])?;
    let mut state = None;
    for (turn, position) in poses {
        let placement = placement(turn, position + turn * centre - baked.centre);
        let (found, status) = match (arguments.mode, &mut state) {
            (Mode::Track, Some(state)) => track(&body, &tool, state, &placement, arguments),
            (mode, state) => {
                let (start, found) = body.locate_tool(&tool, &placement);
                *state = (mode == Mode::Track).then_some(start);
                (found, found.status.name("converged"))
            }
        };
        let (on_body, on_core) = (found.body.as_dvec3() + baked.centre, found.core.as_dvec3() + centre);
        let lengths = [f64::from(found.distance)].into_iter().chain(on_body.to_array()).chain(on_core.to_array());
        let numbers = lengths.map(|length| significant(length * per_metre));
        writer.write_record(numbers.chain([found.evaluations.to_string(), status.to_owned()]))?;
    }
    let text = writer.into_inner()?;
    match &arguments.out {
        Some(path) => write_whole(path, &text)?,
        None => print(&text)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// One row of a track. Where the tracker asks for it the tool is located again.
fn track(
    body: &Body,
    tool: &Tool,
    state: &mut ToolWitness,
    placement: &Placement,
    arguments: &Arguments,
) -> (Closest, &'static str) {
    let mut found = body.follow_tool(tool, state, placement, arguments.cells);
    for _ in 1..arguments.ticks {
        let next = body.follow_tool(tool, state, placement, arguments.cells);
        found = Closest { evaluations: found.evaluations + next.evaluations, ..next };
    }
    (found, found.status.name("tracking"))
}

/// The tables with their locator.
fn bake(file: &ModelFile, model: &Model) -> anyhow::Result<Baked> {
    let bar = progress::work();
    let progress = |done, all| bar.tell("cells of space", done, all);
    let tables = file.body(model)?;
    let options = tables.locator_options();
    let tables = file.located(tables, &options, None, &progress)?;
    Ok(Baked { tables, centre: model.centre, per_metre: model.unit.per_metre() })
}

/// Half the sides of a core that is named by them; `None` of a model.
fn half_lengths(tool: &str) -> anyhow::Result<Option<[f64; 3]>> {
    let (kind, lengths) = tool.split_once(':').unwrap_or((tool, ""));
    let count = match kind {
        "point" if lengths.is_empty() => return Ok(Some([0.0; 3])),
        "segment" => 1,
        "box" => 3,
        _ => return Ok(None),
    };
    let mut half = [0.0_f64; 3];
    let given: Vec<_> = lengths.split(',').collect();
    let form = if count == 1 { "segment:H" } else { "box:X,Y,Z" };
    ensure!(given.len() == count, "--tool {tool}: give {form}, half lengths in the unit of --model");
    for (slot, text) in half[3 - count..].iter_mut().zip(given) {
        *slot = text.trim().parse().ok().with_context(|| format!("--tool {tool}: \"{text}\" is not a number"))?;
        ensure!(slot.is_finite() && *slot >= 0.0, "--tool {tool}: a half length is {slot}; give 0 or more");
    }
    Ok(Some(half))
}

fn placement(turn: DQuat, origin: DVec3) -> Placement {
    let axes = DMat3::from_quat(turn);
    Placement {
        axes: [axes.x_axis, axes.y_axis, axes.z_axis].map(|axis| axis.as_vec3()),
        origin: origin.as_vec3(),
        ..Placement::IDENTITY
    }
}
