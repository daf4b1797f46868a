//! Encoder counts to joint angles.

/// A position as an incremental encoder counts it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Counts(pub i32);

/// An encoder on a motor shaft, seen through the transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Joint angle per count, radians; negative where the encoder counts the other way.
    pub radians_per_count: f32,
    /// Joint angle at zero counts, radians.
    pub angle_at_zero: f32,
}

impl Encoder {
    /// An encoder of `counts_per_revolution` (after quadrature) on a motor geared down `ratio : 1` to the joint.
    /// A negative ratio turns the direction round.
    pub const fn geared(counts_per_revolution: f32, ratio: f32, angle_at_zero: f32) -> Self {
        Self { radians_per_count: core::f32::consts::TAU / (counts_per_revolution * ratio), angle_at_zero }
    }

    /// The joint angle, radians.
    #[inline]
    pub fn angle(&self, counts: Counts) -> f32 {
        counts.0 as f32 * self.radians_per_count + self.angle_at_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::{PI, TAU};

    #[test]
    fn a_turn_of_the_motor_is_a_turn_over_the_ratio() {
        let encoder = Encoder::geared(2_000.0, 16.0, 0.25);
        // A rounding or two of 0.6 rad.
        assert!((encoder.angle(Counts(2_000)) - (TAU / 16.0 + 0.25)).abs() < 1.2e-7);
        assert_eq!(encoder.angle(Counts(0)), 0.25);
    }

    #[test]
    fn a_negative_ratio_counts_the_other_way() {
        let encoder = Encoder::geared(2_000.0, -12.0, 0.0);
        assert!((encoder.angle(Counts(12_000)) + PI).abs() < 2.0 * PI * f32::EPSILON);
        assert_eq!(encoder.angle(Counts(-7)), -encoder.angle(Counts(7)));
    }

    #[test]
    fn every_count_has_a_finite_angle() {
        let encoder = Encoder::geared(2_000.0, 16.0, 0.0);
        assert!([i32::MIN, i32::MAX].iter().all(|counts| encoder.angle(Counts(*counts)).is_finite()));
    }
}
