//! `palpate feel`: what a hand feels of the loop on a device, against what people can feel.

use super::felt::Felt;
use super::smoothing::Smoothing;
use super::{feel_clean, options};
use crate::devices::{self, Arms, ShippedDevice};
use crate::feel::table::Worst;
use crate::feel::{Crossed, ENCODERS, RATES, Row, Wish, plot, rows, table};
use crate::models::ModelFile;
use crate::plot::at_widths;
use crate::report::{Report, Section};
use anyhow::{Context, bail, ensure};
use clap::Args;
use palpate::servo::recommended::Recommended;
use palpate_sim::feel::{BANDS, Threshold, recorded};
use palpate_sim::zwidth::Slice;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Measures what a hand feels: steps of force, ripple against human thresholds, drag.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Device: a name, your own file (my.toml), or `all`
    #[arg(long, default_value = "all", value_parser = devices::arms_parser())]
    device: Arms,
    /// Body whose edges are crossed (three joints): a model file, or the name of a shipped model; default: capped_box
    #[arg(long)]
    model: Option<PathBuf>,
    /// Modes file of a body that deforms, as `palpate bake` writes it
    #[arg(long, value_name = "MODES.toml", conflicts_with_all = ["clean", "recording"])]
    modes: Option<PathBuf>,
    /// Servo rate, Hz
    #[arg(long, default_value_t = 4_000.0)]
    rate: f32,
    /// Stiffness of the surface, N/m; `--device all`: at most each one's maximum; default: recommended for the device
    #[arg(long)]
    stiffness: Option<f32>,
    /// Damping of the surface, N·s/m; `--device all`: at most each one's maximum; default: recommended for the device
    #[arg(long)]
    damping: Option<f32>,
    /// Corner frequency of the velocity filter, Hz; default: recommended for the device
    #[arg(long)]
    velocity_corner: Option<f32>,
    /// Smoothing: smooth (hides counts, ticks and edges), eased (all but counts), plain (none); default: recommended
    /// for the device
    #[arg(long, value_enum)]
    rendering: Option<Smoothing>,
    /// Search for the stiffest wall that is clean to slide along, at 1, 2, 4, 8 and 10 kHz, with the device's encoders
    /// and finer ones
    #[arg(long, conflicts_with_all = ["model", "rate", "stiffness", "recording", "velocity_corner"])]
    clean: bool,
    /// Of --clean: other servo rates, Hz, and the device's own encoders alone
    #[arg(long, value_name = "HZ", value_delimiter = ',', requires = "clean")]
    rates: Vec<f32>,
    /// Detection threshold: CSV of frequency, Hz, and peak displacement, m, under a header
    #[arg(long, value_name = "FILE.csv")]
    threshold: Option<PathBuf>,
    /// Recording of every tick to evaluate, from `sim --csv`, of one device and one model
    #[arg(long, value_name = "FILE.csv", conflicts_with_all = ["model", "rate", "stiffness", "damping", "velocity_corner", "rendering", "out"])]
    recording: Option<PathBuf>,
    /// Folder for figures (CSV) and report (HTML); none with --recording
    #[arg(long, default_value = "palpate-report/feel")]
    out: PathBuf,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let threshold = arguments.threshold.as_deref().map_or_else(|| Ok(Threshold::approximate()), read_threshold)?;
    if let Some(path) = &arguments.recording {
        let Arms::One(device) = arguments.device else {
            bail!("--recording needs the device it was made with: add --device NAME, or your file")
        };
        print_recording(path, device, &threshold)?;
        return Ok(ExitCode::SUCCESS);
    }
    check(arguments)?;
    if arguments.clean {
        let (rates, encoders) = if arguments.rates.is_empty() {
            (&RATES[..], &ENCODERS[..])
        } else {
            (&arguments.rates[..], &ENCODERS[..1])
        };
        ensure!(rates.iter().all(|rate| (20.0..=100_000.0).contains(rate)), "--rates are from 20 Hz to 100 kHz");
        let devices = arguments.device.each();
        return feel_clean::run(
            &devices,
            |device| wish(arguments, device),
            &threshold,
            (rates, encoders),
            &arguments.out,
        );
    }
    let model = arguments.model.as_deref().unwrap_or(Path::new("capped_box"));
    let file = ModelFile::read(model)?;
    let felt = Felt::read(&file.model()?, &file, model, None, arguments.modes.as_deref())?;
    let body = match &felt {
        Felt::Body { body, soft, .. } => {
            let soft = soft.as_ref().map(|soft| soft.on(body, arguments.rate)).transpose()?;
            Some(Crossed { body, soft, origin: -felt.middle() })
        }
        Felt::Patch { .. } | Felt::Scene(_) => {
            println!("{}: one patch, which has no edge to cross", file.label);
            None
        }
    };
    let mut all: Vec<(&str, Vec<Row>)> = Vec::new();
    for device in arguments.device.each() {
        let wish = wish(arguments, device);
        let settings = wish.settings(device);
        println!(
            "{}: {} N/m{}, {} N·s/m{}, {} kHz; steps and ripple in mN",
            device.name,
            settings.stiffness_n_per_m,
            its_maximum(settings.stiffness_n_per_m, wish.stiffness),
            settings.damping_n_s_per_m,
            its_maximum(settings.damping_n_s_per_m, wish.damping),
            settings.rate_hz / 1_000.0
        );
        let rows = rows(device, body, &wish, &threshold)?;
        println!("{}{}", table::text(&rows), table::contacts_lost(&rows));
        all.push((device.name, rows));
    }
    println!("{}", Worst::heading());
    all.iter().for_each(|(name, rows)| println!("{}", Worst::of(rows).line(name)));
    write(&all, &threshold, arguments)
}

/// Refuses options that would not act: beyond the limits of a single device, or for another number of joints.
fn check(arguments: &Arguments) -> anyhow::Result<()> {
    for device in arguments.device.each() {
        let wished = wish(arguments, device).wished(device);
        match arguments.device {
            Arms::One(_) => options::check(&wished, device)?,
            Arms::All => wished.check(f32::MAX, f32::MAX)?,
        }
    }
    if let Arms::One(device) = arguments.device {
        let (name, joints) = (device.name, device.preset.feeds().len());
        ensure!(
            joints == 3 || (arguments.model.is_none() && arguments.modes.is_none()),
            "--model and --modes need three joints; {name} has {joints}: leave them out"
        );
        ensure!(joints > 1 || !arguments.clean, "--clean needs two joints; {name} has one, and nothing slides");
    }
    Ok(())
}

/// Marks a setting that a device of `all` limits.
fn its_maximum(set: f32, wished: f32) -> &'static str {
    if set < wished { " (its maximum)" } else { "" }
}

/// The settings recommended for a device, with the options that were given.
fn wish(arguments: &Arguments, device: &ShippedDevice) -> Wish {
    let Recommended { settings, rendering } = device.recommended();
    Wish {
        rate: arguments.rate,
        stiffness: arguments.stiffness.unwrap_or(settings.stiffness_n_per_m),
        damping: arguments.damping.unwrap_or(settings.damping_n_s_per_m),
        corner: arguments.velocity_corner.unwrap_or(settings.velocity_corner_hz),
        rendering: arguments.rendering.map_or(rendering, Smoothing::rendering),
    }
}

/// A table of frequency, Hz, and displacement, m.
fn read_threshold(path: &Path) -> anyhow::Result<Threshold> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    let points = reader.deserialize::<[f64; 2]>().collect::<Result<Vec<_>, _>>();
    let points = points.with_context(|| format!("{}: not rows of two numbers", path.display()))?;
    Threshold::try_new(points).with_context(|| path.display().to_string())
}

fn print_recording(path: &Path, device: &ShippedDevice, threshold: &Threshold) -> anyhow::Result<()> {
    let recording = recorded::read(path)?;
    if let Some(made) = recording.device.as_deref().filter(|made| *made != device.name) {
        bail!("{}: recorded with {made}, not with {}: add --device {made}", path.display(), device.name);
    }
    if recording.device.is_none() {
        println!("{}: it does not name its device; {} is assumed", path.display(), device.name);
    }
    let figures = recorded::figures(&recording, Slice::of(device).mass, threshold);
    let milli = |force: f64| format!("{:.1} mN", force * 1e3);
    let seconds = recording.ticks.len() as f64 / recording.rate;
    println!("{}: {} ticks, {seconds:.3} s at {:.0} Hz", path.display(), recording.ticks.len(), recording.rate);
    if let Some(model) = &recording.model {
        println!("  {:<34} {model}", "model");
    }
    println!("  {:<34} {}", "touches", figures.touches);
    println!("  {:<34} {}", "largest step at contact", milli(figures.steps.contact));
    println!("  {:<34} {}", "largest step at release", milli(figures.steps.release));
    println!("  {:<34} {}", "largest step", milli(figures.steps.any));
    println!("  {:<34} {}", "ripple in the longest touch", milli(figures.ripple));
    for (band, peak) in BANDS.iter().zip(figures.bands) {
        println!("  {:<34} {}", format!("of it {}", band.name), milli(peak));
    }
    println!(
        "  {:<34} {:.1} dB at {:.0} Hz",
        "above the threshold", figures.sensation.level, figures.sensation.frequency
    );
    println!("  {:<34} {:.1} ms", "force without touch", figures.afterglow * 1e3);
    Ok(())
}

fn write(all: &[(&str, Vec<Row>)], threshold: &Threshold, arguments: &Arguments) -> anyhow::Result<ExitCode> {
    ensure!(!all.is_empty(), "no device");
    let out = &arguments.out;
    std::fs::create_dir_all(out).with_context(|| format!("cannot make {}", out.display()))?;
    let csv = out.join("feel.csv");
    table::write_csv(all, &csv).with_context(|| format!("cannot write {}", csv.display()))?;
    let worst = all.iter().map(|(name, rows)| (*name, Worst::of(rows)));
    let mut sections = vec![Section {
        heading: "The worst of each device".to_owned(),
        note: "Steps of force at contact, at release and off an edge; what is felt of a rest and a slide, against the \
               threshold of perception; force in front of the wall; drag in air."
            .to_owned(),
        table: Some(Worst::table(worst)),
        drawing: None,
    }];
    for (name, rows) in all {
        sections.push(Section {
            heading: (*name).to_owned(),
            note: format!(
                "Steps and ripple in mN. Below: how far the probe moves under a hand that rests or slides, and what \
                 people feel (approximated). {}",
                table::contacts_lost(rows)
            )
            .trim_end()
            .to_owned(),
            table: Some(table::table(rows)),
            drawing: Some(at_widths(460.0, |svg, area| plot::spectra(svg, area, rows, threshold))),
        });
    }
    let subtitle = format!("The loop under a hand, at {} Hz.", arguments.rate);
    let report = out.join("report.html");
    let content =
        Report { headline: ["Feel of each device", &subtitle], link: None, figures: &[], sections: &sections };
    content.write(&report)?;
    println!("figures: {}\nreport: {}", csv.display(), report.display());
    Ok(ExitCode::SUCCESS)
}
