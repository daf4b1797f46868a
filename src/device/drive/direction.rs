//! The pin that says which way, and how long there must be no magnitude before it turns.

use embedded_hal::digital::{OutputPin, PinState};

/// A direction pin that turns only after some commands without magnitude.
#[derive(Debug)]
pub(super) struct Direction<P> {
    pin: P,
    /// Commands without magnitude before the pin turns.
    dwell: u8,
    /// Which way it points; `None` before the first command and after a release.
    forward: Option<bool>,
    /// Commands without magnitude given in a row.
    given: u8,
}

impl<P: OutputPin> Direction<P> {
    pub const fn new(pin: P, dwell: u8) -> Self {
        Self { pin, dwell: if dwell == 0 { 1 } else { dwell }, forward: None, given: 0 }
    }

    pub fn free(self) -> P {
        self.pin
    }

    /// Points the pin this way if it may turn. If not, the caller has to give no magnitude with this command.
    ///
    /// # Errors
    /// The pin's; it is tried again at the next command.
    pub fn point(&mut self, forward: bool) -> Result<bool, P::Error> {
        if self.forward == Some(forward) {
            self.given = 0;
            return Ok(true);
        }
        if self.given < self.dwell {
            self.given += 1;
            return Ok(false);
        }
        self.forward = None;
        self.pin.set_state(PinState::from(forward))?;
        (self.forward, self.given) = (Some(forward), 0);
        Ok(true)
    }

    /// The next command must wait again: the pin's state is unknown.
    pub const fn forget(&mut self) {
        (self.forward, self.given) = (None, 0);
    }
}
