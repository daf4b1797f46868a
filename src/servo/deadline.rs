//! Whether ticks come in time, and whether they come at all.

/// The time a tick may take, in counts of the board's free-running counter (cycles, timer ticks).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Deadline {
    /// The most counts from the tick's interrupt to the duties applied.
    pub counts: u32,
}

impl Deadline {
    /// The deadline of a loop at `rate` Hz timed by a counter of `frequency` Hz: one period.
    pub const fn of_period(frequency: f32, rate: f32) -> Self {
        Self { counts: (frequency / rate) as u32 }
    }

    /// Whether a tick that began and ended at these counts came too late. The counter may wrap once between.
    pub const fn overrun(self, began: u32, ended: u32) -> bool {
        ended.wrapping_sub(began) > self.counts
    }
}

/// Decides whether the hardware watchdog may be fed: only where ticks have gone on since it was fed last.
///
/// Feed it from the idle loop with this, never from the tick's own interrupt: then either of the two that hangs is
/// found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Heartbeat {
    ticks: u32,
}

impl Heartbeat {
    /// Whether to feed, from [`super::ServoState::ticks`].
    pub const fn may_feed(&mut self, ticks: u32) -> bool {
        let beats = ticks != self.ticks;
        self.ticks = ticks;
        beats
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_late_beyond_its_period_also_where_the_counter_wraps() {
        let deadline = Deadline::of_period(168e6, 4_000.0);
        assert_eq!(deadline.counts, 42_000);
        assert!(!deadline.overrun(10, 42_010) && deadline.overrun(10, 42_011));
        assert!(!deadline.overrun(u32::MAX - 9, 41_990) && deadline.overrun(u32::MAX - 9, 41_991));
    }

    #[test]
    fn the_watchdog_starves_when_ticks_stop() {
        let mut heartbeat = Heartbeat::default();
        assert!(heartbeat.may_feed(5) && heartbeat.may_feed(6));
        assert!(!heartbeat.may_feed(6));
    }
}
