//! The drive's command for a requested torque.

use crate::device::Duty;

/// How a motor is fed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Feed {
    /// An amplifier that controls the current: its set-point is the duty of torque itself.
    Current,
    /// A bridge that gives a voltage.
    Voltage(VoltageFeed),
}

impl Feed {
    /// The drive's command, as a duty, for a duty of torque at a joint rate, rad/s, on this supply.
    #[inline]
    pub fn command(&self, torque: Duty, joint_rate: f32, supply: Supply) -> Duty {
        match self {
            Self::Current => torque,
            Self::Voltage(feed) => feed.command(torque, joint_rate, supply),
        }
    }
}

/// The motors' supply as a bridge's feed knows it, low-pass filtered over 16 measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Supply {
    /// V; 0 before the first measurement.
    filtered_v: f32,
    /// Ticks since the last measurement.
    age: u32,
}

impl Supply {
    /// Never measured: each feed counts on its own constant, so the supply must be a regulated one.
    pub const UNMEASURED: Self = Self { filtered_v: 0.0, age: 0 };
    /// Ticks for which a measurement holds: 0.1 s at 4 kHz, less in a faster loop, where the force is then lowered sooner.
    const FRESH_TICKS: u32 = 400;
    /// Share of the way to a new measurement.
    const SHARE: f32 = 1.0 / 16.0;
    /// The minimum fraction of a feed's constant that is plausible as a supply.
    const PLAUSIBLE: f32 = 0.5;
    /// The minimum fraction that is compensated: a lower supply gives less force.
    const LEAST: f32 = 0.8;
    /// The fraction assumed for a supply that is not known: the highest, which gives the lowest force.
    const MOST: f32 = 1.3;

    /// A measurement, V.
    #[inline]
    pub fn measured(&mut self, volts: f32) {
        self.age = 0;
        let last = self.filtered_v;
        let is_going_on = last > f32::MIN_POSITIVE && last < f32::INFINITY;
        let next = if is_going_on { last + Self::SHARE * (volts - last) } else { volts };
        // False for NaN. Zero would be a supply that was never measured.
        self.filtered_v = if next > f32::MIN_POSITIVE { next } else { f32::MIN_POSITIVE };
    }

    /// A tick has passed.
    #[inline]
    pub const fn tick(&mut self) {
        if self.filtered_v != 0.0 {
            self.age = self.age.saturating_add(1);
        }
    }

    /// The supply over a feed's constant. A stale or implausible measurement, also NaN and zero, is replaced by a high
    /// supply: the force is then the lowest.
    #[inline]
    fn over(&self, nominal: f32) -> f32 {
        if self.filtered_v == 0.0 {
            return 1.0;
        }
        let ratio = self.filtered_v / nominal;
        // False for NaN.
        let is_known = ratio >= Self::PLAUSIBLE && self.age <= Self::FRESH_TICKS;
        if is_known { if ratio > Self::LEAST { ratio } else { Self::LEAST } } else { Self::MOST }
    }

    /// Its words, for a hash.
    pub(crate) fn words(&self) -> [u32; 2] {
        [self.filtered_v.to_bits(), self.age]
    }
}

/// A brushed motor on a voltage, or one with three phases as its rotor sees it: `V = R i + k N q̇`, with the back-EMF
/// constant equal to the torque constant `k` (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoltageFeed {
    /// The supply, V: what its measurement should read ([`Supply`]).
    pub supply_v: f32,
    /// Voltage at full duty of the bridge, as a fraction of the supply: 1 for a bridge.
    pub full_fraction: f32,
    /// Resistance of winding, brushes and bridge, `R`, ohms.
    pub resistance_ohm: f32,
    /// Torque constant, `k`, N·m/A, which is the back-EMF constant in V·s/rad.
    pub torque_constant_n_m_per_a: f32,
    /// Current at full duty of torque, A.
    pub current_at_full_a: f32,
    /// Turns of the motor for one of the joint, `N`; negative where it turns the other way.
    pub ratio: f32,
    /// The compensated fraction `β` of the back-EMF, 0 to 1; the uncompensated rest brakes. Times `k` as stated over the
    /// real one it must stay below 1, or a motor without friction drives itself once it turns: 0.8 bears a `k` stated a
    /// quarter too high.
    pub back_emf_fraction: f32,
}

impl VoltageFeed {
    /// The feed of a motor with three phases on a [`super::ThreePhase`] stage.
    ///
    /// Seen from its rotor such a motor is a brushed one: `v = R i + k ω` and `τ = k i` across the magnets, with the
    /// scale of Park's transformation that keeps the power (R. H. Park, *Two-reaction theory of synchronous machines*,
    /// 1929). In that scale the stage's full voltage is `supply/√2`, and `phase_resistance` is that of one phase: half
    /// of the resistance measured between two wires. `k` follows from `rpm_per_volt` (KV), the speed at which the
    /// turned motor generates one volt between two wires: `k = 30/(π KV √2)`. Along the magnets there is no voltage,
    /// and at a dial's speeds next to no current either.
    ///
    /// Six tenths of the back-EMF are compensated: sellers round `rpm_per_volt`, and warm magnets are weaker.
    pub const fn three_phase(supply: f32, phase_resistance: f32, rpm_per_volt: f32, current_at_full: f32) -> Self {
        Self {
            supply_v: supply,
            full_fraction: core::f32::consts::FRAC_1_SQRT_2,
            resistance_ohm: phase_resistance,
            torque_constant_n_m_per_a: 30.0 / (core::f32::consts::PI * rpm_per_volt) * core::f32::consts::FRAC_1_SQRT_2,
            current_at_full_a: current_at_full,
            ratio: 1.0,
            back_emf_fraction: 0.6,
        }
    }

    /// Voltage at full duty on the constant supply, V.
    pub const fn full_v(&self) -> f32 {
        self.supply_v * self.full_fraction
    }

    /// The bridge's duty for a duty of torque at a joint rate, rad/s, on this supply. Beyond the supply it is full
    /// scale; at a rate that is not finite it is zero. The inductance is left out: it delays the torque by L/R, about
    /// one tick.
    #[inline]
    pub fn command(&self, torque: Duty, joint_rate: f32, supply: Supply) -> Duty {
        if !joint_rate.is_finite() {
            return Duty::ZERO;
        }
        let current = torque.fraction() * self.current_at_full_a;
        let back_emf = self.torque_constant_n_m_per_a * self.ratio * joint_rate * self.back_emf_fraction;
        let full = self.full_v() * supply.over(self.supply_v);
        Duty::from_fraction((self.resistance_ohm * current + back_emf) / full)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEED: VoltageFeed = VoltageFeed {
        supply_v: 12.0,
        full_fraction: 1.0,
        resistance_ohm: 5.0,
        torque_constant_n_m_per_a: 0.05,
        current_at_full_a: 2.0,
        ratio: -10.0,
        back_emf_fraction: 1.0,
    };

    #[test]
    fn voltage_makes_up_for_resistance_and_back_emf() {
        // 5 Ω · 1 A, and −10 · 0.05 V·s/rad · 4 rad/s.
        for (torque, rate, volts) in [(0.5, 0.0, 5.0), (0.0, 4.0, -2.0), (0.5, 4.0, 3.0), (-1.0, 0.0, -10.0)] {
            let duty = FEED.command(Duty::from_fraction(torque), rate, Supply::UNMEASURED);
            assert!((duty.fraction() * 12.0 - volts).abs() < 1e-3, "{torque} {rate}: {duty:?}");
        }
    }

    #[test]
    fn what_the_supply_cannot_give_saturates_and_what_is_not_finite_is_nothing() {
        assert_eq!(FEED.command(Duty::FULL, -100.0, Supply::UNMEASURED), Duty::FULL);
        for rate in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(FEED.command(Duty::FULL, rate, Supply::UNMEASURED), Duty::ZERO);
        }
        assert_eq!(Feed::Current.command(Duty(123), f32::NAN, Supply::UNMEASURED), Duty(123));
    }

    /// The supply after many measurements of the same voltage.
    fn settled(volts: f32) -> Supply {
        let mut supply = Supply::UNMEASURED;
        supply.measured(FEED.supply_v);
        (0..1_000).for_each(|_| supply.measured(volts));
        supply
    }

    #[test]
    fn the_motor_has_the_current_that_was_asked_for_on_any_supply_that_can_give_it() {
        // u d = R i + N k q̇ at the bridge, whatever u is.
        for volts in [9.7_f32, 11.0, 12.0, 14.95, 20.0, 40.0] {
            for (torque, rate) in [(0.5, 0.0), (-0.25, 3.0), (0.6, -2.0)] {
                let duty = FEED.command(Duty::from_fraction(torque), rate, settled(volts));
                let given = f64::from(volts) * f64::from(duty.fraction());
                let wanted = 5.0 * 2.0 * f64::from(torque) - 0.05 * 10.0 * f64::from(rate);
                // Half a step of the duty, of both.
                assert!((given - wanted).abs() < 40.0 / 32_767.0, "{volts} {torque} {rate}: {given} {wanted}");
            }
        }
        // 3 A through 2 ohms on a supply of 24 V that is at 29.9 V; by the constant it was 3.74 A.
        let feed = VoltageFeed { supply_v: 24.0, resistance_ohm: 2.0, current_at_full_a: 3.0, ..FEED };
        let current = feed.command(Duty::FULL, 0.0, settled(29.9)).fraction() * 29.9 / 2.0;
        assert!((current - 3.0).abs() < 1e-3, "{current} A");
    }

    #[test]
    fn a_supply_that_is_not_known_gives_the_least_force_and_a_low_one_is_made_up_for_within_bounds() {
        let command = |supply| FEED.command(Duty::from_fraction(0.5), 0.0, supply).fraction();
        let constant = command(Supply::UNMEASURED);
        let over = |supply| command(supply) / constant;
        let mut stale = settled(12.0);
        (0..=Supply::FRESH_TICKS).for_each(|_| stale.tick());
        for (supply, expected) in [
            (settled(12.0), 1.0),
            (settled(8.0), 1.25),
            (settled(0.0), 1.0 / 1.3),
            (
                (0..5_000).fold(settled(0.0), |mut supply, _| {
                    supply.measured(0.0);
                    supply
                }),
                1.0 / 1.3,
            ),
            (settled(-24.0), 1.0 / 1.3),
            (settled(f32::NAN), 1.0 / 1.3),
            (settled(f32::INFINITY), 0.0),
            (settled(f32::MAX), 0.0),
            (stale, 1.0 / 1.3),
        ] {
            assert!((over(supply) - expected).abs() < 1e-4, "{supply:?}: {} {expected}", over(supply));
        }
        stale.measured(12.0);
        assert!((over(stale) - 1.0).abs() < 1e-4, "a measurement that is back counts again");
    }

    #[test]
    fn a_spike_of_one_measurement_moves_the_force_by_a_sixteenth_of_it() {
        let mut supply = settled(12.0);
        supply.measured(16.0);
        let duty = FEED.command(Duty::from_fraction(0.5), 0.0, supply).fraction();
        assert!((f64::from(duty) - 5.0 / 12.25).abs() < 1e-4, "{duty}");
    }
}
