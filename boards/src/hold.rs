//! Holds: reasons to keep the motors off that are no fault of the loop.

use crate::interlock::ticks;
use crate::{Panel, Settings};
use palpate::device::SupplyRange;
use palpate::wire::hold;

/// Seconds for which the supply must be too low, or not measured, four ticks at least: a single reading may be noise of
/// the motors. A reading above the range counts at once.
const SUPPLY_S: f32 = 0.001;
const SUPPLY_TICKS: u32 = 4;
/// A reading out of range adds this to the count of them; one within takes 1 away. More than a quarter of bad readings
/// then holds.
const BAD: u32 = 3;
/// Seconds without a break in which nothing may hold before a hold ends: the contact of a stop button chatters too.
const CLEAR_S: f32 = 0.025;

/// Looks at the panel, tick by tick.
///
/// A supply that is out of its range is no fault either: an emergency stop takes it away. (Where a servo guards itself,
/// without this loop, it is: see [`SupplyRange`].)
///
/// An amplifier that is not ready is no fault by itself: it may have no supply yet, or stop has been pressed. Where it
/// was driving, stop or the supply must say so within a moment, for contactors are slow and capacitors hold; otherwise
/// the amplifier has a fault of its own. The motors are off from the first tick.
#[derive(Clone, Copy, Debug)]
pub struct Hold {
    supply: Option<SupplyRange>,
    grace: u32,
    /// Readings of the supply that were out of its range, [`BAD`] each, less those that were within.
    out_of_range: u32,
    /// The count of them that holds.
    max_out_of_range: u32,
    /// The last holds, and the ticks without any that are missing before they end.
    last: u8,
    clear_in: u32,
    clear_ticks: u32,
    /// Ticks for which stop must still be pressed before the first force.
    untested: u32,
    /// Ticks left in which somebody may say why an amplifier is no longer ready.
    unexplained: Option<u32>,
}

/// The result of a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Verdict {
    /// The holds, as bits ([`palpate::wire::hold`]); 0 is nothing.
    pub hold: u8,
    /// An amplifier has a fault of its own.
    pub is_drive_fault: bool,
}

impl Hold {
    /// Nothing held yet, in a loop of `rate` Hz.
    pub const fn new(settings: &Settings, rate: f32) -> Self {
        Self {
            supply: settings.supply,
            // The cast saturates.
            grace: (settings.ready_grace * rate) as u32,
            out_of_range: 0,
            max_out_of_range: BAD
                * if SUPPLY_TICKS > ticks(SUPPLY_S, rate) { SUPPLY_TICKS } else { ticks(SUPPLY_S, rate) },
            last: 0,
            clear_in: 0,
            clear_ticks: ticks(CLEAR_S, rate),
            untested: if settings.tests_stop { ticks(CLEAR_S, rate) } else { 0 },
            unexplained: None,
        }
    }

    /// A tick. `drives` is whether the motors were driven until now.
    #[inline]
    pub fn next(&mut self, panel: &Panel, drives: bool) -> Verdict {
        let mut verdict = Verdict::default();
        if self.untested > 0 {
            self.untested = if panel.stop { self.untested - 1 } else { self.clear_ticks };
        }
        if panel.stop || self.untested > 0 {
            verdict.hold |= hold::STOP;
        }
        if self.is_out_of_range(panel.supply) {
            verdict.hold |= hold::SUPPLY;
        }
        let is_explained = verdict.hold != 0;
        if panel.ready || is_explained {
            self.unexplained = None;
        } else if drives && self.unexplained.is_none() {
            // Once: damping after a fault goes on asking for the motors all the while.
            self.unexplained = Some(self.grace);
        }
        if !panel.ready {
            verdict.hold |= hold::NOT_READY;
        }
        if panel.enable_disagrees {
            verdict.hold |= hold::ENABLE;
        }
        match &mut self.unexplained {
            Some(0) => verdict.is_drive_fault = true,
            Some(left) => *left -= 1,
            None => {}
        }
        if verdict.hold != 0 {
            (self.last, self.clear_in) = (verdict.hold, self.clear_ticks);
        } else if self.clear_in > 0 {
            self.clear_in -= 1;
            verdict.hold = self.last;
        }
        verdict
    }

    fn is_out_of_range(&mut self, volts: Option<f32>) -> bool {
        let Some(range) = self.supply else { return false };
        self.out_of_range = match volts {
            // Energy comes back from the motors: it is too late in four ticks.
            Some(volts) if range.is_above(volts) => self.max_out_of_range,
            Some(volts) if range.holds(volts) => self.out_of_range.saturating_sub(1),
            _ => self.max_out_of_range.min(self.out_of_range + BAD),
        };
        self.out_of_range >= self.max_out_of_range
    }
}
