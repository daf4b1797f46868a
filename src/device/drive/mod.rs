//! From duty of torque to the pins of a drive, by embedded-hal.
//!
//! A [`Duty`] is a fraction of full torque. A current-controlled amplifier takes it as it is ([`SetPointDrive`]); a
//! bare bridge gives a voltage ([`HBridge`]), so the duty goes through a [`VoltageFeed`] before, which makes up for
//! resistance and back-EMF.

mod direction;
mod feed;
mod h_bridge;
mod no_pin;
mod set_point;
mod set_point_range;

use direction::Direction;
pub use feed::{Feed, VoltageFeed};
pub use h_bridge::HBridge;
pub use no_pin::NoPin;
pub use set_point::SetPointDrive;
pub use set_point_range::{SetPointRange, SetPointRangeError};

use super::Duty;
use thiserror::Error;

/// Why a drive did not take a command. `W` is the error of the pulse-width output, `P` of the pin.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum DriveError<W, P> {
    /// The pulse-width output.
    #[error("the pulse-width output failed")]
    PulseWidth(W),
    /// The enable pin, or a bridge's direction pin.
    #[error("the pin failed")]
    Pin(P),
    /// The direction pin of an amplifier.
    #[error("the direction pin failed")]
    Direction,
}

/// The stage between a duty and a motor.
pub trait Drive {
    /// What can go wrong at the pins.
    type Error;

    /// Drives the motor at a duty.
    ///
    /// # Errors
    /// A pin or pulse-width output that did not obey. The drive's state is then unknown: call [`Self::release`].
    fn apply(&mut self, duty: Duty) -> Result<(), Self::Error>;

    /// Zero output. Tries every pin, whatever fails.
    ///
    /// # Errors
    /// The first pin or output that did not obey.
    fn release(&mut self) -> Result<(), Self::Error>;
}

/// `share · most`, rounded to nearest, for a share of full scale from 0 to 32,767.
fn part_of(share: u16, most: u16) -> u16 {
    let scaled = (u32::from(share) * u32::from(most) + 16_383) / 32_767;
    // At most `most`, which is a `u16`.
    u16::try_from(scaled).unwrap_or(most)
}
