//! Delays that are counted, not guessed.

use embedded_hal::delay::DelayNs;

/// A counter that runs freely, rises and wraps at 32 bits. On a board it is a timer that no debugger stops; the core's
/// own cycle counter is none: a debugger that detaches switches it off.
pub trait Counter {
    /// The count.
    fn now(&self) -> u32;
}

/// Waits by the counter. At least as long as asked, and longer by the few cycles of looking. If the counter stands
/// still, it waits for as many looks as it should see counts, and the loop finds the fault: a look reads a register on a
/// bus that is no faster than the counter, so it takes a count or more.
#[derive(Clone, Copy, Debug)]
pub struct CycleDelay<C> {
    counter: C,
    /// Counts a nanosecond, rounded up, in units of 2⁻²⁸. A sensor's select line keeps its times within the tick, where
    /// a product takes a few instructions and a quotient of 64 bits more than a hundred.
    counts_per_ns_q28: u32,
}

impl<C: Counter> CycleDelay<C> {
    /// Delays by a counter of this frequency, Hz.
    pub const fn new(counter: C, frequency: u32) -> Self {
        Self { counter, counts_per_ns_q28: ((frequency as u64) << 28).div_ceil(1_000_000_000) as u32 }
    }

    /// How many counts last at least this number of nanoseconds, whatever the counter's own step: two more than that
    /// at most, and one more for each quarter of a second.
    pub const fn counts(&self, nanoseconds: u32) -> u32 {
        let whole = nanoseconds as u64 * self.counts_per_ns_q28 as u64;
        // One more: the first may be over as soon as it is read.
        let counts = (whole >> 28) + 2;
        if counts > u32::MAX as u64 { u32::MAX } else { counts as u32 }
    }
}

impl<C: Counter> DelayNs for CycleDelay<C> {
    #[inline]
    fn delay_ns(&mut self, nanoseconds: u32) {
        let (began, counts) = (self.counter.now(), self.counts(nanoseconds));
        let _ = (0..counts).any(|_| self.counter.now().wrapping_sub(began) >= counts);
    }
}
