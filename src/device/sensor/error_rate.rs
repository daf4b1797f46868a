//! The rate of errors, by a leaky bucket.

/// The fraction of events that were errors, over the last `2^SHIFT` or so: each event lets a `2^SHIFT`th leak out, each
/// error adds as much of full scale. Unlike a count of errors in a row, single good events do not clear it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ErrorRate<const SHIFT: u32> {
    /// 2⁻³².
    level: u32,
}

impl<const SHIFT: u32> ErrorRate<SHIFT> {
    /// No error yet.
    pub const START: Self = Self { level: 0 };

    /// The rate after one more event.
    #[inline]
    pub const fn next(self, is_error: bool) -> Self {
        const { assert!(SHIFT >= 1 && SHIFT <= 16) };
        let left = self.level - (self.level >> SHIFT);
        Self { level: if is_error { left.saturating_add(1 << (32 - SHIFT)) } else { left } }
    }

    /// Whether the rate is above a fraction, in 10,000ths, 0 to 10,000.
    #[inline]
    pub const fn is_above(self, per_10_000: u32) -> bool {
        // The first factor is a constant where the limit is one.
        self.level > per_10_000.saturating_mul(429_497)
    }

    /// The rate, errors in 10,000 events.
    pub const fn per_10_000(self) -> u16 {
        // At most 10,000.
        (self.level / 429_497) as u16
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_low_pass_of_the_errors() {
        let (mut rate, mut expected) = (ErrorRate::<10>::START, 0.0_f64);
        for event in 0..20_000_u32 {
            let is_error = event % 3 > 0 && event < 4_000 || event % 100 == 0;
            rate = rate.next(is_error);
            expected += (f64::from(u8::from(is_error)) - expected) / 1_024.0;
            // Rounding down by 2⁻³² an event, over 1,024 of them, and to a 10,000th.
            assert!((f64::from(rate.per_10_000()) - expected * 1e4).abs() < 1.1, "{event}: {rate:?} {expected}");
        }
        let all = (0..100_000).fold(rate, |rate, _| rate.next(true));
        assert!(all.is_above(9_990) && all.per_10_000() <= 10_000, "{all:?}");
        assert_eq!((0..100_000).fold(all, |rate, _| rate.next(false)).per_10_000(), 0);
    }
}
