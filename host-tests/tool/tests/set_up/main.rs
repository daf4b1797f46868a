//! A device set up and accepted by the host's commands, on simulated boards.

mod acceptance;
mod cogging;
mod commissioning;
mod kept_zero;
