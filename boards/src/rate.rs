//! Numbers of an image that depend on its rate. A rate that the board does not bear is a compile error.

use palpate::body::Effort;

/// Records a second, which 500,000 baud carry.
pub const RECORDS_HZ: u32 = 200;

/// Modelled cycles of the worst tick at [`Effort::BENCH`] on the capped box: 7,000 instructions of 1.9.
const BENCH_CYCLES: u32 = 13_300;

/// Counts of a timer in a tick.
///
/// # Panics
/// At compile time, for a rate that the timer does not make exactly: deadlines and filters count on it.
pub const fn tick_counts(clock_hz: u32, rate_hz: u32) -> u32 {
    assert!(clock_hz.is_multiple_of(rate_hz), "the timer's clock must be a whole multiple of the servo rate");
    clock_hz / rate_hz
}

/// Work of the tracker in a tick of a core: that of the bench boards where it takes three quarters of the period at
/// most, else one of each.
pub const fn effort(core_hz: u32, rate_hz: u32) -> Effort {
    if core_hz / rate_hz / 4 * 3 >= BENCH_CYCLES { Effort::BENCH } else { Effort::ONE }
}

/// Ticks at no width before a direction turns, which last `periods` of the pulse width and half a tick at least: a width
/// holds from the next period on, and a tick may come early.
///
/// # Panics
/// At compile time, for more than a drive counts.
pub const fn dwell(rate_hz: u32, carrier_hz: u32, periods: u32) -> u8 {
    let ticks = (2 * periods * rate_hz + carrier_hz) / (2 * carrier_hz) + 1;
    assert!(ticks <= u8::MAX as u32, "the pulse width is too slow for this servo rate");
    ticks as u8
}
