//! Incremental encoders on the motor shafts: a joint angle becomes a whole number of counts.

use std::f64::consts::TAU;

/// An encoder as the simulated device has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Counts per radian of the joint; negative where the encoder counts the other way.
    pub counts_per_radian: f64,
}

impl Encoder {
    /// An encoder of `counts_per_turn` (after quadrature) on a shaft that turns `ratio` times with its joint.
    /// It reads zero at joint angle zero, the calibration pose.
    pub fn geared(counts_per_turn: f64, ratio: f64, direction: f64) -> Self {
        Self { counts_per_radian: direction * counts_per_turn * ratio / TAU }
    }

    /// The reading: the line last passed, never one ahead.
    pub fn counts(&self, angle: f64) -> i32 {
        (angle * self.counts_per_radian).floor() as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_spans_its_angle_and_rounds_down() {
        let count = TAU / 32_000.0;
        let encoder = Encoder::geared(2_000.0, 16.0, 1.0);
        for (counts, angle) in [(0, 0.1), (0, 0.9), (1, 1.1), (-1, -0.1), (-1, -0.9), (-2, -1.1), (32_000, 32_000.5)] {
            assert_eq!(encoder.counts(angle * count), counts, "{angle}");
        }
    }

    #[test]
    fn the_other_direction_counts_down() {
        let count = TAU / 24_000.0;
        let encoder = Encoder::geared(2_000.0, 12.0, -1.0);
        assert_eq!([0.1, 1.1, -0.1].map(|angle| encoder.counts(angle * count)), [-1, -2, 0]);
    }
}
