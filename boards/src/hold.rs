//! Holds: reasons to keep the motors off that are no fault of the loop.

use crate::{Panel, Settings};
use palpate::device::SupplyRange;
use palpate::wire::hold;

/// Ticks in a row for which the supply must be out of its range: a single reading may be noise of the motors.
const SUPPLY_TICKS: u32 = 4;

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
    /// Readings of the supply in a row that were out of its range.
    out_of_range: u32,
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
            unexplained: None,
        }
    }

    /// A tick. `drives` is whether the motors were driven until now.
    #[inline]
    pub fn next(&mut self, panel: &Panel, drives: bool) -> Verdict {
        let mut verdict = Verdict::default();
        if panel.stop {
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
        match &mut self.unexplained {
            Some(0) => verdict.is_drive_fault = true,
            Some(left) => *left -= 1,
            None => {}
        }
        verdict
    }

    fn is_out_of_range(&mut self, volts: Option<f32>) -> bool {
        let Some(range) = self.supply else { return false };
        let within = volts.is_some_and(|volts| range.holds(volts));
        self.out_of_range = if within { 0 } else { self.out_of_range.saturating_add(1) };
        self.out_of_range >= SUPPLY_TICKS
    }
}
