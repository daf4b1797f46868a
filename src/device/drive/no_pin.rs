//! A pin that is not there.

use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin};

/// Stands for an output that a board does not have: accepts every level and pulse width.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct NoPin;

impl ErrorType for NoPin {
    type Error = Infallible;
}

impl OutputPin for NoPin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
