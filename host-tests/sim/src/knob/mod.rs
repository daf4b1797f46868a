//! The boards' knob on the host: its loop at the simulated dial.

mod hosted;

pub use hosted::HostKnob;
pub use palpate_bench::knob::*;

/// Angle of the simulated dial at which its sensor starts to count, radians.
pub const DIAL_ZERO: f64 = 0.7;

/// The recorded cogging of the simulated dial's motor, as in the image.
pub mod recorded {
    include!("../../../../boards/emulated/knob_cogging.rs");
}
