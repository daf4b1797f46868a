//! The joints' sensors, as one.

mod angles;
mod counters;
mod selected;
mod watched;

pub use angles::{Angles, SELECT};
pub use counters::{Counters, Readings, max_step, max_steps};
pub use selected::{SelectError, SelectTiming, Selected};
pub use watched::Watched;

use palpate::device::Counts;
use thiserror::Error;

/// A frame of the sensors that cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BadFrame {
    /// None came: a sensor is not there, or not ready.
    #[error("a sensor does not answer")]
    Absent,
    /// It came damaged: parity, CRC, or the sensor's own flag.
    #[error("a sensor's frame came damaged")]
    Damaged,
    /// It says what no hand does.
    #[error("a sensor jumped")]
    Jumped,
}

/// The sensors of all joints.
pub trait Sensors<const JOINTS: usize> {
    /// The counts now.
    ///
    /// # Errors
    /// The fault of the first bad frame. The next reading is measured against the last good one.
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame>;

    /// The counts at which index marks were passed since the last call, each reported once, in the counts
    /// of the last good reading. None of sensors without marks.
    #[inline]
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        [None; JOINTS]
    }
}
