//! The boards' knob on the host: its loop at the simulated dial.

mod hosted;
#[cfg(feature = "link")]
mod simulated;

pub use hosted::HostKnob;
pub use palpate_bench::knob::*;
#[cfg(feature = "link")]
pub use simulated::{KnobFlash, KnobWorld, SharedKnob, SimulatedKnob};

/// Angle of the simulated dial at which its sensor starts to count, radians.
pub const DIAL_ZERO: f64 = 0.7;

/// The recorded cogging of the simulated dial's motor, as in the image.
pub mod recorded {
    include!("../../../../boards/emulated/knob_cogging.rs");
}

/// The widths of a report; `None` for a stage that is disabled.
pub fn widths_of(report: &palpate::wire::Report) -> Option<[f64; 3]> {
    (report.duties != [i16::MIN; 3]).then(|| report.duties.map(|duty| f64::from(duty) / 65_534.0 + 0.5))
}
