//! The firmware image on the emulated board. Runs with `cargo palpate test`; plain `cargo test` says what it leaves out.

mod agreement;
mod bench;
mod demo;
mod faults;
mod image;
mod log;
mod path;
mod round_trip;
mod running;
mod telemetry;
