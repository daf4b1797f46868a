//! `palpate budgets`: what the hot path costs on the emulated board, beside what it may cost.

use crate::budgets::{Budget, Figures, Verdict, measure};
use crate::firmware::{Board, Progress};
use clap::Args;
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
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let found = measure(arguments.board, &Progress::new())?;
    if arguments.record {
        let file = Budget::record(arguments.board, &found)?;
        println!("recorded {} figures in {}", found.0.len(), file.display());
        return Ok(ExitCode::SUCCESS);
    }
    let budget = Budget::load(arguments.board)?;
    let verdicts = budget.compare(&found);
    print_table(&found, &verdicts);
    Ok(if verdicts.iter().any(Verdict::fails) { ExitCode::FAILURE } else { ExitCode::SUCCESS })
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
