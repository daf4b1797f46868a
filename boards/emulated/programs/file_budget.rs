//! Counts the instructions of loading a body from its file, and of feeling it, and prints them on the host's console,
//! then ends the emulator. A program of its own: the budgets of statics are those of an image without a file.

#![no_std]
#![no_main]

use palpate_emulated::{budget, program};

program!(budget::alone(budget::run_file));
