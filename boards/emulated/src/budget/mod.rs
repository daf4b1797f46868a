//! The cost of the hot path in counted instructions: the figures that `cargo palpate budgets` compares.
//!
//! Each figure is a line on the host's console, `name = instructions`. Everything but the counter is plain library
//! code: another core needs its own counter and nothing else. A call counts too: the measured code is behind a function
//! that is not inlined, and the compiler does not know its patch.

mod closest;
mod cold;
mod evaluation;
mod file;
#[cfg(feature = "knob")]
mod knob;
mod mathematics;
mod patches;
#[cfg(feature = "scene")]
mod scene;
mod servo;
mod step;
mod tables;
mod tally;
#[cfg(feature = "tool")]
mod tool;

pub use tally::Tally;

use crate::board::BOARD;
use crate::timer::InstructionCounter;
use semihosting::println;

/// A program that counts, then ends the emulator.
pub fn alone(count: fn(&mut InstructionCounter) -> Result<(), &'static str>) -> ! {
    if let Some(mut counter) = InstructionCounter::take(&BOARD)
        && let Err(reason) = count(&mut counter)
    {
        println!("{reason}");
        semihosting::process::exit(1);
    }
    semihosting::process::exit(0)
}

/// Measures and prints the figures of the knob's tick.
///
/// # Errors
/// Its path failed, so that its figures would mean nothing.
#[cfg(feature = "knob")]
pub fn run_knob(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    knob::run(counter)
}

/// Measures and prints what it takes to load a body from its file, and to feel it then.
///
/// # Errors
/// That the file is refused, or what the walk ran into.
pub fn run_file(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    file::run(counter)
}

/// Measures and prints what the tick costs over scenes.
///
/// # Errors
/// A path failed, so that its figures would mean nothing.
#[cfg(feature = "scene")]
pub fn run_scene(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    scene::run(counter)
}

/// Measures and prints all figures.
///
/// # Errors
/// A walk missed a feature or failed, so that its figures would mean nothing.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    // Of another loop its tick alone is looked at.
    if cfg!(any(feature = "soft", feature = "around", feature = "protected", feature = "smooth")) {
        return servo::run(counter);
    }
    #[cfg(feature = "tool")]
    return tool::run(counter);
    #[cfg(not(feature = "tool"))]
    run_rest(counter)
}

#[cfg(not(feature = "tool"))]
fn run_rest(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    if cfg!(feature = "cold") {
        return cold::run(counter);
    }
    evaluation::run(counter);
    step::run(counter)?;
    servo::run(counter)?;
    mathematics::run(counter);
    // Last, as the longest: a trace of instructions need not wait for its end.
    closest::run(counter)
}
