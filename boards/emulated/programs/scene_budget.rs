//! Counts the instructions of the tick over scenes and prints them on the host's console, then ends the emulator. A
//! program of its own: the budgets of one body are those of an image without scenes.

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
        && let Err(reason) = budget::run_scene(&mut InstructionCounter::new(&BOARD, core.SYST))
    {
        println!("{reason}");
        semihosting::process::exit(1);
    }
    semihosting::process::exit(0)
}
