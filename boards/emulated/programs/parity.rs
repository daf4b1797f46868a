//! The long run, alone: prints what its ticks came to on the host's console, then ends the emulator.

#![no_std]
#![no_main]

// The vector table.
use board as _;
use cortex_m_rt::entry;
use palpate_emulated as _;
use semihosting::println;

#[entry]
fn main() -> ! {
    palpate_exercise::run(&mut |name, tally| println!("{name} {tally}"));
    semihosting::process::exit(0)
}
