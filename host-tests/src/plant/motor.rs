//! Motors on current-controlled amplifiers: a duty becomes, some time later, a current and a torque.

use super::vector::Vector;
use std::collections::VecDeque;

/// An amplifier and its motor, seen at the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Current at full duty, A.
    pub current_at_full: f64,
    /// The most the amplifier gives, A.
    pub current_limit: f64,
    /// Joint torque per ampere, N·m/A; negative where the motor turns the joint the other way.
    pub torque_per_ampere: f64,
}

impl Motor {
    /// The current the amplifier aims at, A.
    pub fn aim(&self, duty: i16) -> f64 {
        let current = f64::from(duty) / 32_767.0 * self.current_at_full;
        current.clamp(-self.current_limit, self.current_limit)
    }
}

/// The three drives: transport delay, then the current loop.
#[derive(Clone, Debug)]
pub struct Drives {
    motors: [Motor; 3],
    /// Commands under way, and the sub-step at which each arrives.
    under_way: VecDeque<(u64, [i16; 3])>,
    delay: u64,
    /// How much of the distance to the aim is left after a sub-step.
    left_over: f64,
    aim: Vector,
    currents: Vector,
}

impl Drives {
    /// Drives at rest. `delay` counts sub-steps; `time_constant` and `sub_step` are in s.
    pub fn new(motors: [Motor; 3], delay: u64, time_constant: f64, sub_step: f64) -> Self {
        // The trapezoidal rule for i' = (aim − i)/τ, off by (h/τ)³/12 a step; without a time constant the aim is met at once.
        let left_over = ((2.0 * time_constant - sub_step) / (2.0 * time_constant + sub_step)).max(0.0);
        let under_way = VecDeque::new();
        Self { motors, under_way, delay, left_over, aim: [0.0; 3], currents: [0.0; 3] }
    }

    /// Takes a command at sub-step `now`.
    pub fn command(&mut self, now: u64, duties: [i16; 3]) {
        self.under_way.push_back((now + self.delay, duties));
    }

    /// The joint torques over sub-step `now`, N·m: those of the mean of the currents at its two ends.
    pub fn step(&mut self, now: u64) -> Vector {
        while let Some(&(arrival, duties)) = self.under_way.front()
            && arrival <= now
        {
            self.under_way.pop_front();
            self.aim = core::array::from_fn(|joint| self.motors[joint].aim(duties[joint]));
        }
        core::array::from_fn(|joint| {
            let before = self.currents[joint];
            let after = self.aim[joint] + (before - self.aim[joint]) * self.left_over;
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

    const MOTOR: Motor = Motor { current_at_full: 3.0, current_limit: 2.0, torque_per_ampere: -0.4 };

    #[test]
    fn a_command_arrives_after_its_delay_and_not_a_sub_step_sooner() {
        for delay in [0, 10, 20, 40] {
            let mut drives = Drives::new([MOTOR; 3], delay, 0.0, 1e-5);
            drives.command(0, [16_384, 0, 0]);
            let first = (0..100).find(|now| drives.step(*now)[0] != 0.0);
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
            drives.step(now);
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
            drives.step(now);
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
            let torques = (0..1_000).map(|now| drives.step(now)).last().unwrap();
            // The exponential has died out to rounding.
            assert!((drives.currents()[0] - limit).abs() < 1e-12);
            assert!((torques[2] + 0.4 * limit).abs() < 1e-12);
        }
    }
}
