//! A button that chooses the next feel.

use embedded_hal::digital::InputPin;
use palpate_bench::knob::FEELS;
use palpate_bench::{Counter, Mailbox};
use palpate_stm32g4::{CLOCK, Clock};

/// How long a press must last to count, in counts of the clock: 20 ms.
const STEADY: u32 = CLOCK / 50;

/// The button, a contact to ground, and where it has come to.
pub struct Choice<P> {
    pin: P,
    clock: Clock,
    /// Since when the pin has been as it is, and how.
    since: u32,
    low: bool,
    /// Whether this press has counted.
    counted: bool,
    index: u8,
}

impl<P: InputPin> Choice<P> {
    /// Of this pin, which is pulled up.
    pub fn new(pin: P, clock: Clock) -> Self {
        // A button that is held from the start chooses nothing.
        Self { pin, since: clock.now(), clock, low: true, counted: true, index: 0 }
    }

    /// Looks at it, and puts what was chosen into the mailbox.
    pub fn look(&mut self, mailbox: &Mailbox) {
        let low = self.pin.is_low().unwrap_or(false);
        let now = self.clock.now();
        if low != self.low {
            (self.low, self.since) = (low, now);
            return;
        }
        if now.wrapping_sub(self.since) < STEADY {
            return;
        }
        if !low {
            self.counted = false;
        } else if !self.counted {
            self.counted = true;
            self.index = (self.index + 1) % FEELS.len() as u8;
            mailbox.choose(self.index);
        }
    }
}
