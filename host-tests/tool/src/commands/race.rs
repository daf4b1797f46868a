//! `palpate race`: palpate against Newton's method and what people use today.

use super::output::write_whole;
use crate::firmware::{Board, Progress};
use crate::race::on_target::{self, COURSES, Target};
use crate::race::{self, Program, Scene, Who};
use anyhow::Context as _;
use clap::Args;
use std::fs;
use std::path::PathBuf;
use std::process::ExitCode;

/// Races palpate against Newton's method, truck and parry: counted instructions, nanoseconds, errors, misses.
///
/// All use the same surfaces and probes: Table I of the paper and its convex companion, every query by itself (500
/// golden probes near the surface) and following a probe (10,000 rows of a smooth path, and 2,000 golden rows). A miss
/// is a distance wrong by more than 1e-4 of the patch's size, or no answer.
///
/// Instructions are counted by valgrind per query and repeat exactly with one compiler; it is installed if that needs no
/// password. Nanoseconds are the quickest of five runs of each query.
///
/// The first run compiles the peers, which takes minutes.
///
/// With `--board` whole bodies on an emulated core instead, against code that a firmware engineer would write: distance
/// grids, a walk over triangles, Newton's method.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Folder for numbers (race.csv) and picture (race.svg)
    #[arg(long, default_value = "palpate-report/race")]
    out: PathBuf,
    /// Rows of the path: servo ticks for its 1.2 m
    #[arg(long, default_value_t = 10_000, value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    rows: u32,
    /// Skip the peers, which take most of the time; Newton's counts are then some percent higher
    #[arg(long)]
    without_peers: bool,
    /// Race on this emulated board
    #[arg(long, value_parser = Board::cortex_f(), conflicts_with_all = ["out", "without_peers"])]
    board: Option<Board>,
    /// Bodies of the race on a board; default: all
    #[arg(long, requires = "board", num_args = 1.., value_parser = COURSES)]
    body: Vec<String>,
}

/// Runs the command.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let progress = Progress::new();
    // Before anything is installed in vain.
    crate::repository::root()?;
    if let Some(board) = arguments.board {
        let target = Target::build(board, &progress)?;
        for name in
            COURSES.iter().filter(|name| arguments.body.is_empty() || arguments.body.iter().any(|body| body == *name))
        {
            println!("{}", on_target::race(&target, name, arguments.rows as usize, &progress).context(*name)?);
        }
        return Ok(ExitCode::SUCCESS);
    }
    race::set_up(&progress)?;
    let who = if arguments.without_peers { Who::Own } else { Who::All };
    let program = Program::build(who, &progress)?;
    let scenes = progress.during("judging the path", || Scene::all(arguments.rows as usize))?;
    let mut scores = Vec::new();
    for scene in &scenes {
        scores.push(race::race(&program, scene, &progress).with_context(|| scene.title())?);
    }
    for scene in &scores {
        println!("{}", race::text(scene));
    }
    let out = &arguments.out;
    fs::create_dir_all(out).with_context(|| format!("cannot make the folder {}", out.display()))?;
    for (name, contents) in [("race.csv", race::csv(&scores.concat())?), ("race.svg", race::draw(&scores).into_bytes())]
    {
        let path = out.join(name);
        write_whole(&path, &contents)?;
        println!("{}", path.display());
    }
    Ok(ExitCode::SUCCESS)
}
