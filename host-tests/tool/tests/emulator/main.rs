//! The firmware image on the emulated board. Runs with `cargo palpate test`; plain `cargo test` says what it leaves
//! out.

mod acceptance;
mod agreement;
mod bench;
mod budgets;
mod commissioning;
mod cycles;
mod demo;
mod faults;
mod image;
mod knob;
mod link;
mod log;
mod parity;
mod path;
mod proofs;
mod round_trip;
mod running;
mod talking;
// Its serial port is a pseudo terminal.
#[cfg(unix)]
mod telemetry;
