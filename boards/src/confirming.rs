//! A person at the device confirms what a host asks for: the enable button, held and then released.

use crate::Interlock;
use crate::interlock::ticks;
use crate::writing::{Word, Writing};
use palpate::wire::hold;

/// Seconds for which the button must be held without a break.
const HELD_S: f32 = 0.5;
/// Seconds after which a request that nobody confirmed is over.
const PATIENCE_S: f32 = 30.0;

/// Writes of flash between two resets: a page lasts for 10,000 (STM32G474 data sheet, "Flash memory endurance").
const MAX_WRITES: u8 = 32;

/// Something that a host cannot do without a person at the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// Enter commissioning mode.
    SetUp,
    /// Acknowledge a fault.
    Acknowledge,
    /// Write flash.
    Write,
}

/// The outcome of a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Confirmed just now.
    Confirmed(Asked),
    /// Nobody confirmed it in time.
    Expired(Asked),
}

/// A request that waits. While there is one the loop holds the motors off, so that the button asks for no force.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Confirming {
    asked: Option<Asked>,
    was_held: bool,
    /// Ticks until it is over.
    left: u32,
    held_ticks: u32,
    patience_ticks: u32,
    /// How often flash may still be written before the next reset.
    writes_left: u8,
}

impl Confirming {
    /// None, in a loop of `rate` Hz.
    pub const fn new(rate: f32) -> Self {
        let (held_ticks, patience_ticks) = (ticks(HELD_S, rate), ticks(PATIENCE_S, rate));
        Self { asked: None, was_held: false, left: 0, held_ticks, patience_ticks, writes_left: MAX_WRITES }
    }

    /// A host asks. The same again changes nothing; something else waits until this is over.
    pub const fn ask(&mut self, asked: Asked) {
        if self.asked.is_none() {
            (self.asked, self.was_held, self.left) = (Some(asked), false, self.patience_ticks);
        }
    }

    /// Whether something waits.
    pub const fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// Whatever waits is over with the next tick, held button or not.
    pub const fn cancel(&mut self) {
        (self.was_held, self.left) = (false, 1);
    }

    /// Main asks for flash: what holds the motors off meanwhile. `outcome` is that of this tick.
    #[inline]
    pub fn holds(
        &mut self,
        outcome: Option<Outcome>,
        writing: &Writing,
        (button, is_off): (&Interlock, bool),
        is_set_up: bool,
    ) -> u8 {
        let waits = matches!(writing.word(), Word::Asked | Word::AskedInSetUp);
        if !waits && self.asked == Some(Asked::Write) {
            // Main no longer wants to.
            self.asked = None;
        }
        match outcome {
            Some(Outcome::Confirmed(Asked::Write)) if waits => {
                self.writes_left = self.writes_left.saturating_sub(1);
                writing.put(Word::Granted);
            }
            Some(Outcome::Expired(Asked::Write)) if waits => writing.put(Word::NotConfirmed),
            // It waits for the person, who presses the button meanwhile.
            _ if waits && self.asked == Some(Asked::Write) => {}
            _ if waits => match writing.refusal(is_off && button.pressed() == 0, is_set_up) {
                Some(refusal) => writing.put(refusal),
                None if self.writes_left == 0 => writing.put(Word::Worn),
                // Until it was released for long enough main waits.
                None if button.is_released() => self.ask(Asked::Write),
                None => {}
            },
            _ => {}
        }
        let confirm = if self.is_asked() { hold::CONFIRM } else { 0 };
        if writing.is_granted() { confirm | hold::WRITING } else { confirm }
    }

    /// A tick, after the button was looked at.
    #[inline]
    pub const fn next(&mut self, button: &Interlock) -> Option<Outcome> {
        let Some(asked) = self.asked else { return None };
        self.was_held |= button.pressed() >= self.held_ticks;
        self.left = self.left.saturating_sub(1);
        if self.was_held && button.is_released() {
            self.asked = None;
            return Some(Outcome::Confirmed(asked));
        }
        if self.left == 0 {
            self.asked = None;
            return Some(Outcome::Expired(asked));
        }
        None
    }
}
