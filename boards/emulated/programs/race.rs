//! Counts the instructions of one contestant of the race, probe by probe, between two files of the host.

#![no_std]
#![no_main]

use palpate_emulated::{budget, program, race};

program!(budget::alone(race::run));
