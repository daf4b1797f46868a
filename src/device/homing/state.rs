//! How far homing has come, from tick to tick.

use super::Refusal;
use super::field_search::{FieldSearch, Sweep};
use super::stop_search::{Search, StopSearch};
use crate::device::{Aligned, Counts};

/// The search that is under way, for the first joint without a mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stage {
    /// For its stop.
    Stop(Search),
    /// For its field.
    Field(Sweep),
}

/// The state of homing, from tick to tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingState<const JOINTS: usize> {
    pub(super) ticks: u32,
    pub(super) still: u32,
    /// The counts against which standing still is judged: those of the last movement.
    pub(super) anchor: Option<[Counts; JOINTS]>,
    /// The results so far: counts, or a rotor's alignment to its field ([`Aligned::mark`]).
    pub(super) marks: [Option<Counts>; JOINTS],
    /// The search under way.
    pub(super) stage: Stage,
    /// The torque on that joint, N·m.
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
            stage: Stage::Stop(Search::default()),
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

    /// Pauses homing. Joints may move meanwhile, so the current stage starts again; results so far stay.
    pub(crate) fn pause(&mut self) {
        self.stage = match self.stage {
            Stage::Stop(search) => Stage::Stop(search.again()),
            Stage::Field(_) => Stage::Field(Sweep::default()),
        };
        self.torque = 0.0;
        (self.anchor, self.still) = (None, 0);
    }

    /// How each rotor stands to its field, as far as a search for fields has found that out.
    pub fn aligned(&self) -> [Aligned; JOINTS] {
        self.marks.map(|mark| Aligned::of_mark(mark.unwrap_or_default()))
    }

    /// The running search for a stop, or a new one.
    pub(super) fn search(&self) -> Search {
        if let Stage::Stop(search) = self.stage { search } else { Search::default() }
    }

    /// The running search for a field, or a new one.
    pub(super) fn sweep(&self) -> Sweep {
        if let Stage::Field(sweep) = self.stage { sweep } else { Sweep::default() }
    }

    /// The joint torques of homing, N·m; all zero except in a search for stops or fields.
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
        [self.ticks, self.still].into_iter().for_each(&mut hash);
        match &self.stage {
            Stage::Stop(search) => StopSearch::bits(search).into_iter().for_each(&mut hash),
            Stage::Field(sweep) => FieldSearch::bits(sweep).into_iter().for_each(&mut hash),
        }
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
