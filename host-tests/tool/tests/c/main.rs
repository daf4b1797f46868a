//! The C library: what it says, what it refuses, and what it computes on the emulated board. Runs with
//! `cargo palpate test --c`; plain `cargo test` says what it leaves out.

mod arduino;
mod bad_arguments;
mod depth;
mod device;
mod everything;
mod example;
mod header;
mod homing;
mod knob;
mod rendering;
mod running;
mod servo;
mod tool;
