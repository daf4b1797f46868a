//! The range of set-points of an amplifier.

use crate::device::Duty;
use thiserror::Error;

/// The two ends of a set-point's range, as fractions of 32,767. With a sign they mean full current back and ahead, and
/// their middle none; as a magnitude, none and full current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SetPointRange {
    start: u16,
    end: u16,
}

/// The set-point's range is empty or outside the pulse width.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a set-point's range must lie between 0 and 1 and not be empty")]
pub struct SetPointRangeError;

impl SetPointRange {
    /// 10 % to 90 %, which Maxon's ESCON amplifiers take as a pulse-width set-point (10 Hz to 5 kHz): a set-point
    /// outside means a broken wire.
    pub const TEN_TO_NINETY: Self = Self { start: 3_277, end: 29_490 };
    /// All of it: an analog set-point from a converter, as a magnitude; its 0 V is no current, and so is a chip that
    /// has no power.
    pub const WHOLE: Self = Self { start: 0, end: 32_767 };

    /// A range between two set-points, each from 0 to 1. The first means full current back, or none where the set-point
    /// is a magnitude; it may be the larger.
    ///
    /// # Errors
    /// A range that is empty or not within 0 and 1.
    pub const fn try_new(start: f32, end: f32) -> Result<Self, SetPointRangeError> {
        let within = start >= 0.0 && start <= 1.0 && end >= 0.0 && end <= 1.0;
        let range = Self { start: (start * 32_767.0 + 0.5) as u16, end: (end * 32_767.0 + 0.5) as u16 };
        if within && range.start != range.end { Ok(range) } else { Err(SetPointRangeError) }
    }

    /// The set-point of a duty with its sign, 0 to 32,767.
    pub(super) fn of_signed(self, Duty(duty): Duty) -> u16 {
        let (back, ahead) = (i32::from(self.start), i32::from(self.end));
        let duty = i32::from(duty).max(-32_767);
        // Twice the middle, so that nothing is lost before the one division; largest number 2·10⁹.
        let doubled = (back + ahead) * 32_767 + (ahead - back) * duty;
        u16::try_from((doubled + 32_767) / 65_534).unwrap_or(0)
    }

    /// The set-point of a duty's magnitude, 0 to 32,767.
    pub(super) fn of_magnitude(self, Duty(duty): Duty) -> u16 {
        let (none, full) = (i32::from(self.start), i32::from(self.end));
        let magnitude = i32::from(duty.unsigned_abs().min(32_767));
        // Between the two ends and so never negative; largest number 2·10⁹.
        u16::try_from((none * 32_767 + (full - none) * magnitude + 16_383) / 32_767).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn with_a_sign_the_middle_is_no_current_and_the_ends_are_full() {
        let range = SetPointRange::TEN_TO_NINETY;
        assert_eq!(SetPointRange::try_new(0.1, 0.9), Ok(range));
        // 0.1, 0.5 and 0.9 of 32,767, to nearest.
        for (duty, width) in
            [(Duty(-32_767), 3_277), (Duty::ZERO, 16_384), (Duty::FULL, 29_490), (Duty(i16::MIN), 3_277)]
        {
            assert_eq!(range.of_signed(duty), width, "{duty:?}");
        }
        let reversed = SetPointRange::try_new(1.0, 0.0).unwrap();
        assert_eq!([Duty::FULL, Duty(-32_767)].map(|duty| reversed.of_signed(duty)), [0, 32_767]);
    }

    #[test]
    fn as_a_magnitude_the_start_is_no_current_and_the_end_full_either_way() {
        let range = SetPointRange::TEN_TO_NINETY;
        // 0.1, 0.5 and 0.9 of 32,767, to nearest.
        for (duty, width) in [(0, 3_277), (16_384, 16_384), (-16_384, 16_384), (32_767, 29_490), (i16::MIN, 29_490)] {
            assert_eq!(range.of_magnitude(Duty(duty)), width, "{duty}");
        }
        assert_eq!(SetPointRange::WHOLE.of_magnitude(Duty::ZERO), 0);
        let reversed = SetPointRange::try_new(1.0, 0.0).unwrap();
        assert_eq!([Duty::ZERO, Duty(-32_767)].map(|duty| reversed.of_magnitude(duty)), [32_767, 0]);
    }

    #[test]
    fn a_range_that_makes_no_sense_is_refused() {
        for (start, end) in [(0.5, 0.5), (-0.1, 0.9), (0.1, 1.1), (f32::NAN, 0.9), (0.1, f32::INFINITY)] {
            assert_eq!(SetPointRange::try_new(start, end), Err(SetPointRangeError));
        }
    }
}
