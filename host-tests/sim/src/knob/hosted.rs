//! The knob's loop compiled for the host, at the simulated dial.

use super::{FROZEN, KnobServo, KnobState, MODULATION, widths};
use palpate::device::Counts;
use palpate::device::sensor::Frozen;
use palpate::servo::{Event, Input, ResetReason};
use palpate_sim::plant::Dial;

/// The loop and the dial that it turns.
#[derive(Clone, Debug)]
pub struct HostKnob {
    servo: KnobServo,
    state: KnobState,
    frozen: Frozen,
    /// The dial.
    pub dial: Dial,
    /// Whether force is asked for.
    pub enable: bool,
    /// Whether the sensor's frames come damaged.
    pub damaged: bool,
    /// Whether the host that watches, if the loop has one, is silent.
    pub silent: bool,
}

impl HostKnob {
    /// A loop before its first tick.
    pub fn new(servo: KnobServo, dial: Dial) -> Self {
        let state = servo.start();
        Self { servo, state, frozen: FROZEN, dial, enable: true, damaged: false, silent: false }
    }

    /// The same after another reset than power-on.
    pub fn reset_by(mut self, reason: ResetReason) -> Self {
        self.state = self.servo.start_after(reason);
        self
    }

    /// A tick of the loop, and a period of the dial.
    pub fn tick(&mut self) {
        self.note(Event::Supply { millivolts: (self.dial.supply_volts() * 1e3) as u32 });
        if !self.silent {
            self.note(Event::LinkAlive);
        }
        let input = match self.dial.counts() {
            Some(_) if self.damaged => Input::Damaged,
            Some(counts) if self.frozen.is_frozen(counts as u32) => Input::Damaged,
            Some(counts) => Input::Sensors { counts: [Counts(counts)], enable: self.enable },
            None => Input::Lost,
        };
        self.servo.tick(&mut self.state, input);
        self.give();
    }

    /// A period of the dial under what the loop now gives it.
    pub fn give(&mut self) {
        self.dial.advance(self.widths().map(|widths| widths.map(f64::from)));
    }

    /// The pulse widths; `None` disables the stage.
    pub fn widths(&self) -> Option<[f32; 3]> {
        widths(&self.servo, &self.state, &MODULATION)
    }

    /// Ticks.
    pub fn ticks(&mut self, ticks: u32) {
        (0..ticks).for_each(|_| self.tick());
    }

    /// Something happens between two ticks.
    pub fn note(&mut self, event: Event) {
        self.servo.note(&mut self.state, event);
    }

    /// Chooses what is felt.
    pub fn choose(&mut self, index: u8) {
        self.note(Event::Chosen { index });
    }

    /// The loop.
    pub const fn servo(&self) -> &KnobServo {
        &self.servo
    }

    /// Its state.
    pub const fn state(&self) -> &KnobState {
        &self.state
    }
}
