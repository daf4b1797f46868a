//! Sensor frames that could not be read, bridged by the velocity estimate.

use super::{Guard, Input, Phase, Servo, ServoState, Surface};
use crate::device::{Counts, Kinematics};

/// Puts a prediction in the place of a few bad frames in a row: the last good counts, carried on at the rates estimated
/// then. The next bad one reaches the loop as it came, and is a fault in that tick.
///
/// **This is the one exception to "a fault in the same tick".** A motor's switching spoils a frame of a digital sensor
/// now and then; a hand that is let go of for that feels a blow. For two ticks, half a millisecond at 4 kHz, a hand at
/// 1 m/s that brakes with 20 m/s² comes 2.5 µm nearer than predicted: less than a count. After a fault, and before the
/// first counts, nothing is bridged.
///
/// It stands before [`Servo::tick`]; a loop without it has no exception.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FrameBridge<const JOINTS: usize> {
    max_in_a_row: u32,
    in_a_row: u32,
    total: u32,
    /// The last good counts, and counts a tick.
    from: ([Counts; JOINTS], [f32; JOINTS]),
}

impl<const JOINTS: usize> FrameBridge<JOINTS> {
    /// How many bad frames in a row are bridged unless you choose.
    pub const DEFAULT_IN_A_ROW: u32 = 2;

    /// A bridge over at most so many bad frames in a row; 0 bridges none.
    pub const fn new(max_in_a_row: u32) -> Self {
        Self { max_in_a_row, in_a_row: 0, total: 0, from: ([Counts(0); JOINTS], [0.0; JOINTS]) }
    }

    /// Bad frames bridged so far.
    pub const fn total(&self) -> u32 {
        self.total
    }

    /// What the tick starts from: `input` as it came, or a prediction in its place, with `enable` as it is now.
    #[inline]
    pub fn input<S: Surface, K: Kinematics<JOINTS>, G: Guard<JOINTS>>(
        &mut self,
        servo: &Servo<'_, S, K, JOINTS, G>,
        state: &ServoState<JOINTS, S::Witness, G::State>,
        input: Input<JOINTS>,
        enable: bool,
    ) -> Input<JOINTS> {
        if matches!(input, Input::Sensors { .. }) {
            self.in_a_row = 0;
            return input;
        }
        let Some(counts) = state.counts() else { return input };
        if self.in_a_row >= self.max_in_a_row || state.phase() == Phase::Fault {
            return input;
        }
        if self.in_a_row == 0 {
            let mut steps = state.rates();
            for (step, encoder) in steps.iter_mut().zip(&servo.device.encoders) {
                *step *= servo.period / encoder.radians_per_count;
            }
            self.from = (counts, steps);
        }
        self.in_a_row += 1;
        self.total = self.total.wrapping_add(1);
        let (mut counts, steps) = self.from;
        for (Counts(count), step) in counts.iter_mut().zip(steps) {
            let moved = step * self.in_a_row as f32;
            // To nearest: the cast truncates. It saturates, and makes a NaN 0.
            *count = count.wrapping_add((moved + if moved < 0.0 { -0.5 } else { 0.5 }) as i32);
        }
        Input::Sensors { counts, enable }
    }
}
