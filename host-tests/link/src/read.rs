//! Reading the loop's state.

use crate::{Device, Error, Line};
use palpate::servo::{Fault, Phase};
use palpate::track::Contact;
use palpate::wire::{Modes, Record, View};
use std::time::Duration;

/// A device whose newest view is older than this has fallen silent.
pub const SILENCE: Duration = Duration::from_millis(250);

impl<L: Line> Device<L> {
    /// The newest view of the loop. Without a new one since the last call this waits for up to `wait`, and then returns
    /// the last one. Only the first one after a greeting may take longer.
    ///
    /// # Errors
    /// A line that broke, a device that has been silent for [`SILENCE`], was reset, or is in commissioning mode.
    pub fn view(&mut self, wait: Duration) -> Result<View, Error> {
        let (began, views) = (self.line.now(), self.views);
        // The first one of all is on its way.
        let wait = if self.view.is_none() { wait.max(SILENCE) } else { wait };
        self.drain()?;
        while self.views == views && self.since(began) < wait {
            self.hear(wait.saturating_sub(self.since(began)))?;
        }
        self.usable()?;
        match self.view {
            Some((view, at)) if self.since(at) <= SILENCE => Ok(view),
            Some((_, at)) => Err(Error::Silent { line: self.line.name(), waited: self.since(at) }),
            None => Err(Error::Silent { line: self.line.name(), waited: self.since(began) }),
        }
    }

    /// All views that came since the last call, in their order; the first call starts to keep them. Call it at least
    /// every 16 s.
    pub fn take_views(&mut self) -> Vec<View> {
        self.all_views.replace(Vec::new()).unwrap_or_default()
    }

    /// The newest that has come; waits only where there is none, or none of late.
    fn newest(&mut self) -> Result<View, Error> {
        self.drain()?;
        let wait = match self.view {
            Some((_, at)) if self.since(at) <= SILENCE => Duration::ZERO,
            _ => SILENCE,
        };
        self.view(wait)
    }

    /// Where the tool's tip is, metres, in the scene's frame.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn position(&mut self) -> Result<[f32; 3], Error> {
        Ok(self.newest()?.position)
    }

    /// Its velocity, m/s.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn velocity(&mut self) -> Result<[f32; 3], Error> {
        Ok(self.newest()?.velocity)
    }

    /// The force on the hand, N: that of the bodies plus the host's own, as applied to the motors.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn force(&mut self) -> Result<[f32; 3], Error> {
        Ok(self.newest()?.force)
    }

    /// The foremost body, by its index in the scene: the one in contact, or the nearest.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn body(&mut self) -> Result<u8, Error> {
        Ok(self.newest()?.body)
    }

    /// From the tool to that body, metres; negative while it is pressed in.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn gap(&mut self) -> Result<f32, Error> {
        Ok(self.newest()?.gap)
    }

    /// Whether it is touched.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn contact(&mut self) -> Result<Contact, Error> {
        let number = self.newest()?.contact;
        Ok(Contact::ALL.into_iter().find(|contact| *contact as u8 == number).unwrap_or_default())
    }

    /// The modes of the foremost body: what came newest, [`palpate::wire::MODES_HZ`] times a second. None where it does
    /// not deform.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn modes(&mut self) -> Result<Option<Modes>, Error> {
        self.newest()?;
        Ok(self.modes.filter(|(_, at)| self.since(*at) <= SILENCE).map(|(modes, _)| modes))
    }

    /// The phase of the loop.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn phase(&mut self) -> Result<Phase, Error> {
        let number = self.newest()?.phase;
        Ok(Phase::ALL.into_iter().find(|phase| *phase as u8 == number).unwrap_or_default())
    }

    /// The fault that stopped the loop, if any.
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn fault(&mut self) -> Result<Option<Fault>, Error> {
        Ok(Fault::from_code(self.newest()?.fault))
    }

    /// External reasons that keep the motors off, as the bits of [`palpate::wire::hold`].
    ///
    /// # Errors
    /// As [`Self::view`].
    pub fn hold(&mut self) -> Result<u8, Error> {
        Ok(self.newest()?.hold)
    }

    /// The last record of the loop's timing that came, if one has.
    pub const fn record(&self) -> Option<Record> {
        self.record
    }
}
