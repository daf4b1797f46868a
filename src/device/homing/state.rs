//! How far homing has come, from tick to tick.

use super::Refusal;
use super::stop_search::{Search, StopSearch};
use crate::device::Counts;

/// What changes from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingState<const JOINTS: usize> {
    pub(super) ticks: u32,
    pub(super) still: u32,
    /// What the device moved away from last.
    pub(super) anchor: Option<[Counts; JOINTS]>,
    pub(super) marks: [Option<Counts>; JOINTS],
    /// The search for the stop of the first joint without a mark.
    pub(super) search: Search,
    /// What that joint is driven with, N·m.
    pub(super) torque: f32,
    pub(super) end: Option<Result<(), Refusal>>,
}

impl<const JOINTS: usize> Default for HomingState<JOINTS> {
    fn default() -> Self {
        Self {
            ticks: 0,
            still: 0,
            anchor: None,
            marks: [None; JOINTS],
            search: Search::default(),
            torque: 0.0,
            end: None,
        }
    }
}

impl<const JOINTS: usize> HomingState<JOINTS> {
    /// Whether homing is done.
    pub const fn is_done(&self) -> bool {
        matches!(self.end, Some(Ok(())))
    }

    /// Homing waits, and who knows where the joints go meanwhile: the stage it was in begins anew. What it has found
    /// stays.
    pub(crate) fn pause(&mut self) {
        self.search = self.search.again();
        self.torque = 0.0;
        (self.anchor, self.still) = (None, 0);
    }

    /// The joint torques that homing asks for, N·m; all zero but in a search for stops.
    pub fn torques(&self) -> [f32; JOINTS] {
        let mut torques = [0.0; JOINTS];
        let sought = torques.iter_mut().zip(&self.marks).find(|(_, mark)| mark.is_none());
        if let Some((torque, _)) = sought {
            *torque = self.torque;
        }
        torques
    }

    /// Why homing was refused, if it was.
    pub const fn refusal(&self) -> Option<Refusal> {
        match self.end {
            Some(Err(refusal)) => Some(refusal),
            Some(Ok(())) | None => None,
        }
    }

    /// Gives every word of the state to `hash`.
    pub(crate) fn words(&self, mut hash: impl FnMut(u32)) {
        [self.ticks, self.still].into_iter().chain(StopSearch::bits(&self.search)).for_each(&mut hash);
        self.anchor.iter().flatten().for_each(|Counts(count)| hash(*count as u32));
        for mark in self.marks {
            hash(mark.map_or(u32::MAX, |Counts(count)| count as u32));
        }
        hash(self.torque.to_bits());
        hash(match self.end {
            None => 0,
            Some(Ok(())) => 0x100,
            Some(Err(refusal)) => u32::from(refusal.code()),
        });
    }
}
