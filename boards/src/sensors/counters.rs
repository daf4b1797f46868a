//! Quadrature counters of the chip.

use super::{BadFrame, Sensors};
use crate::Felt;
use palpate::device::sensor::TimerCount;
use palpate::device::{Counts, Encoder};

/// Reads the counters.
pub trait Readings<const JOINTS: usize> {
    /// The counters, of which the lower 16 bits are used.
    fn readings(&mut self) -> [u32; JOINTS];

    /// The counters as the chip caught them at the last index mark that was passed, each told once. Asked after
    /// [`Self::readings`]. None where no input has marks.
    #[inline]
    fn caught(&mut self) -> [Option<u32>; JOINTS] {
        [None; JOINTS]
    }
}

/// The counters, counted on over their wrap.
#[derive(Debug)]
pub struct Counters<R, const JOINTS: usize> {
    readings: R,
    counts: [TimerCount; JOINTS],
    /// The last good reading of each, and what it was counted on to.
    last: [(u32, Counts); JOINTS],
}

impl<R: Readings<JOINTS>, const JOINTS: usize> Counters<R, JOINTS> {
    /// The counters, each with the maximum step between two readings ([`max_step`]).
    pub fn new(readings: R, greatest_steps: [i32; JOINTS]) -> Self {
        Self { readings, counts: greatest_steps.map(TimerCount::new), last: [(0, Counts(0)); JOINTS] }
    }
}

impl<R: Readings<JOINTS>, const JOINTS: usize> Sensors<JOINTS> for Counters<R, JOINTS> {
    #[inline]
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        let readings = self.readings.readings();
        let mut counts = [Counts(0); JOINTS];
        for (((count, counter), reading), last) in
            counts.iter_mut().zip(&mut self.counts).zip(readings).zip(&mut self.last)
        {
            *count = counter.count(reading).map_err(|_| BadFrame::Jumped)?;
            *last = (reading, *count);
        }
        Ok(counts)
    }

    #[inline]
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        let mut marks = [None; JOINTS];
        for ((mark, caught), (reading, counts)) in marks.iter_mut().zip(self.readings.caught()).zip(&self.last) {
            // Caught less than half a wrap before or after the reading.
            *mark = caught.map(|caught| Counts(counts.0.wrapping_add(i32::from(caught.wrapping_sub(*reading) as i16))));
        }
        marks
    }
}

/// [`max_step`] of each input, for the joint that is on it. `bad_frames` in a row are bridged.
pub fn max_steps<F: Felt<JOINTS>, const JOINTS: usize>(felt: &F, bad_frames: u32) -> [i32; JOINTS] {
    let (device, rate) = (felt.servo().device(), felt.servo().settings().rate_hz);
    let step = |encoder| max_step(&encoder, device.max_joint_rate_rad_per_s, rate, bad_frames);
    felt.wiring().inputs(device.encoders.map(step))
}

/// The most counts between two good readings that a hand can make: at `max_joint_rate` (rad/s), with up to `bad_frames`
/// between them at `rate` Hz, and two more for the encoder's own steps. A larger step is a glitch.
pub const fn max_step(encoder: &Encoder, max_joint_rate: f32, rate: f32, bad_frames: u32) -> i32 {
    let counts = max_joint_rate / rate / encoder.radians_per_count * (bad_frames as f32 + 1.0);
    // The cast saturates.
    (if counts < 0.0 { -counts } else { counts }) as i32 + 2
}
