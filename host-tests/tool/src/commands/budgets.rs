//! `palpate budgets`: what the hot path costs on the emulated board, beside what it may cost.

use super::bake;
use crate::budgets::{Budget, BudgetError, Figures, Images, Verdict, measure, on_file};
use crate::firmware::{BenchBoard, Board, Progress};
use anyhow::anyhow;
use clap::Args;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Counts the instructions of the hot path on an emulated board and compares them with the committed budget.
///
/// Exit status 1 if a figure is over its budget, missing or new.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Board
    #[arg(long, value_enum, default_value_t)]
    board: Board,
    /// Write the counts to the budget file
    #[arg(long)]
    record: bool,
    /// Instead: queries without history on a model's body, in front of its faces and anywhere around
    #[arg(long, value_name = "MODEL", conflicts_with = "record")]
    cold: Option<PathBuf>,
    /// Instead: the servo tick of a ball (radius 3 mm), a capsule (18 mm) and a box (18, 12, 6 mm) with that radius, pressed
    /// into each face of a model's body from 16 mm in front, where they are outside of it, and the rate that fits on each
    /// bench board
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["record", "cold"])]
    tool: Option<PathBuf>,
    /// Instead: the committed budget of the servo tick on every core
    #[arg(long, conflicts_with_all = ["record", "cold", "tool"])]
    cores: bool,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    if arguments.cores {
        print!("{}", cores()?);
        return Ok(ExitCode::SUCCESS);
    }
    if let Some((model, feature)) =
        arguments.cold.as_ref().map(|model| (model, "cold")).or(arguments.tool.as_ref().map(|model| (model, "tool")))
    {
        let folder = tempfile::tempdir()?;
        let file = folder.path().join("cold.palp");
        fs::write(&file, bake::file_of(model)?)?;
        let found = on_file(arguments.board, &file, feature, &Progress::new()).map_err(|error| match error {
            BudgetError::Stopped(reason) => anyhow!(
                "{}: {reason}; this tool does not suit this body: take a larger body or one of fewer patches, or try \
                 another tool with `palpate demo --tool`",
                model.display()
            ),
            error => error.into(),
        })?;
        found.0.iter().for_each(|(name, count)| println!("{name:<55}  {count:>8}"));
        if feature == "tool" && Board::CORTEX_F.contains(&arguments.board) {
            print!("{}", fits(&found));
        }
        return Ok(ExitCode::SUCCESS);
    }
    let found = measure(arguments.board, Images::All, &Progress::new())?;
    if arguments.record {
        let file = Budget::record(arguments.board, &found)?;
        println!("recorded {} figures in {}", found.0.len(), file.display());
        return Ok(ExitCode::SUCCESS);
    }
    let budget = Budget::load(arguments.board)?;
    let verdicts = budget.compare(&found, Images::All);
    print_table(&found, &verdicts);
    Ok(if verdicts.iter().any(Verdict::fails) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

/// Cycles of an instruction on any chip: the model of `palpate cycles` has 1.7 to 2.1 for a Cortex-M4F, and memory answers
/// late.
const CYCLES: f64 = 2.7;

/// The bench boards with their clocks, Hz.
const CHIPS: [(BenchBoard, f64); 3] =
    [(BenchBoard::Stm32g4, 170e6), (BenchBoard::Pico2, 150e6), (BenchBoard::Teensy41, 600e6)];

/// The rate at which the worst tick of each tool fills a period of each bench board.
fn fits(found: &Figures) -> String {
    let mut text = format!("\nat {CYCLES} cycles an instruction, on boards that run at 3000 Hz and more:\n");
    for tool in ["ball", "capsule", "box"] {
        let worst = ["locating", "held"].map(|part| found.of(&format!("{tool}, {part}, worst")).unwrap_or_default());
        let cycles = CYCLES * f64::from(worst[0].max(worst[1]));
        let rates = CHIPS.map(|(board, hertz)| format!("{:.0} Hz on {}", hertz / cycles, board.name()));
        text += &format!("{tool:<8} fits up to {}\n", rates.join(", "));
    }
    text
}

/// The cost of the servo tick on each core, as a table, with the rate at which the worst tick fills a period of a chip.
fn cores() -> anyhow::Result<String> {
    let mut table = String::from(
        "| core | `--board` | target | servo tick, median | worst | chip, MHz | kHz, at most |\n|---|---|---|---|---|---|---|\n",
    );
    for board in Board::ALL {
        let budget = Budget::load(board)?;
        let [median, worst] =
            ["median", "worst"].map(|part| budget.of(&format!("servo tick, {part}")).unwrap_or_default());
        let (chip, megahertz) = match board {
            Board::M4 => ("STM32G474", 170.0),
            Board::M7 => ("i.MX RT1062", 600.0),
            Board::M33 => ("RP2350", 150.0),
            Board::Riscv => ("CH32V307", 144.0),
            Board::RiscvImc => ("ESP32-C3", 160.0),
            Board::M0 => ("RP2040", 133.0),
        };
        let rate = megahertz * 1e3 / (CYCLES * f64::from(worst));
        let (core, name, target) = (board.core(), board.name(), board.target());
        writeln!(
            table,
            "| {core} | `{name}` | `{target}` | {median} | {worst} | {chip}, {megahertz} | {rate:.*} |",
            usize::from(rate < 10.0)
        )?;
    }
    Ok(table)
}

fn print_table(found: &Figures, verdicts: &[Verdict]) {
    let width = found.0.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    println!("{:<width$}  {:>8}  {:>8}", "instructions", "counted", "budget");
    for verdict in verdicts {
        let shown = |count: Option<u32>| count.map_or_else(|| "-".to_owned(), |count| count.to_string());
        let Verdict { name, found, allowed } = verdict;
        println!("{name:<width$}  {:>8}  {:>8}  {}", shown(*found), shown(*allowed), verdict.remark());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_tick_of_a_tool_fills_a_period() {
        let worst =
            [("ball, locating", 6_572), ("ball, held", 9_722), ("capsule, held", 36_166), ("box, held", 84_324)];
        let text = fits(&Figures(worst.map(|(name, count)| (format!("{name}, worst"), count)).into()));
        // 9,722 instructions at 2.7 cycles are 26,249 cycles, 154.4 µs at 170 MHz.
        assert!(
            text.contains("\nball     fits up to 6476 Hz on stm32g4, 5714 Hz on pico2, 22858 Hz on teensy41\n"),
            "{text}"
        );
        assert!(text.contains("\nbox      fits up to 747 Hz on stm32g4,"), "{text}");
    }
}
