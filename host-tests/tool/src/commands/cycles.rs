//! `palpate cycles`: what the hot path may take on real cores, estimated from the instructions that the emulator
//! executes.

use super::options::SceneOptions;
use crate::budgets::soft_choice;
use crate::cycles::{Calls, Core, Figure, LOOPS, ROOTS, Root, SERVO, estimate};
use crate::firmware::{Board, Choice, Program, Progress};
use clap::{Args, Parser};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Estimates the cycles of the hot path on a Cortex-M4F and a Cortex-M7.
///
/// The emulator logs every instruction of each core's image and a model of the core adds up their cycles. The result is
/// an estimated range, not a measurement.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Only the ticks of a body that gives way, on a Cortex-M4F
    #[arg(long)]
    soft: bool,
    /// Only the worst tick with all protection at the rates of fast loops, on the capped box and on this body
    #[arg(long, value_name = "MODEL", conflicts_with = "soft")]
    rates: Option<PathBuf>,
}

/// A bench board at its highest rate: its chip, the emulated board, and the core that the model has for it, its clock and
/// rate, Hz.
const FASTEST: [(&str, Board, Core, f64, f64); 3] = [
    ("STM32G474", Board::M4, Core::M4, 170e6, 20e3),
    ("RP2350, as a Cortex-M4F", Board::M4, Core::M4, 150e6, 20e3),
    ("i.MX RT1062", Board::M7, Core::M7, 600e6, 40e3),
];

const MODEL: &str = "\
The model, an estimate and no measurement; no wait states, as in CCM, ITCM and DTCM (tables in flash cost more):
  Cortex-M4F  1 an instruction; a load 2, or 1 behind another load or store; a store 1 to 2; 1 + N for N words at once;
              taken branch 1 + 1 to 3; VDIV, VSQRT 14; VMLA 3; +1 where the next instruction wants a float result; UDIV 2 to 12
  Cortex-M7   low: two instructions in each cycle, every branch foreseen; high: one at a time, a load 2, +2 where the next
              instruction wants a float result, every conditional branch unforeseen at 6; VDIV, VSQRT 14 in both";

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if let Some(model) = &arguments.rates {
        return at_rates(model);
    }
    // The clock of the board for the bench with this core, Hz.
    for (board, core, chip, clock) in
        [(Board::M4, Core::M4, "STM32G474", 170e6), (Board::M7, Core::M7, "i.MX RT1062", 600e6)]
    {
        if arguments.soft && board != Board::M4 {
            continue;
        }
        let progress = Progress::new();
        let tell = |what: &str| eprintln!("{}: running {what}, instruction by instruction: minutes", board.core());
        let mut found = if arguments.soft {
            Vec::new()
        } else {
            let program = Program::prepare(board, "budget", &[], &progress)?;
            tell("the parts of a tick");
            estimate(&program, core, &ROOTS)?
        };
        let is_soft = |feature: &str| feature.starts_with("soft");
        let is_wanted = |feature| board == Board::M4 && (is_soft(feature) || !arguments.soft);
        // One core: they take minutes to build.
        for (feature, title) in LOOPS.into_iter().filter(|(feature, _)| is_wanted(feature)) {
            let program = if is_soft(feature) {
                Program::prepare_with(&soft_choice(board)?, "budget", &[feature], &progress)?
            } else {
                Program::prepare(board, "budget", &[feature], &progress)?
            };
            tell(title);
            found.extend(estimate(&program, core, &[Root { title, ..SERVO }])?);
        }
        println!("{}: estimated cycles; microseconds on a {chip} at {} MHz", board.core(), clock / 1e6);
        println!(
            "  {:<28}{:>13}{:>17}{:>13}{:>17}{:>15}{:>14}",
            "", "instructions", "cycles, median", "at most", "cycles, worst", "us, worst", "load at 4 kHz"
        );
        for (root, calls) in &found {
            row(root.title, calls, clock);
            if calls.is_pushed.contains(&true) {
                row("  in contact", &calls.which(true), clock);
                row("  free", &calls.which(false), clock);
            }
        }
        println!();
    }
    println!("{MODEL}");
    Ok(ExitCode::SUCCESS)
}

/// A scene's options, as `demo` has them.
#[derive(Parser)]
struct Felt {
    #[command(flatten)]
    options: SceneOptions,
}

/// The image that counts ticks on a model's body, rendered smoothly, all protection on: of motors that are warm, so that the pulses of the
/// polarity check and the limits of heat are both among its ticks.
fn protected_on(model: Option<&Path>, board: Board, progress: &Progress) -> anyhow::Result<Program> {
    let Some(model) = model else { return Ok(Program::prepare(board, "budget", &["folded", "smooth"], progress)?) };
    let words = [OsStr::new("demo"), OsStr::new("--model"), model.as_os_str()];
    let scene = Felt::try_parse_from(words)?.options.scene()?;
    let folder = tempfile::tempdir()?;
    let (body, settings) = (folder.path().join("body.rs"), folder.path().join("settings.rs"));
    fs::write(&body, scene.source()? + &scene.around()?)?;
    fs::write(&settings, scene.settings_source())?;
    let choice = Choice { board, body: Some(body), settings: Some(settings), ..Choice::default() };
    Ok(Program::prepare_with(&choice, "budget", &["folded", "around"], progress)?)
}

fn at_rates(model: &Path) -> anyhow::Result<ExitCode> {
    println!("worst servo tick, all protection on, effort (1, 1), estimated:");
    println!("  {:<26}{:<22}{:>13}{:>17}{:>8}{:>18}", "", "body", "instructions", "cycles", "kHz", "load of the tick");
    let progress = Progress::new();
    for body in [Some(model), None] {
        let name = body.and_then(Path::file_stem).unwrap_or(OsStr::new("capped_box")).to_string_lossy();
        let mut last: Option<(Board, Vec<(Root, Calls)>)> = None;
        for (chip, board, core, clock, rate) in FASTEST {
            let found = match last.take() {
                Some(found) if found.0 == board => found,
                _ => {
                    let program = protected_on(body, board, &progress)?;
                    let what = format!("following each instruction of the ticks on {name}, {}", board.core());
                    (board, progress.during(&what, || estimate(&program, core, &[SERVO]))?)
                }
            };
            for (_, calls) in &found.1 {
                let worst = |values: &[u32]| values.iter().max().copied().unwrap_or_default();
                let [instructions, low, high] =
                    [&calls.instructions, &calls.cycles[0], &calls.cycles[1]].map(|v| worst(v));
                let load = |cycles: u32| 100.0 * f64::from(cycles) * rate / clock;
                println!(
                    "  {chip:<26}{name:<22}{instructions:>13}{:>17}{:>8}{:>18}",
                    format!("{low} to {high}"),
                    rate / 1e3,
                    format!("{:.0} to {:.0} %", load(low), load(high)),
                );
            }
            last = Some(found);
        }
    }
    println!("\n{MODEL}");
    Ok(ExitCode::SUCCESS)
}

/// A line of the table. The load is that of the worst call, at the upper end of the range.
fn row(title: &str, calls: &Calls, clock: f64) {
    let figure = |values: &[u32]| Figure::of(values).unwrap_or(Figure { median: 0, worst: 0 });
    let (instructions, low, high) = (figure(&calls.instructions), figure(&calls.cycles[0]), figure(&calls.cycles[1]));
    let microseconds = |cycles: u32| 1e6 * f64::from(cycles) / clock;
    println!(
        "  {:<28}{:>13}{:>17}{:>13}{:>17}{:>15}{:>14}",
        title,
        instructions.median,
        format!("{} to {}", low.median, high.median),
        instructions.worst,
        format!("{} to {}", low.worst, high.worst),
        format!("{:.1} to {:.1}", microseconds(low.worst), microseconds(high.worst)),
        format!("{:.1} %", 100.0 * f64::from(high.worst) / (clock / 4e3)),
    );
}
