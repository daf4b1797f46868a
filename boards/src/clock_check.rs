//! The clock of the loop against another of the chip's own.

use crate::Counter;
use thiserror::Error;

/// The loop's clock is off, or the one that it is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("two clocks of the chip disagree")]
pub struct ClocksDisagree;

/// A fifth: an oscillator within the chip has up to a tenth, and the loop bears far more.
const TOLERANCE: u64 = 5;
/// Comparisons a second.
const RATE_HZ: u32 = 32;
/// The bits of the other clock's counter that every chip has.
const BITS: u32 = 0xffff;

/// The loop's counter, and that of a clock with an oscillator of its own. Main compares them.
#[derive(Debug)]
pub struct ClockCheck<C, R> {
    clock: C,
    reference: R,
    clock_hz: u32,
    reference_hz: u32,
    began: Option<(u32, u32)>,
}

impl<C: Counter, R: Counter> ClockCheck<C, R> {
    /// These counters, of these frequencies, Hz. At least 16 bits of the reference count.
    pub fn new((clock, clock_hz): (C, u32), (reference, reference_hz): (R, u32)) -> Self {
        Self { clock, reference, clock_hz, reference_hz, began: None }
    }

    /// A turn of main. They are compared 32 times a second.
    ///
    /// # Errors
    /// The two are further apart than a fifth, or the reference stands still. If the loop's own clock stands still, its
    /// ticks are a fault.
    pub fn step(&mut self) -> Result<(), ClocksDisagree> {
        let (now, reference) = (self.clock.now(), self.reference.now());
        let (began, reference_began) = *self.began.get_or_insert((now, reference));
        let counts = now.wrapping_sub(began);
        if counts < self.clock_hz / RATE_HZ {
            return Ok(());
        }
        self.began = Some((now, reference));
        let passed = u64::from(reference.wrapping_sub(reference_began) & BITS);
        let expected = passed * u64::from(self.clock_hz) / u64::from(self.reference_hz);
        let is_off = u64::from(counts).abs_diff(expected) > expected / TOLERANCE;
        if is_off { Err(ClocksDisagree) } else { Ok(()) }
    }
}
