//! An optional measurement of a motor's phase currents: overcurrent, a short and an open phase.

use crate::{Drives, NotObeyed};
use palpate::device::drive::{Field, Modulation};
use palpate::device::sensor::ErrorRate;
use palpate::device::{Duty, ElectricalAngle};

/// Measures the currents of a motor with three phases.
pub trait PhaseCurrents {
    /// The currents into the motor, A, over the last period of the pulse widths; `None` if they cannot be measured.
    fn amps(&mut self) -> Option<[f32; 3]>;
}

/// The limits of a motor's currents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentLimits {
    /// The maximum of a phase, A: well above the amplitude at full duty. Half of it may be missing from the sum of the
    /// three, which is zero where nothing leaks.
    pub max_a: f32,
    /// The current of another phase, A, from which on a phase without current is open: well above the measurement's
    /// noise.
    pub open_a: f32,
}

/// How a motor's currents are wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurrentFault {
    /// A phase has more than its maximum, or the three do not add up to zero: a short.
    Over,
    /// A phase has none where the field needs it: a wire is off, or a switch does not conduct. It shows under load only.
    Open,
    /// They were not measured.
    Unmeasured,
}

/// The check of the currents, tick by tick. Leaky buckets: no single good reading hides a fault.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurrentWatch {
    limits: CurrentLimits,
    over: ErrorRate<2>,
    unmeasured: ErrorRate<2>,
    open: [ErrorRate<6>; 3],
}

impl CurrentWatch {
    /// Two bad readings in a row of about four.
    const MOST_SHORT: u32 = 4_000;
    /// 45 bad readings in a row, of about 64: 11 ms at 4 kHz.
    const MOST_OPEN: u32 = 5_000;

    /// Nothing seen yet.
    pub const fn new(limits: CurrentLimits) -> Self {
        Self { limits, over: ErrorRate::START, unmeasured: ErrorRate::START, open: [ErrorRate::START; 3] }
    }

    /// A tick under a field at this angle.
    #[inline]
    pub fn next(&mut self, field: ElectricalAngle, amps: Option<[f32; 3]>) -> Result<(), CurrentFault> {
        self.unmeasured = self.unmeasured.next(amps.is_none());
        if self.unmeasured.is_above(Self::MOST_SHORT) {
            return Err(CurrentFault::Unmeasured);
        }
        let Some(amps) = amps else { return Ok(()) };
        let CurrentLimits { max_a, open_a } = self.limits;
        let [a, b, c] = amps.map(f32::abs);
        let most = if a > b { a } else { b };
        let most = if c > most { c } else { most };
        let leaks = (amps[0] + amps[1] + amps[2]).abs();
        // False for NaN.
        let is_within = most <= max_a && leaks <= 0.5 * max_a;
        self.over = self.over.next(!is_within);
        if self.over.is_above(Self::MOST_SHORT) {
            return Err(CurrentFault::Over);
        }
        if most > open_a {
            let widths = Modulation::IDEAL.widths(Field::at_rest(field), Duty::FULL);
            let mean = (widths[0] + widths[1] + widths[2]) / 3.0;
            for ((open, current), width) in self.open.iter_mut().zip([a, b, c]).zip(widths) {
                // The field needs more than a third of its amplitude, 0.577, of this phase.
                if (width - mean).abs() > 0.19 {
                    *open = open.next(current < 0.1 * most);
                    if open.is_above(Self::MOST_OPEN) {
                        return Err(CurrentFault::Open);
                    }
                }
            }
        }
        Ok(())
    }
}

/// A stage whose motor's currents are watched: it follows no command once they are wrong, which the loop latches as a
/// fault of the drive.
#[derive(Debug)]
pub struct CurrentWatched<D, C> {
    drives: D,
    currents: C,
    watch: CurrentWatch,
    field: Option<ElectricalAngle>,
    /// Whether it was driven until now, in this field.
    driven: Option<ElectricalAngle>,
    fault: Option<CurrentFault>,
}

impl<D, C> CurrentWatched<D, C> {
    /// This stage and its measurement.
    pub const fn new(drives: D, currents: C, limits: CurrentLimits) -> Self {
        Self { drives, currents, watch: CurrentWatch::new(limits), field: None, driven: None, fault: None }
    }

    /// The first fault of the currents since the reset.
    pub const fn fault(&self) -> Option<CurrentFault> {
        self.fault
    }
}

impl<D: Drives<1>, C: PhaseCurrents> Drives<1> for CurrentWatched<D, C> {
    #[inline]
    fn aim(&mut self, fields: [Field; 1]) {
        let [field] = fields;
        self.field = Some(field.angle);
        self.drives.aim(fields);
    }

    #[inline]
    fn apply(&mut self, duties: [Duty; 1]) -> Result<(), NotObeyed> {
        if let Some(field) = self.driven
            && let Err(fault) = self.watch.next(field, self.currents.amps())
        {
            self.fault = self.fault.or(Some(fault));
        }
        if self.fault.is_some() {
            return Err(NotObeyed);
        }
        self.driven = self.field;
        self.drives.apply(duties)
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        self.driven = None;
        self.drives.release()
    }

    #[inline]
    fn reads_enabled(&self) -> bool {
        self.drives.reads_enabled()
    }
}
