//! A tick of homing, whichever way it goes.

use super::field_search::{Led, Sweep};
use super::state::Stage;
use super::stop_search::{Joint, Search, Seek};
use super::{FieldSearch, Homing, HomingInput, HomingProgress, HomingState, Reference, Refusal, StopSearch};
use crate::device::{Aligned, Counts, ElectricalAngle, Encoder};

/// Joint angle at zero counts, if the joint is at `angle` at `counts`.
fn calibrated(encoder: Encoder, angle: f32, counts: Counts) -> Encoder {
    Encoder { angle_at_zero_rad: angle - counts.0 as f32 * encoder.radians_per_count, ..encoder }
}

impl<const JOINTS: usize> Homing<JOINTS> {
    /// One tick. Once done or refused, nothing changes any more.
    pub fn tick(&self, state: &mut HomingState<JOINTS>, input: HomingInput<JOINTS>) -> HomingProgress<JOINTS> {
        if state.end.is_none() {
            state.end = self.next(state, input);
            state.ticks = state.ticks.saturating_add(1);
        }
        match state.end {
            None => HomingProgress::Waiting,
            Some(Err(refusal)) => HomingProgress::Refused(refusal),
            Some(Ok(())) => HomingProgress::Done(self.calibrated(&state.marks)),
        }
    }

    /// The encoders, with each joint at its reference angle at its mark.
    fn calibrated(&self, marks: &[Option<Counts>; JOINTS]) -> [Encoder; JOINTS] {
        let mut encoders = self.encoders;
        for (joint, (encoder, mark)) in encoders.iter_mut().zip(marks).enumerate() {
            let angle = match &self.reference {
                Reference::Pose(angles) | Reference::KnownPose { angles, .. } | Reference::Index(angles) => {
                    angles[joint]
                }
                Reference::Stops(searches) => searches[joint].angle_rad,
                // Nothing is found out about angles.
                Reference::Fields(_) => continue,
            };
            if let Some(mark) = mark {
                *encoder = calibrated(*encoder, angle, *mark);
            }
        }
        encoders
    }

    /// Takes note of an index mark that a joint passed at a count, between two ticks. Other ways of homing have no
    /// marks.
    pub fn pass_index(&self, state: &mut HomingState<JOINTS>, joint: usize, counts: Counts) {
        if let (Reference::Index(_), Some(mark)) = (&self.reference, state.marks.get_mut(joint)) {
            *mark = mark.or(Some(counts));
        }
    }

    /// Drives the first joint that has not found its stop yet.
    fn search(
        &self,
        searches: &[StopSearch; JOINTS],
        state: &mut HomingState<JOINTS>,
        counts: [Counts; JOINTS],
        input: &HomingInput<JOINTS>,
        too_late: bool,
    ) -> Option<Result<(), Refusal>> {
        state.torque = 0.0;
        let Some(joint) = state.marks.iter().position(Option::is_none) else { return Some(Ok(())) };
        if too_late {
            return Some(Err(Refusal::TooLate));
        }
        let known = Joint {
            encoder: self.encoders[joint],
            counts: counts[joint],
            rate: input.rates[joint],
            period: input.period,
        };
        let mut search = state.search();
        let sought = searches[joint].step(&mut search, &known, self.still_ticks, self.still_counts);
        state.stage = Stage::Stop(search);
        match sought {
            Seek::Drive(torque) => state.torque = torque,
            Seek::Found(mark) => (state.marks[joint], state.stage) = (Some(mark), Stage::Stop(Search::default())),
            Seek::Refused(refusal) => return Some(Err(refusal)),
        }
        None
    }

    /// Leads the field of the first joint that is not aligned yet.
    fn lead(
        &self,
        searches: &[FieldSearch; JOINTS],
        state: &mut HomingState<JOINTS>,
        counts: [Counts; JOINTS],
        too_late: bool,
    ) -> Option<Result<(), Refusal>> {
        state.torque = 0.0;
        let Some(joint) = state.marks.iter().position(Option::is_none) else { return Some(Ok(())) };
        if too_late {
            return Some(Err(Refusal::TooLate));
        }
        let mut sweep = state.sweep();
        let led = searches[joint].step(&mut sweep, counts[joint]);
        state.stage = Stage::Field(sweep);
        match led {
            Led::Drive(torque) => state.torque = torque,
            Led::Found(aligned) => {
                (state.marks[joint], state.stage) = (Some(aligned.mark()), Stage::Field(Sweep::default()));
            }
            Led::Refused(refusal) => return Some(Err(refusal)),
        }
        None
    }

    /// Where the field of each motor is to be, for the duties of this tick and the joints at these counts: where it is
    /// led while that is found out, and a quarter turn ahead of the rotor from then on. `None` for motors that do not
    /// have three phases.
    #[inline]
    pub fn fields(&self, state: &HomingState<JOINTS>, counts: [Counts; JOINTS]) -> Option<[ElectricalAngle; JOINTS]> {
        let Reference::Fields(searches) = &self.reference else { return None };
        let mut fields = [ElectricalAngle(0); JOINTS];
        for (joint, field) in fields.iter_mut().enumerate() {
            *field = match state.marks[joint] {
                Some(mark) => searches[joint].commutation.field(Aligned::of_mark(mark), counts[joint]),
                None => searches[joint].field(&state.sweep()),
            };
        }
        Some(fields)
    }

    /// How it ended in this tick, if it did.
    fn next(&self, state: &mut HomingState<JOINTS>, input: HomingInput<JOINTS>) -> Option<Result<(), Refusal>> {
        let Some(counts) = input.counts else {
            return Some(Err(Refusal::Sensor));
        };
        let too_late = state.ticks.saturating_add(1) >= self.timeout_ticks;
        if let Reference::Stops(searches) = &self.reference {
            return self.search(searches, state, counts, &input, too_late);
        }
        if let Reference::Fields(searches) = &self.reference {
            return self.lead(searches, state, counts, too_late);
        }
        if let Reference::Index(_) = &self.reference {
            for (mark, index) in state.marks.iter_mut().zip(input.index) {
                // The first pass counts; a later one says nothing new.
                *mark = mark.or(index);
            }
            return match (state.marks.iter().all(Option::is_some), too_late) {
                (true, _) => Some(Ok(())),
                (false, true) => Some(Err(Refusal::NoIndex)),
                (false, false) => None,
            };
        }

        let within = |reach: u32, from: &[Counts; JOINTS]| {
            counts.iter().zip(from).all(|(Counts(now), Counts(then))| now.abs_diff(*then) <= reach)
        };
        if state.anchor.as_ref().is_some_and(|anchor| within(self.still_counts, anchor)) {
            state.still = state.still.saturating_add(1);
        } else {
            state.anchor = Some(counts);
            state.still = 0;
        }
        if state.still < self.still_ticks {
            return if too_late { Some(Err(Refusal::Moving)) } else { None };
        }
        if let Reference::KnownPose { counts: known, tolerance, .. } = &self.reference
            && !within(*tolerance, known)
        {
            return Some(Err(Refusal::OutOfTolerance));
        }
        state.marks = counts.map(Some);
        Some(Ok(()))
    }
}
