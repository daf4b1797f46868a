//! Whether the motors' supply is what it should be, and whether anybody still looks.

use crate::device::SupplyRange;
use crate::servo::Fault;

/// Seconds for which a measurement of the supply holds.
const FRESH: f32 = 0.1;

/// The range as the tick needs it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SupplyWatch {
    range: SupplyRange,
    fresh_ticks: u32,
}

impl SupplyWatch {
    pub(super) const fn new(range: SupplyRange, rate: f32) -> Self {
        Self { range, fresh_ticks: (FRESH * rate) as u32 }
    }

    /// A measurement: the fault if it is outside of the range. `age` counts ticks since the last one.
    pub(super) fn measured(&self, age: &mut u32, millivolts: u32) -> Result<(), Fault> {
        *age = 0;
        let good = self.range.min_mv <= millivolts && millivolts <= self.range.max_mv;
        if good { Ok(()) } else { Err(Fault::Supply) }
    }

    /// A tick: the fault if nobody has measured for too long.
    #[inline]
    pub(super) fn tick(&self, age: &mut u32) -> Result<(), Fault> {
        // A fault that is not looked at may stand for days.
        *age = age.saturating_add(1);
        if *age > self.fresh_ticks { Err(Fault::Supply) } else { Ok(()) }
    }
}
