//! Counts the instructions of one contestant of the race, probe by probe, between two files of the host.

#![no_std]
#![no_main]

use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_emulated::board::BOARD;
use palpate_emulated::race;
use palpate_emulated::timer::InstructionCounter;
use semihosting::println;

#[entry]
fn main() -> ! {
    if let Some(core) = Peripherals::take()
        && let Err(reason) = race::run(&mut InstructionCounter::new(&BOARD, core.SYST))
    {
        println!("{reason}");
        semihosting::process::exit(1);
    }
    semihosting::process::exit(0)
}
