//! Stopping, and going on.

use crate::{ALIVE, Device, Error, Line};
use palpate::servo::Fault;
use palpate::wire::{HostMessage, hold};
use std::time::Duration;

/// How long the stop is repeated without a confirmation.
const STOPS: Duration = Duration::from_millis(500);
/// How long a person is waited for who is to confirm something: longer than the device waits.
pub(crate) const CONFIRMED: Duration = Duration::from_secs(35);

impl<L: Line> Device<L> {
    /// Stops the device, in any state, until it is reset: repeats the message until the device confirms the stop. A
    /// device of this version confirms it in its views and records, even without a greeting.
    ///
    /// # Errors
    /// A line that broke, or no confirmation: then disconnect the device's supply.
    pub fn stop(&mut self) -> Result<(), Error> {
        // What was heard before is from before.
        (self.view, self.record, self.reading) = (None, None, None);
        let (began, mut tries) = (self.line.now(), 0);
        while self.since(began) < STOPS {
            self.send(&HostMessage::Stop)?;
            tries += 1;
            let sent = self.line.now();
            while self.since(sent) < ALIVE {
                self.hear(ALIVE)?;
                if self.viewed_fault().is_some() || self.reading.is_some_and(|reading| !reading.live) {
                    return Ok(());
                }
            }
            // One that was not greeted sends no views; a view of before may still come after a record.
            if self.view.is_none() && self.recorded_fault().is_some() {
                return Ok(());
            }
        }
        Err(Error::NotStopped { line: self.line.name(), tries })
    }

    /// Continues after a reset by the watchdog or a brown-out, once a person has checked the device, held its enable
    /// button for half a second and released it, within half a minute. Pressing it again gives force.
    ///
    /// # Errors
    /// A line that broke, a device that is silent, or [`Error::Fault`] if another fault has stopped it.
    pub fn acknowledge(&mut self) -> Result<(), Error> {
        self.usable()?;
        self.view = None;
        let (began, mut is_asked) = (self.line.now(), false);
        while self.since(began) < STOPS || (is_asked && self.since(began) < CONFIRMED) {
            self.send(&HostMessage::Acknowledge)?;
            self.view = None;
            self.pause(ALIVE)?;
            if let Some((view, _)) = self.view {
                is_asked = view.hold & hold::CONFIRM != 0;
                if view.fault == 0 {
                    return Ok(());
                }
            }
        }
        match self.viewed_fault().or(self.recorded_fault()) {
            Some(fault) => Err(Error::Fault(fault)),
            None => Err(Error::Silent { line: self.line.name(), waited: self.since(began) }),
        }
    }

    /// The fault of the newest view.
    fn viewed_fault(&self) -> Option<Fault> {
        self.view.and_then(|(view, _)| Fault::from_code(view.fault))
    }

    /// The fault of the newest record.
    fn recorded_fault(&self) -> Option<Fault> {
        self.record.and_then(|record| Fault::from_code(record.fault))
    }
}
