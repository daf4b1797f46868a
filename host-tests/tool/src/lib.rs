//! The host side of palpate: bakes model files into tables, simulates the device, runs the firmware in an emulator and
//! prints the figures. The binary `palpate` is a thin front on this library; the tests use it directly.

pub mod accept;
pub mod budgets;
pub mod cache;
pub mod cad;
pub mod commands;
pub mod commission;
pub mod cycles;
pub mod devices;
pub mod faults;
pub mod feel;
pub mod figures;
pub mod firmware;
pub mod in_c;
pub mod in_python;
pub mod knob;
pub mod models;
pub mod monitor;
pub mod own_copy;
pub mod page;
mod plot;
pub mod processor;
pub mod proof;
pub mod queries;
pub mod race;
pub mod reach;
pub mod report;
pub mod repository;
pub mod shaped;
pub mod simulation;
pub mod spread;
pub mod talk;
pub mod timed_tests;
pub mod unread;
