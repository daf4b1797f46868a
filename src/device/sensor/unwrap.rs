//! Counters and angles that wrap round, counted on.

use super::Jumped;
use crate::device::Counts;

/// Counts on over the wrap of a number of `BITS` bits, 1 to 32: a timer that counts an encoder, or the angle of a
/// single-turn sensor.
///
/// Between two readings the position must move less than half the range, or the way round is unknown; a smaller maximum
/// step tells a glitch from motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unwrap<const BITS: u32> {
    max_step: i32,
    last: Option<u32>,
    total: i32,
}

/// A 16-bit timer in encoder mode.
pub type TimerCount = Unwrap<16>;
/// A 14-bit angle: AS5047P, AS5048A, MT6701.
pub type TurnCount = Unwrap<14>;

impl<const BITS: u32> Unwrap<BITS> {
    /// The count starts from the first reading. A step beyond `max_step` counts between two readings is refused.
    pub const fn new(max_step: i32) -> Self {
        const { assert!(BITS >= 1 && BITS <= 32) };
        Self { max_step, last: None, total: 0 }
    }

    /// The count after a reading, of which the lower `BITS` bits are used. The count itself wraps at 32 bits.
    ///
    /// # Errors
    /// A step that no hand makes. The reading is dropped: the next one is measured against the last good one.
    pub fn count(&mut self, reading: u32) -> Result<Counts, Jumped> {
        const { assert!(BITS >= 1 && BITS <= 32) };
        let unused = 32 - BITS;
        let Some(last) = self.last else {
            self.last = Some(reading);
            self.total = (reading << unused >> unused) as i32;
            return Ok(Counts(self.total));
        };
        // Up to the top bit and down again carries the sign.
        let step = (reading.wrapping_sub(last) << unused) as i32 >> unused;
        if step.saturating_abs() > self.max_step {
            return Err(Jumped { by: step });
        }
        self.last = Some(reading);
        self.total = self.total.wrapping_add(step);
        Ok(Counts(self.total))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_timer_counts_on_over_its_wrap_both_ways() {
        let mut timer = TimerCount::new(2_000);
        let mut place: i32 = 300;
        let (mut least, mut most) = (0, 0);
        assert_eq!(timer.count(300), Ok(Counts(300)));
        for tick in 0..2_000 {
            place += if tick < 1_200 { -997 } else { 1_501 };
            assert_eq!(timer.count(place as u32 & 0xffff), Ok(Counts(place)));
            (least, most) = (least.min(place), most.max(place));
        }
        assert!(least < -1_000_000 && most > 4_000, "it wrapped many times: {least} {most}");
    }

    #[test]
    fn an_angle_counts_turns_and_refuses_a_jump_without_losing_its_place() {
        let mut turns = TurnCount::new(100);
        assert_eq!(turns.count(16_380), Ok(Counts(16_380)));
        assert_eq!(turns.count(20), Ok(Counts(16_404)));
        assert_eq!(turns.count(500), Err(Jumped { by: 480 }));
        assert_eq!(turns.count(16_304), Ok(Counts(16_304)));
        assert_eq!(turns.count(16_300), Ok(Counts(16_300)));
    }

    #[test]
    fn the_whole_range_of_32_bits_wraps() {
        let mut wide = Unwrap::<32>::new(i32::MAX);
        assert_eq!(wide.count(u32::MAX), Ok(Counts(-1)));
        assert_eq!(wide.count(5), Ok(Counts(5)));
        // Half way round is no way at all: |−2³¹| saturates to the greatest step, and the count wraps.
        assert!(wide.count(5_u32.wrapping_add(1 << 31)).is_ok());
    }
}
