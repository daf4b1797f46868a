//! `palpate image`: the sizes of the firmware image, and the bounds proved of it.

use crate::firmware::{Board, Program, Progress};
use crate::proof::{Code, Lines, LoopList, Tree, deepest, flash_by_part};
use crate::repository;
use clap::Args;
use std::process::ExitCode;

/// The function whose call tree is the tick's.
pub const TICK: &str = "palpate_emulated::body::tick";
/// Bytes that a core puts on the stack at an interrupt: 8 words of integers, 18 of floats, and one to align.
pub const EXCEPTION_FRAME: i64 = 4 * (8 + 18 + 1);

/// Prints the flash, RAM and stack of an emulated board's image, and what its machine code proves of the tick.
#[derive(Args, Debug)]
pub struct Arguments {
    /// Board
    #[arg(long, value_parser = Board::cortex_f(), default_value = "m4")]
    board: Board,
    /// Program: `uart` or `fifo`
    #[arg(long, default_value = "uart")]
    program: String,
    /// All protection of the device
    #[arg(long)]
    protected: bool,
}

/// Runs the command: 0 if nothing was found, 1 otherwise.
///
/// # Errors
/// The cause, for the terminal.
pub fn run(arguments: &Arguments) -> anyhow::Result<ExitCode> {
    let features: &[&str] = if arguments.protected { &["protected"] } else { &[] };
    let program = Program::prepare(arguments.board, &arguments.program, features, &Progress::new())?;
    let image = &program.image;
    let code = Code::read(&image.elf)?;
    let lines = Lines::read(&image.elf).map_err(|error| anyhow::anyhow!("{error}"))?;
    println!("palpate image: {} for an emulated {}", arguments.program, arguments.board.core());
    println!("  {:<22} {:>6} bytes", "flash", image.flash);
    for (part, bytes) in flash_by_part(&code, &lines, image.flash) {
        println!("    {part:<20} {bytes:>6}");
    }
    println!("  {:<22} {:>6} bytes", "RAM, static", image.ram);
    println!("  {:<22} {:>6} bytes", "stack, at most", deepest_stack(&code)?);
    let tree = Tree::new(&code, code.named(TICK)?);
    println!("  {:<22} {:>6} bytes", "of it the tick", deepest(&code, code.named(TICK)?)?);
    let list = LoopList::read(&repository::root()?.join("host-tests/budgets/loops.toml"))?;
    println!("  the tick: {} functions, {} loops", tree.functions().count(), tree.loops().len());
    for (function, found) in tree.loops() {
        let home = lines.home(function, &found);
        let entry = list.entries.iter().find(|entry| entry.function == home);
        let bound =
            entry.map_or("NOT LISTED".to_owned(), |entry| format!("{} rounds: {}", entry.rounds, entry.because));
        println!("    {home} in {}: {bound}", function.name);
    }
    let mut bad = list.missing(&tree, &lines);
    bad.extend(tree.findings().iter().map(ToString::to_string));
    bad.extend(unwanted(&code, &lines));
    for finding in &bad {
        println!("  FOUND {finding}");
    }
    if bad.is_empty() {
        println!(
            "  found nothing of: panic, trap, double precision, allocation, recursion, call through a pointer, other loop"
        );
    }
    Ok(if bad.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The deepest stack of a whole image: the program, one interrupt on top of it. Nothing interrupts the interrupt: it is
/// the only one.
///
/// # Errors
/// Why there is no bound.
pub fn deepest_stack(code: &Code) -> anyhow::Result<i64> {
    let program = deepest(code, code.named("main")?)?;
    let interrupt = deepest(code, code.named("TIMER0")?)?;
    Ok(program + EXCEPTION_FRAME + interrupt)
}

/// Symbols that must not be anywhere in an image, in the tick or not: an allocator, or a routine for `f64`.
pub fn unwanted(code: &Code, lines: &Lines) -> Vec<String> {
    let mut found = Vec::new();
    for function in code.functions() {
        if crate::proof::is_double_routine(&function.name) {
            found.push(format!("a routine for f64: {}", function.name));
        }
        let allocates =
            ["__rust_alloc", "__rust_realloc", "__rdl_alloc", "__rg_alloc", "handle_alloc_error", "GlobalAlloc"];
        if allocates.iter().any(|part| function.name.contains(part)) || function.name.starts_with("alloc::") {
            found.push(format!("an allocator: {}", function.name));
            continue;
        }
        // Inlined, it has no symbol of its own but still its lines.
        let inlined = function.instructions.keys().find_map(|address| {
            let is_alloc = |place: &crate::proof::Place| place.file.to_string_lossy().contains("/library/alloc/");
            lines.places(*address).into_iter().find(is_alloc)
        });
        if let Some(place) = inlined {
            found.push(format!("an allocator: {} in {}", place.function, function.name));
        }
    }
    found
}
