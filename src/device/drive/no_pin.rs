//! A pin that is not there.

use core::convert::Infallible;
use embedded_hal::digital::{ErrorType, OutputPin};

/// In the place of an output that a board does not have: it takes whatever it is told.
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
