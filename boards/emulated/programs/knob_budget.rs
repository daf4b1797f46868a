//! Counts the instructions of the knob's tick and prints them on the host's console, then ends the emulator. A program
//! of its own: two loops in one image would share code that each alone has for itself.

#![no_std]
#![no_main]

use palpate_emulated::{budget, program};

program!(budget::alone(budget::run_knob));
