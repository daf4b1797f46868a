//! The long run, alone: prints what its ticks came to on the host's console, then ends the emulator.

#![no_std]
#![no_main]

use cortex_m_rt::entry;
// The vector table, and what happens when the code is wrong.
use palpate_emulated as _;
use semihosting::println;

#[entry]
fn main() -> ! {
    palpate_bench::exercise::run(&mut |name, tally| println!("{name} {tally}"));
    palpate_bench::exercise::run_soft(&mut |name, tally| println!("{name} {tally}"));
    semihosting::process::exit(0)
}
