//! Counts the instructions of the tick over scenes and prints them on the host's console, then ends the emulator. A
//! program of its own: the budgets of one body are those of an image without scenes.

#![no_std]
#![no_main]

use palpate_emulated::{budget, program};

program!(budget::alone(budget::run_scene));
