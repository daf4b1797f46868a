//! The knob's loop compiled for the host, at the simulated dial.

use crate::plant::{Dial, DialSettings, Fingers};
use palpate::device::sensor::Frozen;
use palpate::device::{CoggingMap, Counts};
use palpate::servo::{Event, Input, Phase, ResetReason};
use palpate_bench::knob::{KnobServo, KnobState, MODULATION, SEARCH, SETTINGS, TOLD_OF_SUPPLY, device, servo, widths};

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
        Self { servo, state, frozen: Frozen::AS5047P, dial, enable: true, damaged: false, silent: false }
    }

    /// The loop of the boards at a dial, before its first tick. The device lives as long as the program.
    pub fn at(dial: DialSettings, cogging: Option<CoggingMap>) -> Self {
        let servo = servo(Box::leak(Box::new(device(cogging))), SEARCH, TOLD_OF_SUPPLY);
        Self::new(servo, Dial::new(dial, f64::from(SETTINGS.rate_hz)))
    }

    /// As [`HostKnob::at`], once its rotor is aligned and its force has faded in.
    ///
    /// # Panics
    /// If it does not run by then.
    #[track_caller]
    pub fn running(dial: DialSettings, cogging: Option<CoggingMap>) -> Self {
        let mut knob = Self::at(dial, cogging);
        knob.ticks(SEARCH.ticks() + 2_000);
        let found = (knob.state.phase(), knob.state.fault());
        assert_eq!(found, (Phase::Running, None), "{:?}", knob.state.homing().refusal());
        knob
    }

    /// The torque on the shaft, N·m, where a clamp holds it at an angle, radians: it is brought there in 400 ticks, rests
    /// for 400, and the torque is the mean of 100 more.
    ///
    /// # Panics
    /// If the loop has faulted meanwhile.
    pub fn held_at(&mut self, angle: f64) -> f64 {
        let from = self.dial.angle();
        for tick in 1..=400 {
            self.dial.hold(Fingers::clamp(from + (angle - from) * f64::from(tick) / 400.0));
            self.tick();
        }
        self.ticks(400);
        let mut sum = 0.0;
        for _ in 0..100 {
            self.tick();
            sum += self.dial.torque();
        }
        assert_eq!(self.state.fault(), None);
        sum / 100.0
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
            Some(_) if self.dial.has_lost_magnet() => Input::Magnet,
            Some(counts) if self.frozen.is_frozen(counts as u32) => Input::Frozen,
            Some(counts) => Input::Sensors { counts: [Counts(counts)], enable: self.enable },
            None => Input::Lost,
        };
        let _ = self.servo.tick(&mut self.state, input);
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

    /// Chooses the feel.
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
