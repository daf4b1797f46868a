//! `palpate sim`: the servo loop, compiled for the host, against the simulated device.

use super::options::{Scene, SceneOptions};
use super::output::write_whole;
use super::progress;
use crate::page::Recording;
use crate::report::Summary;
use crate::simulation::{self, Trace};
use anyhow::Context;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs the servo loop, compiled for the host, against the simulated device.
#[derive(Args, Debug)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneOptions,
    /// Record of every tick (CSV): SI units, the model file's frame, duty -1 to 1; contact 0 behind, 1 in front, 2 touching;
    /// phase 0 reset, 1 calibrate, 2 armed, 3 running, 4 fault; withheld 1 until the polarity check has confirmed each joint
    #[arg(long, value_name = "OUT")]
    csv: Option<PathBuf>,
    /// Recording for the page in the browser (`view --recording`)
    #[arg(long, value_name = "FILE.json")]
    recording: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let scene = arguments.scene.scene()?;
    if arguments.recording.is_some() {
        scene.check_recordable()?;
    }
    let trace = run_on_host(&arguments.scene, &scene)?;
    scene.walls().iter().for_each(|(name, value)| println!("  {name:<20} {value}"));
    print!("{}", Summary::new(&trace));
    scene.withheld(&trace).iter().for_each(|(name, value)| println!("  {name:<20} {value}"));
    if let Some(path) = &arguments.csv {
        write_csv(&trace, &scene, path).with_context(|| format!("cannot write {}", path.display()))?;
        println!("  {:<20} {}", "recorded to", path.display());
    }
    if let Some(path) = &arguments.recording {
        write_recording(&scene.recording(&trace, ON_HOST)?, path)?;
        println!("  {:<20} {}", "recorded to", path.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// Where a loop runs that is not in an image.
pub(super) const ON_HOST: &str = "the loop compiled for the host";

/// Writes a recording, whole or not at all.
pub(super) fn write_recording(recording: &Recording, path: &Path) -> anyhow::Result<()> {
    write_whole(path, &serde_json::to_vec(recording)?)
}

/// Runs a scene's loop, compiled for the host.
///
/// # Errors
/// A refusal of the settings or the plant.
pub fn run_on_host(options: &SceneOptions, scene: &Scene) -> anyhow::Result<Trace> {
    let mut plant = options.plant(scene)?;
    let mut servo = scene.host_loop()?;
    let bar = progress::ticks(scene.ticks);
    Ok(simulation::run(servo.as_mut(), &mut plant, scene.span(), |done| bar.tell(done))?)
}

/// One row a tick; SI units, the probe in the model's own frame; then the names of device and model,
/// and whether the polarity check withholds force.
fn write_csv(trace: &Trace, scene: &Scene, path: &Path) -> anyhow::Result<()> {
    let mut writer = csv::Writer::from_path(path)?;
    writer.write_record([
        "time", "count_a", "count_b", "count_c", "duty_a", "duty_b", "duty_c", "phase", "fault", "mode", "contact",
        "u", "v", "probe_x", "probe_y", "probe_z", "gap", "force_x", "force_y", "force_z", "device", "model",
        "withheld",
    ])?;
    let until = scene.withheld_until(trace).unwrap_or(0.0);
    for sample in &trace.samples {
        let report = &sample.report;
        let mut row = vec![sample.time.to_string()];
        row.extend(sample.sensors.counts.map(|count| count.to_string()));
        row.extend(report.duties.map(|duty| duty.to_string()));
        row.extend([report.phase, report.fault, report.mode, report.contact].map(|number| number.to_string()));
        row.extend(report.parameters.map(|parameter| parameter.to_string()));
        row.extend([0, 1, 2].map(|axis| placed(report.probe[axis], scene.centre[axis])));
        row.push(report.gap.to_string());
        row.extend(report.force.map(|component| component.to_string()));
        row.extend([scene.device.name, scene.model_name()].map(str::to_owned));
        row.push(u8::from(sample.time < until).to_string());
        writer.write_record(row)?;
    }
    writer.flush()?;
    Ok(())
}

/// A coordinate of the tables' frame in the model's; where they are one, with the digits of `f32`.
fn placed(coordinate: f32, centre: f64) -> String {
    if centre == 0.0 { coordinate.to_string() } else { format!("{:.9}", f64::from(coordinate) + centre) }
}
