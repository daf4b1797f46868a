//! From duty of torque to the pins of a drive, by embedded-hal.
//!
//! A [`Duty`] is a fraction of full torque. A current-controlled amplifier takes it as it is ([`SetPointDrive`]); a
//! bare bridge gives a voltage ([`HBridge`]), so the duty first passes a [`VoltageFeed`], which compensates resistance
//! and back-EMF. Three bridges that make the field of a motor with three phases ([`ThreePhase`]) are fed the same way,
//! and also get the field.

mod direction;
mod feed;
mod field;
mod h_bridge;
mod modulation;
mod no_pin;
mod set_point;
mod set_point_range;
mod three_phase;

use direction::Direction;
pub use feed::{Feed, Supply, VoltageFeed};
pub use field::Field;
pub use h_bridge::HBridge;
pub use modulation::Modulation;
pub use no_pin::NoPin;
pub use set_point::SetPointDrive;
pub use set_point_range::{SetPointRange, SetPointRangeError};
pub use three_phase::ThreePhase;

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
    /// The direction pin of an amplifier failed, or the field was never set.
    #[error("the direction failed")]
    Direction,
}

/// The stage between a duty and a motor.
pub trait Drive {
    /// The error of a pin or pulse-width output.
    type Error;

    /// The field that the duties from now on make. A motor that has no phases takes no notice.
    fn aim(&mut self, _: Field) {}

    /// Drives the motor at a duty.
    ///
    /// # Errors
    /// A pin or pulse-width output that failed. The drive's state is then unknown: call [`Self::release`].
    fn apply(&mut self, duty: Duty) -> Result<(), Self::Error>;

    /// Zero output. Sets every pin, even after one failed.
    ///
    /// # Errors
    /// The first pin or output that failed.
    fn release(&mut self) -> Result<(), Self::Error>;
}

/// `share · most`, rounded to nearest, for a share of full scale from 0 to 32,767.
fn part_of(share: u16, most: u16) -> u16 {
    let scaled = (u32::from(share) * u32::from(most) + 16_383) / 32_767;
    // At most `most`, which is a `u16`.
    u16::try_from(scaled).unwrap_or(most)
}
