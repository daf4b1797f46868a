//! The knob: its loop on the host, the recording of its cogging, and what is measured of it.

pub mod cogging;
mod hosted;
mod on_host;
mod recording;
#[path = "../../../../boards/knob.rs"]
mod shared;
pub mod turning;

pub use cogging::Recording;
pub use hosted::HostKnob;
pub use on_host::{KnobLine, KnobWorld, SharedKnob};
pub use recording::record;
pub use shared::*;

/// Angle of the simulated dial at which its sensor begins to count, radians.
pub const DIAL_ZERO: f64 = 0.7;

/// The cogging of the simulated dial's motor, as it was recorded and lies in the image.
pub mod recorded {
    include!("../../../../boards/emulated/knob_cogging.rs");
}
