//! Encoder counts to joint angles.

/// A position as an incremental encoder counts it. A board extends a counter of fewer bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts(pub i32);

/// An encoder on a motor shaft, seen through the transmission.
///
/// A counter reading of `n` means that line `n` was passed and line `n + 1` was not: the joint is anywhere between the
/// two, and the middle has the smallest mean error. An angle read at the line itself would be off by half a count on
/// average, always to the same side, and a spring with it: 2 % of the force of a wall pressed in by 1.3 mm on a Falcon.
/// So [`Self::angle_at_zero_rad`] is the middle of count zero, which costs the tick nothing.
///
/// If the counter was set to zero by hand in some pose, and not at a line, the pose itself is anywhere in count zero:
/// an offset of up to half a count stays, which only homing on a mark or a stop removes.
///
/// ```
/// use core::f32::consts::TAU;
/// use palpate::device::{Counts, Encoder};
///
/// /// 2,000 counts a turn of the motor, 16:1; the joint is at 0.25 rad where the counter steps from −1 to 0.
/// const ENCODER: Encoder = Encoder::geared(2_000.0, 16.0, 0.25);
/// let turn_of_motor = ENCODER.angle(Counts(2_000)) - ENCODER.angle(Counts(0));
/// assert!((turn_of_motor - TAU / 16.0).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Joint angle per count, radians; negative where the encoder counts the other way.
    pub radians_per_count: f32,
    /// Joint angle in the middle of count zero, radians.
    pub angle_at_zero_rad: f32,
}

impl Encoder {
    /// An encoder from radians of the joint per count and the angle, radians, at which its count steps from −1 to 0.
    pub const fn new(radians_per_count: f32, angle_at_line: f32) -> Self {
        Self { radians_per_count, angle_at_zero_rad: angle_at_line + 0.5 * radians_per_count }
    }

    /// An encoder of `counts_per_revolution` (after quadrature) on a motor geared down `ratio : 1` to the joint, whose
    /// count steps from −1 to 0 at `angle_at_line`, radians. A negative ratio turns the direction round.
    pub const fn geared(counts_per_revolution: f32, ratio: f32, angle_at_line: f32) -> Self {
        Self::new(core::f32::consts::TAU / (counts_per_revolution * ratio), angle_at_line)
    }

    /// The joint angle in the middle of a count, radians.
    #[inline]
    pub fn angle(&self, counts: Counts) -> f32 {
        counts.0 as f32 * self.radians_per_count + self.angle_at_zero_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{PI, TAU};

    #[test]
    fn a_turn_of_the_motor_is_a_turn_over_the_ratio() {
        let encoder = Encoder::geared(2_000.0, 16.0, 0.25);
        let half = TAU / 64_000.0;
        // A rounding or two of 0.6 rad.
        assert!((encoder.angle(Counts(2_000)) - (TAU / 16.0 + 0.25 + half)).abs() < 1.2e-7);
        assert_eq!(encoder.angle(Counts(0)), 0.25 + half);
    }

    #[test]
    fn a_negative_ratio_counts_the_other_way() {
        let encoder = Encoder::geared(2_000.0, -12.0, 0.0);
        assert!((encoder.angle(Counts(12_000)) + PI + PI / 24_000.0).abs() < 2.0 * PI * f32::EPSILON);
        // Seven counts up end where six and a half lie: counts −8 to −7 are as far on the other side.
        assert!((encoder.angle(Counts(-8)) + encoder.angle(Counts(7))).abs() < 1e-9);
    }

    #[test]
    fn every_count_has_a_finite_angle() {
        let encoder = Encoder::geared(2_000.0, 16.0, 0.0);
        assert!([i32::MIN, i32::MAX].iter().all(|counts| encoder.angle(Counts(*counts)).is_finite()));
    }
}
