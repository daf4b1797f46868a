//! A brake chopper: burns what a braking hand pumps into the supply, in a resistor.

use crate::Supply;
use embedded_hal::digital::{OutputPin, PinState};

/// A resistor across the supply, and when it is switched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChopperSettings {
    /// The voltage from which on it burns, V: below the maximum of the supply's range.
    pub on_v: f32,
    /// The voltage below which it stops, V: above the supply's own.
    pub off_v: f32,
    /// Ω.
    pub resistance_ohm: f32,
    /// Continuous power of the resistor, W.
    pub continuous_w: f32,
    /// Energy above that which it takes at once, J.
    pub energy_j: f32,
}

/// The switch's state, tick by tick.
///
/// It works in every phase of the loop, by the measured supply alone. Without a measurement it is off, and so it is
/// once its resistor has taken its energy, until half of that is gone: the supply then rises to the maximum of its
/// range, where the motors are held off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chopper {
    settings: ChopperSettings,
    period: f32,
    is_on: bool,
    is_spent: bool,
    /// Energy that is still in the resistor, J.
    taken_j: f32,
    /// The last measurement, V.
    last_v: f32,
}

impl Chopper {
    /// A switch that is looked at `rate` times a second.
    ///
    /// # Panics
    /// At compile time, for settings that are not positive and finite, or voltages out of order.
    pub const fn new(settings: ChopperSettings, rate: f32) -> Self {
        let ChopperSettings { on_v, off_v, resistance_ohm, continuous_w, energy_j } = settings;
        let is_valid = 0.0 < off_v
            && off_v < on_v
            && on_v < f32::INFINITY
            && 0.0 < resistance_ohm
            && resistance_ohm < f32::INFINITY
            && 0.0 < continuous_w
            && continuous_w < f32::INFINITY
            && 0.0 < energy_j
            && energy_j < f32::INFINITY
            && rate >= 1.0;
        assert!(is_valid, "a chopper needs off_v below on_v, and a resistance, a power and an energy above zero");
        Self { settings, period: 1.0 / rate, is_on: false, is_spent: false, taken_j: 0.0, last_v: 0.0 }
    }

    /// Whether it burns until the next tick.
    #[inline]
    pub fn next(&mut self, volts: Option<f32>) -> bool {
        let ChopperSettings { on_v, off_v, resistance_ohm, continuous_w, energy_j } = self.settings;
        let volts = volts.filter(|volts| volts.is_finite()).unwrap_or(0.0);
        let highest = if volts > self.last_v { volts } else { self.last_v };
        self.last_v = volts;
        let burnt = if self.is_on { highest * highest / resistance_ohm } else { 0.0 };
        let taken = self.taken_j + (burnt - continuous_w) * self.period;
        self.taken_j = if taken > 0.0 { taken } else { 0.0 };
        self.is_spent = self.taken_j >= if self.is_spent { 0.5 * energy_j } else { energy_j };
        self.is_on = !self.is_spent && volts > if self.is_on { off_v } else { on_v };
        self.is_on
    }
}

/// A measured supply with a chopper on a pin that is high while it burns. Pull the pin down: it floats until the
/// program starts. A program that hangs leaves it as it is until the watchdog resets the chip.
#[derive(Debug)]
pub struct Chopped<V, P> {
    supply: V,
    pin: P,
    chopper: Chopper,
}

impl<V, P> Chopped<V, P> {
    /// This supply, with the pin low.
    pub const fn new(supply: V, pin: P, chopper: Chopper) -> Self {
        Self { supply, pin, chopper }
    }
}

impl<V: Supply, P: OutputPin> Supply for Chopped<V, P> {
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let volts = self.supply.volts();
        // A pin that fails leaves the supply to its hold.
        let _ = self.pin.set_state(PinState::from(self.chopper.next(volts)));
        volts
    }
}
