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
    /// The drive's command, as a duty, for a duty of torque at a joint rate, rad/s.
    #[inline]
    pub fn command(&self, torque: Duty, joint_rate: f32) -> Duty {
        match self {
            Self::Current => torque,
            Self::Voltage(feed) => feed.command(torque, joint_rate),
        }
    }
}

/// A brushed motor on a voltage, or one with three phases as its rotor sees it: `V = R i + k N q̇`, with the back-EMF
/// constant equal to the torque constant `k` (SI).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoltageFeed {
    /// Voltage at full duty of the bridge, V.
    pub supply_v: f32,
    /// Resistance of winding, brushes and bridge, `R`, ohms.
    pub resistance_ohm: f32,
    /// Torque constant, `k`, N·m/A, which is the back-EMF constant in V·s/rad.
    pub torque_constant_n_m_per_a: f32,
    /// Current at full duty of torque, A.
    pub current_at_full_a: f32,
    /// Turns of the motor for one of the joint, `N`; negative where it turns the other way.
    pub ratio: f32,
    /// The compensated fraction of the back-EMF, 0 to 1. Below 1, so that an error in `k` or in the rate cannot
    /// accelerate the motor; the uncompensated rest brakes.
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
    pub const fn three_phase(supply: f32, phase_resistance: f32, rpm_per_volt: f32, current_at_full: f32) -> Self {
        Self {
            supply_v: supply * core::f32::consts::FRAC_1_SQRT_2,
            resistance_ohm: phase_resistance,
            torque_constant_n_m_per_a: 30.0 / (core::f32::consts::PI * rpm_per_volt) * core::f32::consts::FRAC_1_SQRT_2,
            current_at_full_a: current_at_full,
            ratio: 1.0,
            back_emf_fraction: 0.8,
        }
    }

    /// The bridge's duty for a duty of torque at a joint rate, rad/s. Beyond the supply it is full scale; at a rate
    /// that is not finite it is zero. The inductance is left out: it delays the torque by L/R, about one tick.
    #[inline]
    pub fn command(&self, torque: Duty, joint_rate: f32) -> Duty {
        if !joint_rate.is_finite() {
            return Duty::ZERO;
        }
        let current = torque.fraction() * self.current_at_full_a;
        let back_emf = self.torque_constant_n_m_per_a * self.ratio * joint_rate * self.back_emf_fraction;
        Duty::from_fraction((self.resistance_ohm * current + back_emf) / self.supply_v)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FEED: VoltageFeed = VoltageFeed {
        supply_v: 12.0,
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
            let duty = FEED.command(Duty::from_fraction(torque), rate);
            assert!((duty.fraction() * 12.0 - volts).abs() < 1e-3, "{torque} {rate}: {duty:?}");
        }
    }

    #[test]
    fn what_the_supply_cannot_give_saturates_and_what_is_not_finite_is_nothing() {
        assert_eq!(FEED.command(Duty::FULL, -100.0), Duty::FULL);
        for rate in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            assert_eq!(FEED.command(Duty::FULL, rate), Duty::ZERO);
        }
        assert_eq!(Feed::Current.command(Duty(123), f32::NAN), Duty(123));
    }
}
