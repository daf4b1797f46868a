//! `palpate zwidth`: the maximum stiffness against damping, for a device, its rates and delays.

mod plot;
mod summary;
mod sweeping;

use plot::plot;
use sweeping::{best, sweep_with_bar};

use super::felt::Felt;
use super::output::write_whole;
use crate::devices::{self, Arms, ShippedDevice};
use anyhow::Context;
use clap::{Args, ValueEnum};
use palpate::device::VelocityMethod;
use palpate::render::Ease;
use palpate_sim::zwidth::{DAMPINGS, DELAYS, Limit, Loop, RATES, Slice, in_words, max_stiffness};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Dampings for which the weakest direction is printed, N·s/m.
const WEAKEST: [f64; 3] = [0.0, 2.0, 8.0];

/// Finds the stiffest and most damped wall of a device: a table, and a plot with the passive bound.
///
/// The table is along z at the middle of the workspace (two joints: y, one: x); the weakest direction of the workspace
/// follows; then, along x, y and z, the maximum with the recommended rendering and the cause without which it would
/// rise most: counts, delay or velocity estimator. The last line is the value for `max_stiffness` in the device file: half of the limit with the rendering
/// recommended for the device, in the weakest direction.
///
/// Simulated: the stiffest wall on which the probe comes to rest. Passive: up to there the wall gives out no energy,
/// (b − B)/(T/2 + d + L/R) and at most 2 f/count, with the device's viscous friction b and dry friction f, the wall's
/// damping B, period T, delay d, and the time constant L/R of a motor's current. The weakest direction is the weakest of 13,
/// to the sides, edges and corners of a cube, at places 30 mm apart and up to 150 mm from the middle along each axis,
/// within reach and where the device does not fade its force out.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Device: a name, your own file (my.toml), or `all`.
    #[arg(long, default_value = "woodenhaptics-2016", value_parser = devices::arms_parser())]
    device: Arms,
    /// Servo rates, Hz; default: 1, 2, 4 and 8 kHz.
    #[arg(long, value_delimiter = ',')]
    rate: Vec<f64>,
    /// Velocity estimator.
    #[arg(long, value_enum, default_value = "low-pass")]
    velocity: Velocity,
    /// Corner frequency of the velocity estimator, Hz.
    #[arg(long, default_value_t = 200.0)]
    corner: f64,
    /// Damping that grows with the push, and a limited change of force, as in the eased and smooth renderings.
    #[arg(long)]
    ease: bool,
    /// Modes of a body that gives way, from `bake --soft`: its limits too, hit from above, beside those of a rigid wall.
    #[arg(long, value_name = "MODES.toml", requires = "model")]
    modes: Option<PathBuf>,
    /// The body of --modes: a file, or the name of a shipped one.
    #[arg(long, requires = "modes")]
    model: Option<PathBuf>,
    /// Plot file (SVG) of one device, without --modes; default: palpate-report/zwidth.svg
    #[arg(long, conflicts_with = "modes")]
    plot: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Velocity {
    LowPass,
    BetweenCounts,
}

impl Velocity {
    fn method(self) -> VelocityMethod {
        match self {
            Self::LowPass => VelocityMethod::LowPass,
            Self::BetweenCounts => VelocityMethod::BetweenCounts,
        }
    }
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let positive = |value: f64| value.is_finite() && value > 0.0;
    anyhow::ensure!(
        arguments.rate.iter().all(|rate| positive(*rate) && *rate <= 100_000.0),
        "the rate must be above 0 and at most 100 kHz"
    );
    anyhow::ensure!(positive(arguments.corner), "the corner must be above 0 Hz");
    let rates = if arguments.rate.is_empty() { RATES.to_vec() } else { arguments.rate.clone() };
    let like = Loop {
        rate: 0.0,
        delay_periods: 0.0,
        velocity: arguments.velocity.method(),
        corner: arguments.corner,
        ease: arguments.ease.then_some(Ease::SMOOTH),
    };
    if let Some((model, modes)) = arguments.model.as_ref().zip(arguments.modes.as_ref()) {
        let soft = Felt::soft_walls(model, modes, &rates)?;
        summary::print(&arguments.device.each(), &rates, like, Some(&soft))?;
        return Ok(ExitCode::SUCCESS);
    }
    let Arms::One(device) = arguments.device else {
        anyhow::ensure!(arguments.plot.is_none(), "--plot is of one device: add --device NAME, or your file");
        summary::print(&arguments.device.each(), &rates, like, None)?;
        return Ok(ExitCode::SUCCESS);
    };
    let slice = Slice::of(device);
    let limits = sweep_with_bar(&slice, &rates, &DELAYS, like, None)?;
    print_table(&slice, device, arguments, &rates, &limits, like);
    let picture = arguments.plot.as_deref().unwrap_or(Path::new("palpate-report/zwidth.svg"));
    if let Some(folder) = picture.parent() {
        std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    }
    write_whole(picture, plot(&slice, &limits).as_bytes())?;
    println!("plot: {}", picture.display());
    let rate = summary::typical(&rates);
    println!("recommended rendering at the middle of the workspace, {} kHz:", rate / 1_000.0);
    summary::axes(device, rate).iter().for_each(|line| println!("{line}"));
    println!("{}", summary::answer(device, &rates));
    Ok(ExitCode::SUCCESS)
}

fn print_table(
    slice: &Slice,
    device: &ShippedDevice,
    arguments: &Arguments,
    rates: &[f64],
    limits: &[Limit],
    like: Loop,
) {
    println!(
        "{}: {:.4} kg, {:.3} N·s/m, {:.3} N of dry friction, {:.0} µm; velocity {:?}, {} Hz",
        slice.name,
        slice.mass,
        slice.viscous,
        slice.coulomb,
        slice.resolution * 1e6,
        arguments.velocity,
        arguments.corner
    );
    println!("{}", device.assumed);
    println!(
        "maximum stiffness, N/m, along {} at the middle of the workspace (weakest direction: below), simulated (passive bound), \
         hit at 50 mm/s and pressed with 0.3 and 1 N, or 1.5 times dry friction",
        ["x", "y", "z"][Slice::axis(device)]
    );
    for rate in rates {
        print!("\n{:>5} kHz  B, N·s/m", rate / 1_000.0);
        DELAYS.iter().for_each(|delay| print!("{:>22}", format!("delay {delay} T")));
        println!();
        for damping in DAMPINGS {
            print!("{damping:>19}");
            let row = limits.iter().filter(|limit| limit.rate == *rate && limit.damping == damping);
            row.for_each(|limit| {
                print!("{:>22}", format!("{} ({:.1})", in_words(slice, limit.simulated), limit.passive))
            });
            println!();
        }
    }
    println!();
    if let Some((place, weak)) = summary::weakest(device) {
        println!(
            "maximum stiffness in the weakest direction of the workspace: {place}, {:.4} kg, behind 1 period",
            weak.mass
        );
        for rate in rates {
            let servo = Loop { rate: *rate, delay_periods: 1.0, ..like };
            print!("  {} kHz", rate / 1_000.0);
            for damping in WEAKEST {
                print!("   {damping} N·s/m: {} N/m", in_words(&weak, max_stiffness(&weak, damping, &servo)));
            }
            println!();
        }
        println!();
    }
    for delay in DELAYS {
        let best = |rate: f64| best(limits, rate, delay)[0];
        print!("delay {delay} T: maximum at any damping");
        rates.iter().for_each(|rate| print!("  {} kHz {} N/m", rate / 1_000.0, in_words(slice, best(*rate))));
        if rates.contains(&1_000.0) && rates.contains(&8_000.0) {
            print!("  8 kHz : 1 kHz = {:.2}", best(8_000.0) / best(1_000.0));
        }
        println!();
    }
    if let Some(low) = limits.iter().find(|limit| limit.simulated < limit.passive * 0.98) {
        println!("BELOW THE PASSIVE BOUND: {low:?}");
    }
}
