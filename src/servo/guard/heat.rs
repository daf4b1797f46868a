//! I²t: the temperature of a winding, from its duties, and the torque limit that follows.
//!
//! A winding's temperature over its housing follows the square of its current with the winding's time constant `θ`: `θ
//! ẋ = i² − x`, with `x` in squares of the current at full duty. While `x` stays below the square of the continuous
//! current `c`, the winding stays below the steady temperature of `c`, because the same power drives the warming of the
//! housing (theory of monotone linear systems: more heat never makes any part colder).
//!
//! So the current is bounded by `b(x)`, which falls from full scale at `x = c²/2` to `c` at `x = c²`: `b = 1 − (1 −
//! c)(2x/c² − 1)`. There `i² ≤ c²`, so `x` cannot exceed it, whatever torque is requested. `b` is continuous in `x`,
//! and `x` moves by at most `1/(θ rate)` a tick: the force fades to the limit without a step.
//!
//! A tick updates one motor, and only adds up the squares of the others' duties: `x` advances by the mean of all
//! squares since its last turn, over the same number of ticks, so no duty is left out. The bound is as old as that
//! turn, a tick less than the number of joints: `x` exceeds `c²` by its change in that time, below `2/(θ rate)` of full
//! scale. The settings' minimum `θ rate` of 100 keeps that small, and with a real motor it is negligible (16 s at 4
//! kHz: 3·10⁻⁵).
//!
//! A motor with three phases has one `x`, that of a phase which has the whole amplitude all the time: no phase ever has
//! more, wherever the rotor stands ([`Endurance::three_phase`]). And where the winding's own constant is `ϑ ≥ θ`, its
//! temperature is `(θ/ϑ) x + (1 − θ/ϑ) LP(x)`, with a low-pass `LP` of `ϑ`: not above `c²` either. So a `θ` that is too
//! short is safe.

use crate::device::{Endurance, Motor};

/// One motor's endurance, as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct HeatModel {
    /// Share of the way to equilibrium from one turn to the next, in 2⁻³².
    share: i32,
    /// `c²/2`, from where on the bound falls. Above full scale nothing ever folds.
    fold: Heat,
    /// By how much it falls for each unit of [`Heat`].
    slope: f32,
    /// `c`.
    continuous: f32,
    /// The torque of full scale, N·m.
    full: f32,
}

/// The thermal state of one motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Winding {
    /// How warm it may be.
    pub heat: Heat,
    /// The sum of the squares of its duties since its last turn.
    pub squares: u32,
    /// The most torque that it may be given, N·m.
    pub limit: f32,
}

/// Temperature of a winding: the mean square of its duty. Continuous full duty gives 2³⁰ − 2¹⁶ + 1 (32,767²).
///
/// An integer, because the increment of one tick is far below the rounding of an `f32`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Heat(pub i32);

/// Continuous full duty.
const FULL: f32 = 32_767.0 * 32_767.0;

impl Heat {
    /// As a fraction of the final value of full duty.
    pub fn fraction(self) -> f32 {
        self.0 as f32 / FULL
    }
}

impl HeatModel {
    /// Of a motor that is updated every `turns` ticks: 1 to 3.
    ///
    /// # Panics
    /// Never; invalid numbers were refused before ([`super::ProtectionError`]).
    pub(super) const fn new(
        Endurance { continuous, time_constant_s: time_constant }: Endurance,
        motor: Motor,
        rate: f32,
        turns: usize,
    ) -> Self {
        // From turn to turn is far shorter than the time constant: the share is that time over the constant.
        let share = turns as f32 * 4_294_967_296.0 / (time_constant * rate);
        Self::bearing(share as i32, continuous, motor.torque_at_full_n_m.abs())
    }

    /// Of a motor with this continuous fraction of full duty, which gives a torque of `full`, N·m.
    const fn bearing(share: i32, continuous: f32, full: f32) -> Self {
        let half = 0.5 * continuous * continuous * FULL;
        let fold = if continuous < 1.0 { Heat(half as i32) } else { Heat(i32::MAX) };
        Self { share, fold, slope: (1.0 - continuous) / half, continuous, full }
    }

    /// The same of a motor of another torque. A motor may be stronger because its amplifier gives more current than it
    /// should: its continuous torque stays. A weaker motor keeps its continuous current.
    pub(super) fn of_motor(self, motor: Motor) -> Self {
        let full = motor.torque_at_full_n_m.abs();
        let continuous = if full > self.full { self.continuous * self.full / full } else { self.continuous };
        Self::bearing(self.share, continuous, full)
    }

    /// Continuous torque limit, as a fraction of full duty.
    pub(super) fn continuous(&self) -> f32 {
        if self.continuous < 1.0 { self.continuous } else { 1.0 }
    }

    /// After a reset nothing is known of the motor: it may have been driven for hours before. It starts at its
    /// continuous torque and is found cold by and by.
    pub(super) fn start(&self) -> Winding {
        let hottest = self.continuous();
        let heat = Heat((hottest * hottest * FULL) as i32);
        Winding { heat, squares: 0, limit: self.limit(heat) }
    }

    /// The motor's turn, with the mean square of its duties since the last one.
    #[inline]
    pub(super) fn next(&self, Heat(heat): Heat, mean_square: u32) -> Heat {
        let missing = mean_square as i32 - heat;
        // The high word of a product of two words: one instruction.
        Heat(heat + ((i64::from(missing) * i64::from(self.share)) >> 32) as i32)
    }

    /// Whether the bound is below full scale.
    #[inline]
    pub(super) fn folds(&self, heat: Heat) -> bool {
        heat > self.fold
    }

    /// How much of full scale the motor may be given.
    #[inline]
    pub(super) fn bound(&self, heat: Heat) -> f32 {
        if !self.folds(heat) {
            return 1.0;
        }
        let bound = 1.0 - (heat.0 - self.fold.0) as f32 * self.slope;
        if bound > self.continuous { bound } else { self.continuous }
    }

    /// The most torque that the motor may be given, N·m.
    #[inline]
    pub(super) fn limit(&self, heat: Heat) -> f32 {
        self.bound(heat) * self.full
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Duty;

    const MOTOR: Motor = Motor { torque_at_full_n_m: -2.0 };
    const MODEL: HeatModel = HeatModel::new(Endurance { continuous: 0.3, time_constant_s: 5.0 }, MOTOR, 4_000.0, 1);

    fn square(Duty(duty): Duty) -> u32 {
        u32::from(duty.unsigned_abs()).pow(2)
    }

    #[test]
    fn warmth_follows_the_square_of_the_duty_with_the_time_constant() {
        let (mut heat, duty) = (Heat(0), Duty(20_000));
        for tick in 1..=80_000 {
            heat = MODEL.next(heat, square(duty));
            let expected = (20_000.0_f64 / 32_767.0).powi(2) * (1.0 - (-f64::from(tick) / 20_000.0).exp());
            // Half the share of a tick, 1/40,000, and rounding down by 2⁻³⁰ a tick over 20,000 ticks of memory.
            assert!((f64::from(heat.fraction()) - expected).abs() < 5e-5, "{tick}: {heat:?} {expected}");
        }
    }

    #[test]
    fn whatever_is_asked_for_the_warmth_stays_below_that_of_the_continuous_torque() {
        for ask in [Duty::FULL, Duty(12_000), Duty(-32_767)] {
            for start in [Heat(0), MODEL.start().heat] {
                let (mut heat, mut last, mut step) = (start, MODEL.bound(start), 0.0_f32);
                for _ in 0..400_000 {
                    let bound = MODEL.bound(heat);
                    step = step.max((bound - last).abs());
                    last = bound;
                    let share = ask.fraction().abs().min(bound) * ask.fraction().signum();
                    heat = MODEL.next(heat, square(Duty::from_fraction(share)));
                    // The duty is rounded to half a step of 32,767, and so is its square at most.
                    assert!(heat.fraction() <= 0.09 + 2e-5, "{ask:?}: {heat:?}");
                }
                assert!(last >= 0.3 - 1e-4, "{last}");
                assert!(step < 1e-3, "{step} of full scale in a tick");
            }
        }
    }

    #[test]
    fn a_motor_that_rests_has_its_full_torque_again() {
        let mut heat = MODEL.start().heat;
        assert!(MODEL.folds(heat));
        let rested = (0..40_000).find(|_| {
            heat = MODEL.next(heat, 0);
            !MODEL.folds(heat)
        });
        // ln 2 of 5 s at 4 kHz.
        assert!(matches!(rested, Some(13_800..=13_900)), "{rested:?}");
    }

    #[test]
    fn a_motor_found_stronger_bears_no_more_and_one_found_weaker_no_more_current() {
        let strong = MODEL.of_motor(Motor { torque_at_full_n_m: 4.0 });
        assert!((strong.start().limit - MODEL.start().limit).abs() < 1e-6, "0.6 N·m of either");
        let hot = Heat((0.15 * 0.15 * FULL) as i32);
        assert!((strong.bound(hot) - 0.15).abs() < 1e-5 && (strong.bound(Heat(hot.0 / 2)) - 1.0).abs() < 1e-5);
        let weak = MODEL.of_motor(Motor { torque_at_full_n_m: 1.0 });
        assert!((weak.start().limit - 0.3).abs() < 1e-6, "{weak:?}");
    }

    #[test]
    fn an_amplifier_that_cannot_overheat_the_motor_is_never_bounded() {
        let strong = HeatModel::new(Endurance { continuous: 1.1, time_constant_s: 5.0 }, MOTOR, 4_000.0, 3);
        assert_eq!(strong.start().limit, 2.0);
        assert_eq!(strong.bound(Heat(FULL as i32)), 1.0);
    }
}
