//! Incremental encoders on the motor shafts: a joint angle becomes a whole number of counts.

use std::f64::consts::TAU;

/// An encoder as the simulated device has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    /// Counts per radian of the joint; negative where the encoder counts the other way.
    pub counts_per_radian: f64,
    /// Joint angle at zero counts, rad.
    pub angle_at_zero: f64,
}

impl Encoder {
    /// An encoder of `counts_per_turn` (after quadrature) on a shaft that turns `ratio` times with its joint.
    pub fn geared(counts_per_turn: f64, ratio: f64, direction: f64, angle_at_zero: f64) -> Self {
        Self { counts_per_radian: direction * counts_per_turn * ratio / TAU, angle_at_zero }
    }

    /// The reading: the line last passed, never one ahead.
    pub fn counts(&self, angle: f64) -> i32 {
        ((angle - self.angle_at_zero) * self.counts_per_radian).floor() as i32
    }
}

/// Fault of an encoder, from its injection on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EncoderFault {
    /// The reading does not change.
    Stuck,
    /// The wire is off: it reads zero.
    Absent,
    /// One reading, until the plant next advances, is off by this number of counts.
    Glitch(i32),
    /// All readings are off by this number of counts.
    Jump(i32),
    /// This fraction of all further counts is lost, 0 to 1: a slipping disc, missed edges.
    CountLoss(f64),
}

/// An encoder with its fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FaultyEncoder {
    encoder: Encoder,
    /// The fault, and the count at its start.
    fault: Option<(EncoderFault, i32)>,
}

impl FaultyEncoder {
    pub(super) fn sound(encoder: Encoder) -> Self {
        Self { encoder, fault: None }
    }

    pub(super) fn inject(&mut self, fault: Option<EncoderFault>, angle: f64) {
        self.fault = fault.map(|fault| (fault, self.encoder.counts(angle)));
    }

    /// A period has gone by: a glitch is over.
    pub(super) fn tick(&mut self) {
        if let Some((EncoderFault::Glitch(_), _)) = self.fault {
            self.fault = None;
        }
    }

    pub(super) fn counts(&self, angle: f64) -> i32 {
        let counts = self.encoder.counts(angle);
        match self.fault {
            None => counts,
            Some((EncoderFault::Stuck, since)) => since,
            Some((EncoderFault::Absent, _)) => 0,
            Some((EncoderFault::Glitch(by) | EncoderFault::Jump(by), _)) => counts.wrapping_add(by),
            Some((EncoderFault::CountLoss(share), since)) => {
                since + (f64::from(counts - since) * (1.0 - share)).round() as i32
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_fault_reads_as_it_says() {
        let angle = |counts: f64| (counts + 0.5) * TAU / 32_000.0;
        let faulty = |fault| {
            let mut encoder = FaultyEncoder::sound(Encoder::geared(2_000.0, 16.0, 1.0, 0.0));
            encoder.inject(Some(fault), angle(100.0));
            let first = encoder.counts(angle(120.0));
            encoder.tick();
            [first, encoder.counts(angle(140.0))]
        };
        assert_eq!(faulty(EncoderFault::Stuck), [100, 100]);
        assert_eq!(faulty(EncoderFault::Absent), [0, 0]);
        assert_eq!(faulty(EncoderFault::Glitch(7)), [127, 140]);
        assert_eq!(faulty(EncoderFault::Jump(-7)), [113, 133]);
        assert_eq!(faulty(EncoderFault::CountLoss(0.25)), [115, 130]);
    }

    #[test]
    fn a_count_spans_its_angle_and_rounds_down() {
        let count = TAU / 32_000.0;
        let encoder = Encoder::geared(2_000.0, 16.0, 1.0, 0.0);
        for (counts, angle) in [(0, 0.1), (0, 0.9), (1, 1.1), (-1, -0.1), (-1, -0.9), (-2, -1.1), (32_000, 32_000.5)] {
            assert_eq!(encoder.counts(angle * count), counts, "{angle}");
        }
    }

    #[test]
    fn the_other_direction_counts_down() {
        let count = TAU / 24_000.0;
        let encoder = Encoder::geared(2_000.0, 12.0, -1.0, 0.0);
        assert_eq!([0.1, 1.1, -0.1].map(|angle| encoder.counts(angle * count)), [-1, -2, 0]);
    }
}
