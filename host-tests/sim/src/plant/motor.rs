//! Motors on their amplifiers: a duty becomes, some time later, a current and a torque.

use super::vector::Vector;
use std::collections::VecDeque;

/// A winding on a supply.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Winding {
    /// The most voltage either way, V.
    pub supply: f64,
    /// Ω.
    pub resistance: f64,
    /// H; zero means that the current follows the voltage at once.
    pub inductance: f64,
}

/// Amplifier that turns the duty into a current.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amplifier {
    /// A current loop that never runs out of voltage.
    Current,
    /// A current loop on a supply: at speed, back-EMF leaves it less current.
    CurrentOn(Winding),
    /// A bridge: the duty is a voltage, `L di/dt = V − R i − k N q̇`.
    Voltage(Winding),
}

/// An amplifier and its motor, seen at the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// The amplifier of the winding.
    pub amplifier: Amplifier,
    /// Current at full duty, A.
    pub current_at_full: f64,
    /// Maximum current of the amplifier, A.
    pub current_limit: f64,
    /// Joint torque per ampere, N·m/A, and back-EMF per joint rate, V·s/rad; negative where the motor turns the joint
    /// the other way.
    pub torque_per_ampere: f64,
}

impl Motor {
    /// The current the amplifier aims at, A.
    pub fn aim(&self, duty: i16) -> f64 {
        let current = f64::from(duty) / 32_767.0 * self.current_at_full;
        current.clamp(-self.current_limit, self.current_limit)
    }

    /// The current it settles to at a joint rate, rad/s, A: on a bridge back-EMF takes its part.
    pub fn settled(&self, duty: i16, rate: f64) -> f64 {
        let Amplifier::Voltage(Winding { supply, resistance, .. }) = self.amplifier else { return self.aim(duty) };
        let voltage = f64::from(duty) / 32_767.0 * supply - self.torque_per_ampere * rate;
        (voltage / resistance).clamp(-self.current_limit, self.current_limit)
    }

    /// The current after a step of `period` s from `before`, under a duty at a joint rate, rad/s. `left_over` is how
    /// much of the distance to its aim a current loop leaves after the step.
    fn next(&self, before: f64, duty: i16, rate: f64, period: f64, left_over: f64) -> f64 {
        let back_emf = self.torque_per_ampere * rate;
        let chase = |aim: f64| aim + (before - aim) * left_over;
        match self.amplifier {
            Amplifier::Current => chase(self.aim(duty)),
            Amplifier::CurrentOn(Winding { supply, resistance, .. }) => {
                chase(self.aim(duty).clamp((-supply - back_emf) / resistance, (supply - back_emf) / resistance))
            }
            Amplifier::Voltage(Winding { supply, resistance, inductance }) => {
                let voltage = f64::from(duty) / 32_767.0 * supply - back_emf;
                // The trapezoidal rule; without inductance Ohm's law.
                let current = if inductance > 0.0 {
                    let inert = 2.0 * inductance / period;
                    (before * (inert - resistance) + 2.0 * voltage) / (inert + resistance)
                } else {
                    voltage / resistance
                };
                current.clamp(-self.current_limit, self.current_limit)
            }
        }
    }
}

/// The three drives: transport delay, then the amplifiers.
#[derive(Clone, Debug)]
pub struct Drives {
    motors: [Motor; 3],
    /// Commands under way, and the sub-step at which each arrives.
    under_way: VecDeque<(u64, [i16; 3])>,
    delay: u64,
    /// How much of the distance to the aim is left after a sub-step.
    left_over: f64,
    sub_step: f64,
    duties: [i16; 3],
    currents: Vector,
}

impl Drives {
    /// Drives at rest. `delay` counts sub-steps; `time_constant` and `sub_step` are in s.
    pub fn new(motors: [Motor; 3], delay: u64, time_constant: f64, sub_step: f64) -> Self {
        // The trapezoidal rule for i' = (aim − i)/τ, off by (h/τ)³/12 a step; without a time constant the aim is met at
        // once.
        let left_over = ((2.0 * time_constant - sub_step) / (2.0 * time_constant + sub_step)).max(0.0);
        let under_way = VecDeque::new();
        Self { motors, under_way, delay, left_over, sub_step, duties: [0; 3], currents: [0.0; 3] }
    }

    /// Takes a command at sub-step `now`.
    pub fn command(&mut self, now: u64, duties: [i16; 3]) {
        self.under_way.push_back((now + self.delay, duties));
    }

    /// The joint torques over sub-step `now`, N·m: those of the mean of the currents at its two ends. `rates` are the
    /// joints' at its start, rad/s.
    pub fn step(&mut self, now: u64, rates: Vector) -> Vector {
        while let Some(&(arrival, duties)) = self.under_way.front()
            && arrival <= now
        {
            self.under_way.pop_front();
            self.duties = duties;
        }
        core::array::from_fn(|joint| {
            let before = self.currents[joint];
            let motor = &self.motors[joint];
            let after = motor.next(before, self.duties[joint], rates[joint], self.sub_step, self.left_over);
            self.currents[joint] = after;
            0.5 * (before + after) * self.motors[joint].torque_per_ampere
        })
    }

    /// The motor currents, A.
    pub fn currents(&self) -> Vector {
        self.currents
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOTOR: Motor =
        Motor { amplifier: Amplifier::Current, current_at_full: 3.0, current_limit: 2.0, torque_per_ampere: -0.4 };
    const STILL: Vector = [0.0; 3];

    #[test]
    fn a_command_arrives_after_its_delay_and_not_a_sub_step_sooner() {
        for delay in [0, 10, 20, 40] {
            let mut drives = Drives::new([MOTOR; 3], delay, 0.0, 1e-5);
            drives.command(0, [16_384, 0, 0]);
            let first = (0..100).find(|now| drives.step(*now, STILL)[0] != 0.0);
            assert_eq!(first, Some(delay));
        }
    }

    #[test]
    fn every_command_is_held_for_its_own_period() {
        let mut drives = Drives::new([MOTOR; 3], 15, 0.0, 1e-5);
        let mut trace = Vec::new();
        for now in 0..60 {
            if now % 10 == 0 {
                drives.command(now, [(now * 100) as i16, 0, 0]);
            }
            drives.step(now, STILL);
            trace.push((drives.currents()[0] * 32_767.0 / 3.0).round() as u64);
        }
        let expected: Vec<u64> = (0..60).map(|now: u64| now.saturating_sub(15) / 10 * 1_000).collect();
        assert_eq!(trace, expected);
    }

    #[test]
    fn current_rises_exponentially() {
        let (time_constant, step) = (1.5e-4, 1.25e-5);
        let mut drives = Drives::new([MOTOR; 3], 0, time_constant, step);
        drives.command(0, [10_000, 0, 0]);
        for now in 0..100 {
            drives.step(now, STILL);
            let elapsed = step * (now + 1) as f64;
            let expected = MOTOR.aim(10_000) * (1.0 - (-elapsed / time_constant).exp());
            // The rule's error sums to (h/τ)²/12 · (t/τ) e^(−t/τ) ≤ 2.2e-4.
            assert!((drives.currents()[0] / MOTOR.aim(10_000) - expected / MOTOR.aim(10_000)).abs() < 2.2e-4);
        }
    }

    #[test]
    fn current_stops_at_the_limit_both_ways() {
        for (duty, limit) in [(i16::MAX, 2.0), (i16::MIN, -2.0)] {
            let mut drives = Drives::new([MOTOR; 3], 0, 1e-4, 1e-5);
            drives.command(0, [duty; 3]);
            let torques = (0..1_000).map(|now| drives.step(now, STILL)).last().unwrap();
            // The exponential has died out to rounding.
            assert!((drives.currents()[0] - limit).abs() < 1e-12);
            assert!((torques[2] + 0.4 * limit).abs() < 1e-12);
        }
    }

    const WINDING: Winding = Winding { supply: 12.0, resistance: 4.0, inductance: 1e-3 };

    fn settled(motor: Motor, duty: i16, rate: f64) -> f64 {
        let mut drives = Drives::new([motor; 3], 0, 1e-4, 1e-5);
        drives.command(0, [duty; 3]);
        // 20 ms are 80 time constants L/R.
        (0..2_000).for_each(|now| {
            drives.step(now, [rate; 3]);
        });
        drives.currents()[0]
    }

    #[test]
    fn a_bridge_gives_what_resistance_and_back_emf_leave() {
        let motor = Motor { amplifier: Amplifier::Voltage(WINDING), ..MOTOR };
        // 6 V on 4 Ω; at 5 rad/s the back-EMF is −0.4 · 5 = −2 V.
        for (rate, current) in [(0.0, 1.5), (5.0, 2.0), (-5.0, 1.0)] {
            let found = settled(motor, 16_384, rate);
            // A half duty is 1.5e-5 over 16,383.5; the exponential has died out.
            assert!((found - current).abs() < 1e-4, "{rate}: {found}");
        }
    }

    #[test]
    fn a_bridge_s_current_rises_with_l_over_r() {
        let motor = Motor { amplifier: Amplifier::Voltage(WINDING), ..MOTOR };
        let mut drives = Drives::new([motor; 3], 0, 0.0, 1e-5);
        drives.command(0, [10_000, 0, 0]);
        let end = 10_000.0 / 32_767.0 * 12.0 / 4.0;
        for now in 0..100 {
            drives.step(now, STILL);
            let expected = end * (1.0 - (-(now as f64 + 1.0) * 1e-5 * 4.0 / 1e-3).exp());
            // (h/τ)²/12 / e with h/τ = 0.04.
            assert!((drives.currents()[0] - expected).abs() < 5e-5 * end);
        }
    }

    #[test]
    fn a_current_loop_runs_out_of_supply_at_speed() {
        let motor = Motor { amplifier: Amplifier::CurrentOn(WINDING), ..MOTOR };
        // Full duty aims at 3 A, limited to 2 A; with 12 − 8 V left at −20 rad/s, 1 A.
        for (rate, current) in [(0.0, 2.0), (-20.0, 1.0), (20.0, 2.0)] {
            let found = settled(motor, i16::MAX, rate);
            assert!((found - current).abs() < 1e-9, "{rate}: {found}");
        }
    }
}
