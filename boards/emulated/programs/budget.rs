//! Counts the instructions of the hot path and prints them on the host's console, then ends the emulator.

#![no_std]
#![no_main]

use palpate_emulated::{budget, program};

program!(budget::alone(budget::run));
