//! Position sensors, by embedded-hal: from frames to validated [`Counts`](super::Counts).

mod ams;
mod error_rate;
mod frozen;
mod mt6701;
mod quadrature;
mod unwrap;

pub use ams::{AmsAngle, AmsChip, AmsReading};
pub use error_rate::ErrorRate;
pub use frozen::Frozen;
pub use mt6701::{Mt6701, Mt6701Reading};
pub use quadrature::Quadrature;
pub use unwrap::{TimerCount, TurnCount, Unwrap};

use thiserror::Error;

/// Why a reading cannot be used. `E` is the bus's own error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum SensorError<E> {
    /// The bus failed.
    #[error("the bus failed")]
    Bus(E),
    /// A reading came damaged: parity or CRC is wrong.
    #[error("the reading came damaged")]
    Damaged,
    /// The sensor reports that the last command reached it damaged.
    #[error("the sensor refused the last command")]
    Refused,
    /// Nothing but ones or zeros: no sensor answers, or it is not ready.
    #[error("no sensor answers")]
    Absent,
    /// The magnet is too near, too far or gone.
    #[error("the magnet's field is too strong or too weak")]
    Magnet,
    /// The shaft turned faster than the sensor can follow.
    #[error("the sensor lost track")]
    TrackLost,
}

/// The position moved further between two readings than the device can move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("the position jumped by {by} counts")]
pub struct Jumped {
    /// How far, counts.
    pub by: i32,
}

/// Both channels of an encoder changed at once: an edge was missed, so counts are lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[error("an encoder edge was missed")]
pub struct EdgeMissed;
