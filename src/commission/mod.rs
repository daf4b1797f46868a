//! Commissioning on the bench: one motor at a time, gently, while a person holds a key.
//!
//! [`Jogging`] runs in the place of the servo, before the device's parameters are known: it works in counts and duties.
//! Its limits lie in the device's own flash; the host can only request less. A motor is driven only while all of this
//! holds, and otherwise has no current in the same tick:
//!
//! - [`Jog`] frames with [`KEY`] in them keep coming, each with a higher number than the one before, and the last one
//!   not longer ago than [`JogLimits::patience_s`];
//! - the enable input of the device is held;
//! - every sensor answers, and nothing moves faster or further than its limit.
//!
//! A jog that ends reports a [`JogRefusal`], which is latched until the key is released. To jog another motor, release
//! the key first.

//!
//! The result is a [`Calibration`]: a record that may be kept in the chip's flash, and is validated at every start
//! ([`crate::device::Device::calibrated`]).

mod calibration;
mod calibration_error;
mod jogging;
mod wiring;

#[cfg(test)]
pub(crate) use calibration::FRICTION_WITHIN;
pub use calibration::{Calibration, Gains, JointCalibration};
pub use calibration_error::CalibrationError;
pub use jogging::{Jog, JogLimits, JogLimitsError, JogRefusal, JogState, Jogging, KEY};
pub use wiring::Wiring;
