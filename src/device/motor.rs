//! Joint torques to motor duty.

/// A motor command as a fraction of full scale: −32 767 is full torque one way, +32 767 the other, 0 is no current.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Duty(pub i16);

impl Duty {
    /// No current.
    pub const ZERO: Self = Self(0);
    /// Full scale.
    pub const FULL: Self = Self(i16::MAX);

    /// The duty nearest to a fraction of full scale. Beyond ±1 it is full scale; a NaN is zero.
    #[inline]
    pub fn from_fraction(fraction: f32) -> Self {
        // The cast truncates, so the half rounds to nearest; it saturates and makes a NaN 0. To 32 bits it is one
        // instruction, to 16 it would be a dozen.
        let half = if fraction < 0.0 { -0.5 } else { 0.5 };
        Self(((fraction * 32_767.0 + half) as i32).clamp(-32_767, 32_767) as i16)
    }

    /// As [`Self::from_fraction`] in fewer instructions, of a number: a NaN is full scale here. A half goes to the even
    /// one.
    #[inline]
    pub(crate) fn from_number(fraction: f32) -> Self {
        // Next to 1.5·2²³ numbers are whole and follow each other as their bits do: the addition rounds. Further away
        // the bits still rise with the number, and go beyond both ends.
        let bits = (fraction * 32_767.0 + ROUND).to_bits() as i32;
        Self(bits.saturating_sub(0x4B40_0000).clamp(-32_767, 32_767) as i16)
    }

    /// As [`Self::from_number`], of a fraction that is known to be within ±1: the duty is the last bits.
    #[inline]
    pub(crate) fn within_scale(fraction: f32) -> Self {
        Self((fraction * 32_767.0 + ROUND).to_bits() as i16)
    }

    /// The duty as a fraction of full scale, −1 to 1.
    #[inline]
    pub fn fraction(self) -> f32 {
        f32::from(self.0) * (1.0 / 32_767.0)
    }
}

/// 1.5·2²³, whose last sixteen bits are 0.
const ROUND: f32 = 12_582_912.0;

/// A motor on a current-controlled amplifier, seen through the transmission.
///
/// ```
/// use palpate::device::{Duty, Motor};
///
/// /// 0.0259 N·m/A, 3 A at full duty, 12:1.
/// const MOTOR: Motor = Motor::current_driven(0.0259, 3.0, 12.0);
/// let half = 0.5 * 0.0259 * 3.0 * 12.0;
/// assert_eq!(Duty::from_fraction(MOTOR.fraction(half)), Duty(16_384));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motor {
    /// Joint torque at full duty, N·m; negative where the motor turns the joint the other way.
    pub torque_at_full_n_m: f32,
}

impl Motor {
    /// A motor of torque constant `torque_constant` (N·m/A) whose amplifier gives `current_at_full` amperes at full
    /// duty, geared down `ratio : 1` to the joint. A negative ratio turns the direction round.
    pub const fn current_driven(torque_constant: f32, current_at_full: f32, ratio: f32) -> Self {
        Self { torque_at_full_n_m: torque_constant * current_at_full * ratio }
    }

    /// The fraction of full scale that gives a joint torque, N·m. Not limited.
    #[inline]
    pub fn fraction(&self, torque: f32) -> f32 {
        torque / self.torque_at_full_n_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_fraction_has_a_duty() {
        for (fraction, duty) in [
            (f32::NAN, 0),
            (-f32::NAN, 0),
            (f32::INFINITY, 32_767),
            (f32::NEG_INFINITY, -32_767),
            (f32::MAX, 32_767),
            (f32::MIN, -32_767),
            (1.0, 32_767),
            (-1.0, -32_767),
            (0.0, 0),
            (-0.0, 0),
            (f32::MIN_POSITIVE, 0),
            // To nearest, halves away from zero, the same on both sides.
            (0.49 / 32_767.0, 0),
            (0.51 / 32_767.0, 1),
            (-0.49 / 32_767.0, 0),
            (-0.51 / 32_767.0, -1),
            (0.5, 16_384),
            (-0.5, -16_384),
        ] {
            assert_eq!(Duty::from_fraction(fraction), Duty(duty), "{fraction}");
        }
    }

    #[test]
    fn a_number_never_turns_round_whatever_its_size() {
        for exponent in -149..=127 {
            for size in [1.0, 1.2, 1.999_999_9] {
                let fraction = size * 2.0_f32.powi(exponent);
                for fraction in [fraction, -fraction] {
                    let [fast, plain] = [Duty::from_number(fraction), Duty::from_fraction(fraction)];
                    // Apart by one where a half goes the other way.
                    assert!((i32::from(fast.0) - i32::from(plain.0)).abs() <= 1, "{fraction}: {fast:?} {plain:?}");
                }
            }
        }
        for (fraction, duty) in [(f32::INFINITY, 32_767), (f32::NEG_INFINITY, -32_767), (1.0, 32_767), (-1.0, -32_767)]
        {
            assert_eq!(Duty::from_number(fraction), Duty(duty), "{fraction}");
        }
        for duty in -32_767..=32_767 {
            assert_eq!(Duty::from_number(Duty(duty).fraction()), Duty(duty));
        }
    }

    #[test]
    fn within_scale_the_duty_is_that_of_a_number() {
        for step in -1_000_000..=1_000_000 {
            let fraction = step as f32 * 1e-6;
            assert_eq!(Duty::within_scale(fraction), Duty::from_number(fraction), "{fraction}");
        }
    }

    #[test]
    fn every_duty_comes_back_from_its_fraction() {
        for duty in -32_767..=32_767 {
            assert_eq!(Duty::from_fraction(Duty(duty).fraction()), Duty(duty));
        }
    }

    #[test]
    fn full_torque_is_full_duty() {
        let motor = Motor::current_driven(0.0259, 3.0, -12.0);
        assert_eq!(Duty::from_fraction(motor.fraction(-0.0259 * 3.0 * 12.0)), Duty::FULL);
        assert_eq!(Duty::from_fraction(motor.fraction(0.0259 * 3.0 * 6.0)), Duty(-16_384));
    }
}
