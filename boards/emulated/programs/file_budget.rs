//! Counts the instructions of loading a body from its file, and of feeling it, and prints them on the host's console,
//! then ends the emulator. A program of its own: the budgets of statics are those of an image without a file.

#![no_std]
#![no_main]

use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_emulated::board::BOARD;
use palpate_emulated::budget;
use palpate_emulated::timer::InstructionCounter;
use semihosting::println;

#[entry]
fn main() -> ! {
    if let Some(core) = Peripherals::take()
        && let Err(reason) = budget::run_file(&mut InstructionCounter::new(&BOARD, core.SYST))
    {
        println!("{reason}");
        semihosting::process::exit(1);
    }
    semihosting::process::exit(0)
}
