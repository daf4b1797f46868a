//! `palpate demo`: the firmware image on the emulated board, in closed loop with the simulated device.

use super::options::{Scene, SceneOptions};
use super::{demo_knob, page, progress, rate, sim};
use crate::budgets::Budget;
use crate::devices::Chosen;
use crate::firmware::{self, Board, Choice, Firmware, Program, Progress, SetUpError, Transport};
use crate::report::{self, Report, Summary};
use crate::simulation::{self, Trace};
use anyhow::{Context, bail, ensure};
use clap::{Args, ValueEnum};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs the firmware image on an emulated board in closed loop with the simulated device, and writes a report.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Emulated board
    #[arg(long, value_enum, default_value_t)]
    board: Board,
    /// Transport of the frames: fifo (fast), uart (the board's real link)
    #[arg(long, value_enum, default_value_t = if cfg!(unix) { Carrier::Fifo } else { Carrier::Uart })]
    transport: Carrier,
    /// Run the loop compiled for the host, without the emulator
    #[arg(long)]
    host: bool,
    /// Report file
    #[arg(long, default_value = "palpate-report/demo.html")]
    report: PathBuf,
    /// View of the probe's path (SVG)
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Carrier {
    Fifo,
    Uart,
}

/// A run and what was run.
struct Run {
    trace: Trace,
    /// On what.
    on: String,
    /// The instructions to compare with, and the sizes of the image, where there is one.
    sizes: Vec<(&'static str, String)>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if let Chosen::Knob = arguments.scene.device {
        ensure!(arguments.scene.tool.is_none(), "--tool touches a body, and the knob touches none");
        return demo_knob::run(arguments.board, arguments.host, &arguments.report, arguments.picture.as_deref());
    }
    let mut scene = arguments.scene.scene()?;
    let run = if arguments.host {
        on_host(arguments, &scene)?
    } else {
        rate::in_time(&arguments.scene, &mut scene, |scene| on_board(arguments, scene), |run| &run.trace)?
    };
    let mut figures = scene.walls();
    let summary = Summary::new(&run.trace);
    figures.extend(summary.rows());
    let too_expensive = rate::too_expensive(&scene, &summary);
    figures.extend(too_expensive.clone().map(|verdict| ("verdict", verdict)));
    figures.extend(scene.withheld(&run.trace));
    figures.extend(run.sizes);
    // What the page has no device or body for is in the report alone.
    let recorded = scene.recording(&run.trace, &run.on);
    let recording = arguments.report.with_extension("json");
    let mut replay = None;
    if let Ok(recorded) = &recorded {
        figures.push(("replay in 3-D", format!("cargo palpate view --recording {}", recording.display())));
        let folder = folder_of(&arguments.report);
        fs::create_dir_all(folder).with_context(|| format!("cannot make the folder {}", folder.display()))?;
        sim::write_recording(recorded, &recording)?;
        let beside = arguments.report.with_extension("replay.html");
        replay = page::write_replay(recorded, &beside)?.then_some(beside);
    }
    let replay = replay.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy());
    let subtitle = format!("{} of {}, {}", scene.felt.name(), scene.model_name(), run.on);
    let net = scene.felt.net(scene.settings.rate_hz);
    let sections = report::sections(&run.trace, &net, |code| scene.felt.feature_name(code));
    let link = replay.as_ref().map(|file| [file.as_ref(), "The same run in 3-D, replayed by the firmware's code"]);
    Report { headline: ["palpate demo", &subtitle], link, figures: &figures, sections: &sections }
        .write(&arguments.report)?;
    if let Some(picture) = &arguments.picture {
        fs::write(picture, report::path(&run.trace, &net))
            .with_context(|| format!("cannot write {}", picture.display()))?;
    }
    println!("palpate demo: {subtitle}");
    for (name, value) in &figures {
        println!("  {name:<20} {value}");
    }
    println!("  {:<20} {}", "report", arguments.report.display());
    Ok(if too_expensive.is_some() { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// On the emulated board, or on the host where no emulator can be had.
fn on_board(arguments: &Arguments, scene: &Scene) -> anyhow::Result<Run> {
    let progress = Progress::new();
    match prepare(arguments.board, scene, &progress) {
        Ok(firmware) => run_firmware(arguments, scene, &firmware),
        Err(Preparation::SetUp(error @ (SetUpError::NoEmulator(_) | SetUpError::NoToolchain(_)))) => {
            eprintln!("{error}");
            eprintln!("running the same loop compiled for the host instead; nothing is counted there");
            on_host(arguments, scene)
        }
        Err(Preparation::SetUp(error @ SetUpError::NoRepository(_))) => {
            bail!("{error}; or use --host, the same loop compiled for the host")
        }
        Err(Preparation::SetUp(error)) => Err(error.into()),
        Err(Preparation::Tables(error)) => Err(error),
    }
}

/// Failures before the image runs.
#[derive(Debug)]
pub enum Preparation {
    /// No emulator, no compiler, or a build that failed.
    SetUp(SetUpError),
    /// The scene's tables cannot be written.
    Tables(anyhow::Error),
}

/// Bakes the scene into the image of one transport.
///
/// # Errors
/// The missing tool, or the failure.
pub fn program(board: Board, scene: &Scene, transport: Transport, progress: &Progress) -> Result<Program, Preparation> {
    let (_folder, choice) = write_tables(board, scene).map_err(Preparation::Tables)?;
    Program::prepare_with(&choice, transport.binary(), &[], progress).map_err(Preparation::SetUp)
}

/// Bakes the scene into the images of both.
fn prepare(board: Board, scene: &Scene, progress: &Progress) -> Result<Firmware, Preparation> {
    let (_folder, choice) = write_tables(board, scene).map_err(Preparation::Tables)?;
    firmware::prepare(&choice, progress).map_err(Preparation::SetUp)
}

/// The scene's tables and settings as Rust source, in a folder that goes when dropped, and the choice of them.
pub(super) fn write_tables(board: Board, scene: &Scene) -> anyhow::Result<(tempfile::TempDir, Choice)> {
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    fs::write(folder.path().join("body.rs"), scene.source()?)?;
    fs::write(folder.path().join("settings.rs"), scene.settings_source())?;
    let [body, settings] = ["body.rs", "settings.rs"].map(|name| Some(folder.path().join(name)));
    let choice = Choice {
        board,
        body,
        settings,
        protected: scene.protection.is_some(),
        wrist: scene.tool.is_some(),
        ..Choice::default()
    };
    Ok((folder, choice))
}

fn run_firmware(arguments: &Arguments, scene: &Scene, firmware: &Firmware) -> anyhow::Result<Run> {
    let transport = match arguments.transport {
        Carrier::Fifo => Transport::Fifo,
        Carrier::Uart => Transport::Uart,
    };
    let mut plant = arguments.scene.plant(scene)?;
    let mut emulator = firmware.start(transport)?;
    let bar = progress::ticks(scene.ticks);
    let mut trace = simulation::run(&mut emulator, &mut plant, scene.span(), |done| bar.tell(done))?;
    drop(bar);
    trace.count_contacts_lost(scene.host_loop()?.as_mut(), scene.tool)?;
    // As a device would carry it: files of the host are the emulator's.
    let image = firmware.images.of(Transport::Uart);
    let mut sizes = vec![("flash", format!("{} bytes", image.flash)), ("RAM, static", format!("{} bytes", image.ram))];
    if let Some(budget) = Budget::load(arguments.board).ok()
        && let (Some(median), Some(worst)) = (budget.of("servo tick, median"), budget.of("servo tick, worst"))
    {
        sizes.insert(0, ("of the capped box", format!("{median} median, {worst} at most, by the board's budget")));
    }
    let (core, machine) = (arguments.board.core(), arguments.board.machine());
    let on = format!("firmware on an emulated {core} ({machine}) over {}", transport.binary());
    Ok(Run { trace, on, sizes })
}

fn on_host(arguments: &Arguments, scene: &Scene) -> anyhow::Result<Run> {
    let trace = sim::run_on_host(&arguments.scene, scene)?;
    Ok(Run { trace, on: sim::ON_HOST.to_owned(), sizes: Vec::new() })
}
