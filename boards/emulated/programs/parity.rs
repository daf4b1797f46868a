//! The long run, alone: prints what its ticks came to on the host's console, then ends the emulator.

#![no_std]
#![no_main]

use palpate_emulated::program;
use semihosting::println;

program!({
    palpate_bench::exercise::run(&mut |name, tally| println!("{name} {tally}"));
    palpate_bench::exercise::run_soft(&mut |name, tally| println!("{name} {tally}"));
    semihosting::process::exit(0)
});
