//! A knob: its feel, part by part, and its dial.

use crate::stopping::CONFIRMED;
use crate::{Device, Error, Line, SILENCE, TRIES};
use palpate::render::{Detents, Ends, FeelPart};
use palpate::scene::Command;
use palpate::servo::DAMPING_PER_STIFFNESS_S;
use palpate::wire::{Dial, HostMessage, hold};
use std::time::Duration;

/// Detents of a dial that snap: a pitch apart, rad, numbered from the first to the last. Each pulls back with up to the
/// torque, N·m, which it has where the next one takes over, `snap` pitches off; the springs beyond the outer ones are
/// four times as stiff. Without a damping, N·m·s/rad, as much as the device asks for.
pub fn clicks(
    pitch_rad: f32,
    torque_n_m: f32,
    [first, last]: [i32; 2],
    snap: f32,
    damping_n_m_s_per_rad: Option<f32>,
) -> Detents {
    let stiffness = torque_n_m / (snap * pitch_rad);
    let wall_stiffness = 4.0 * stiffness;
    let damping = damping_n_m_s_per_rad.unwrap_or(DAMPING_PER_STIFFNESS_S * wall_stiffness);
    Detents { pitch: pitch_rad, stiffness, damping, snap, first, last, wall_stiffness, max_force: torque_n_m }
}

/// End stops of a dial between two angles. Without a damping, N·m·s/rad, 0.001, or as much as the device asks for.
pub fn ends(between_rad: [f32; 2], stiffness_n_m_per_rad: f32, damping_n_m_s_per_rad: Option<f32>) -> Ends {
    let damping_n_m_s_per_rad =
        damping_n_m_s_per_rad.unwrap_or((DAMPING_PER_STIFFNESS_S * stiffness_n_m_per_rad).max(1e-3));
    Ends { between_rad, stiffness_n_m_per_rad, damping_n_m_s_per_rad }
}

impl<L: Line> Device<L> {
    /// Sets a part of the knob's feel. The first part that is set changes a copy of the feel that is active; the old
    /// torque is let go of without a step.
    ///
    /// # Errors
    /// As [`Self::order`]. [`palpate::servo::KnobError`] has the sum of the parts and the limit of the motor.
    pub fn feel(&mut self, part: FeelPart) -> Result<(), Error> {
        self.order(Command::Feel(part))
    }

    /// Asks the knob to store the feel that was set in its flash, or to clear the stored one, and waits for the outcome;
    /// used from the next reset on. The motor must be off and the enable button released. Once the device asks for it,
    /// `confirm` is called, which tells a person to hold the button for half a second and to release it, within half a
    /// minute.
    ///
    /// # Errors
    /// As [`Self::order`]. A board without flash for it refuses at once.
    pub fn keep_feel(&mut self, keeps: bool, mut confirm: impl FnMut()) -> Result<(), Error> {
        self.usable()?;
        let asked = if keeps { "keep-feel" } else { "forget-feel" };
        let (views, mut is_asked) = (self.views, false);
        let meanwhile = |device: &Self| {
            let asks = device.views > views && device.view.is_some_and(|(view, _)| view.hold & hold::CONFIRM != 0);
            if asks && !std::mem::replace(&mut is_asked, asks) {
                confirm();
            }
        };
        let command = |number| HostMessage::KeepFeel { number, keeps };
        let refused = self.ask_while(asked, (TRIES, CONFIRMED / TRIES), command, meanwhile)?;
        refused.map_or(Ok(()), |reason| Err(Error::Refused { asked, reason }))
    }

    /// The dial: what came newest, [`palpate::wire::DIALS_HZ`] times a second. Without a new one since the last call
    /// this waits for up to `wait`, and then returns the last one.
    ///
    /// # Errors
    /// As [`Self::view`]; a device that is no knob is silent.
    pub fn dial(&mut self, wait: Duration) -> Result<Dial, Error> {
        let (began, dials) = (self.line.now(), self.dials);
        let wait = if self.dial.is_none() { wait.max(SILENCE) } else { wait };
        self.drain()?;
        while self.dials == dials && self.since(began) < wait {
            self.hear(wait.saturating_sub(self.since(began)))?;
        }
        self.usable()?;
        match self.dial {
            Some((dial, at)) if self.since(at) <= SILENCE => Ok(dial),
            Some((_, at)) => Err(Error::Silent { line: self.line.name(), waited: self.since(at) }),
            None => Err(Error::Silent { line: self.line.name(), waited: self.since(began) }),
        }
    }

    /// All reports of the dial that came since the last call, in their order; the first call starts to keep them.
    pub fn take_dials(&mut self) -> Vec<Dial> {
        self.all_dials.replace(Vec::new()).unwrap_or_default()
    }

    /// How many times the knob has told of its dial.
    pub const fn dials(&self) -> u64 {
        self.dials
    }
}
