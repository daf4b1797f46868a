//! The joints' sensors, as one.

mod angles;
mod bounded;
mod counters;
mod selected;

pub use angles::{Angles, SELECT, ticks_per_round};
pub use bounded::{Bounded, Controller, Unfinished};
pub use counters::{Counters, Readings, max_step, max_steps};
pub use selected::{SelectError, SelectTiming, Selected};

use palpate::device::Counts;
use palpate::servo::Input;
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
    /// The magnet's field is too strong or too weak: the magnet is loose or gone.
    #[error("a sensor's magnet is too strong or too weak")]
    Magnet,
    /// The same reading for too long from a sensor whose last bits are never quiet.
    #[error("a sensor is frozen")]
    Frozen,
}

impl BadFrame {
    /// Number of kinds.
    pub const KINDS: usize = 5;

    /// The tick's input without counts.
    pub const fn input<const JOINTS: usize>(self) -> Input<JOINTS> {
        match self {
            Self::Absent => Input::Lost,
            Self::Damaged | Self::Jumped => Input::Damaged,
            Self::Magnet => Input::Magnet,
            Self::Frozen => Input::Frozen,
        }
    }
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

    /// The automatic gain of each magnetic sensor, 255 in a weak field; 0 of a sensor without one.
    #[inline]
    fn gains(&self) -> [u8; JOINTS] {
        [0; JOINTS]
    }
}
