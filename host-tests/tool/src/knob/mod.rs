//! The knob: the recording of its cogging, and measurements of it.

pub mod cogging;
mod on_host;
pub mod turning;

pub use cogging::Recording;
pub use cogging::record;
pub use on_host::KnobLine;
pub use palpate_sim::knob::*;
