//! The host side of palpate: bakes model files into tables, simulates the device, runs the firmware in an emulator and
//! prints the figures. The binary `palpate` is a thin front on this library; the tests use it directly.

pub mod bake;
pub mod baselines;
pub mod bodies;
pub mod budgets;
pub mod closest;
pub mod commands;
pub mod cycles;
pub mod devices;
mod drawing;
pub mod figures;
pub mod firmware;
pub mod generate;
pub mod locating;
pub mod monitor;
pub mod oracle;
pub mod plant;
pub mod proof;
pub mod queries;
pub mod race;
pub mod report;
pub mod simulation;
pub mod zwidth;
