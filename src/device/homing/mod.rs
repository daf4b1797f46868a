//! Where the joints are to begin with: from raw counts to calibrated encoders.

mod field_search;
mod refusal;
mod state;
mod stop_search;

pub use field_search::FieldSearch;
pub use refusal::Refusal;
pub use state::HomingState;
pub use stop_search::StopSearch;

use super::{Aligned, Counts, ElectricalAngle, Encoder};
use field_search::{Led, Sweep};
use state::Stage;
use stop_search::{Joint, Search, Seek};
use thiserror::Error;

/// What is known of the joints at a pose that can be recognised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reference<const JOINTS: usize> {
    /// The hand holds the device still in a mechanical reference pose, at these joint angles, radians.
    Pose([f32; JOINTS]),
    /// As a pose, with absolute sensors that must read these counts there, give or take the tolerance: what is kept
    /// from assembly tells a device that was put down wrong, or put together wrong.
    KnownPose {
        /// Joint angles at the pose, radians.
        angles: [f32; JOINTS],
        /// What the sensors read there.
        counts: [Counts; JOINTS],
        /// How far off they may be, counts.
        tolerance: u32,
    },
    /// Each joint passes its index mark once, at this joint angle, radians; the hand moves the device about meanwhile.
    Index([f32; JOINTS]),
    /// The motors drive one joint after the other to its end stop, while the others hang free.
    Stops([StopSearch; JOINTS]),
    /// The motors have three phases, and lead one joint after the other round with their fields: how each rotor stands
    /// to its field is found out, and [`Homing::fields`] says from then on where each field is to be. The joints'
    /// angles stay what the encoders say.
    Fields([FieldSearch; JOINTS]),
}

/// What an encoder's [`Encoder::angle_at_zero`] is the joint's angle at: a number that was measured for one of them
/// says nothing of another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ZeroOf {
    /// Count zero, of sensors that know it after each reset.
    #[default]
    Count,
    /// The pose in which the device is homed ([`Reference::Pose`]).
    Pose,
    /// The joint's index mark ([`Reference::Index`]).
    Mark,
}

/// How a device finds its joint angles. Constant, in flash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homing<const JOINTS: usize> {
    encoders: [Encoder; JOINTS],
    reference: Reference<JOINTS>,
    still_ticks: u32,
    still_counts: u32,
    timeout_ticks: u32,
    when_asked: bool,
}

/// Which number of the homing is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum HomingError {
    /// A reference angle is not finite.
    #[error("a reference angle is not finite")]
    Angle,
    /// It must hold still for at least a tick.
    #[error("it must hold still for at least a tick")]
    StillTicks,
    /// A search for a stop has a number that is not finite, or not positive.
    #[error("a search for a stop needs finite numbers, a speed, and a positive torque, clearance and travel")]
    Stop,
    /// The time allowed is too short to hold still in.
    #[error("the timeout is not longer than the time to hold still")]
    TimeoutTicks,
    /// A search for a field has a number that makes no sense, or takes longer than is allowed.
    #[error("a search for a field needs a positive torque, times, pole pairs, and more time than it takes")]
    Field,
}

/// What a tick of homing starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomingInput<const JOINTS: usize> {
    /// This tick's counts; `None` if a sensor failed.
    pub counts: Option<[Counts; JOINTS]>,
    /// The counts at which a joint passed its index mark, if it did since the last tick.
    pub index: [Option<Counts>; JOINTS],
    /// Joint rates as estimated, rad/s.
    pub rates: [f32; JOINTS],
    /// The time since the last tick, s.
    pub period: f32,
}

/// How far homing has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HomingProgress<const JOINTS: usize> {
    /// Not there yet.
    Waiting,
    /// The encoders, calibrated.
    Done([Encoder; JOINTS]),
    /// It will not be done.
    Refused(Refusal),
}

/// Joint angle at zero counts, if the joint is at `angle` at `counts`.
fn calibrated(encoder: Encoder, angle: f32, counts: Counts) -> Encoder {
    Encoder { angle_at_zero: angle - counts.0 as f32 * encoder.radians_per_count, ..encoder }
}

impl<const JOINTS: usize> Homing<JOINTS> {
    /// Homing of a device with these encoders, whose angles at zero counts are found out. Held still is: within
    /// `still_counts` of one reading for `still_ticks` ticks; `timeout_ticks` after the start it is too late.
    ///
    /// # Errors
    /// The number that makes no sense.
    pub const fn try_new(
        encoders: [Encoder; JOINTS],
        reference: Reference<JOINTS>,
        still_ticks: u32,
        still_counts: u32,
        timeout_ticks: u32,
    ) -> Result<Self, HomingError> {
        let mut joint = 0;
        while joint < JOINTS {
            match &reference {
                Reference::Pose(angles) | Reference::KnownPose { angles, .. } | Reference::Index(angles) => {
                    if !angles[joint].is_finite() {
                        return Err(HomingError::Angle);
                    }
                }
                Reference::Stops(searches) => {
                    if !searches[joint].is_valid() {
                        return Err(HomingError::Stop);
                    }
                }
                Reference::Fields(searches) => {
                    if !searches[joint].is_valid() || searches[joint].ticks() >= timeout_ticks {
                        return Err(HomingError::Field);
                    }
                }
            }
            joint += 1;
        }
        if still_ticks == 0 {
            return Err(HomingError::StillTicks);
        }
        if timeout_ticks <= still_ticks {
            return Err(HomingError::TimeoutTicks);
        }
        Ok(Self { encoders, reference, still_ticks, still_counts, timeout_ticks, when_asked: false })
    }

    /// [`Self::try_new`] for a `static`: what is refused does not compile.
    ///
    /// # Panics
    /// At compile time, naming the number.
    pub const fn new(
        encoders: [Encoder; JOINTS],
        reference: Reference<JOINTS>,
        still_ticks: u32,
        still_counts: u32,
        timeout_ticks: u32,
    ) -> Self {
        match Self::try_new(encoders, reference, still_ticks, still_counts, timeout_ticks) {
            Ok(homing) => homing,
            Err(HomingError::Angle) => panic!("a reference angle"),
            Err(HomingError::StillTicks) => panic!("still_ticks"),
            Err(HomingError::Stop) => panic!("a search for a stop"),
            Err(HomingError::TimeoutTicks) => panic!("timeout_ticks"),
            Err(HomingError::Field) => panic!("a search for a field"),
        }
    }

    /// The same, which goes on only while force is asked for, as a search for stops or fields does anyway: whoever
    /// holds the device in its reference pose says so with the enable button.
    pub const fn when_asked(self) -> Self {
        Self { when_asked: true, ..self }
    }

    /// The same with encoders that were measured. Of a pose or a mark that the counters know nothing of, their
    /// [`Encoder::angle_at_zero`] is the joint's angle there; of a known pose, whose counts are known, it is that at
    /// count zero, and the pose's angles follow from it. Stops stay where they are.
    pub(crate) fn of_encoders(self, encoders: [Encoder; JOINTS]) -> Self {
        let mut homing = Self { encoders, ..self };
        match &mut homing.reference {
            Reference::Pose(angles) | Reference::Index(angles) => {
                *angles = encoders.map(|encoder| encoder.angle_at_zero);
            }
            Reference::KnownPose { angles, counts, .. } => {
                for ((angle, encoder), counts) in angles.iter_mut().zip(&encoders).zip(counts) {
                    *angle = encoder.angle(*counts);
                }
            }
            Reference::Stops(_) | Reference::Fields(_) => {}
        }
        homing
    }

    /// What the encoders' [`Encoder::angle_at_zero`] has to be the angle at; `None` where it is found out anew each
    /// time.
    pub const fn zero_of(&self) -> Option<ZeroOf> {
        match &self.reference {
            Reference::Pose(_) => Some(ZeroOf::Pose),
            Reference::Index(_) => Some(ZeroOf::Mark),
            Reference::KnownPose { .. } | Reference::Fields(_) => Some(ZeroOf::Count),
            Reference::Stops(_) => None,
        }
    }

    /// Whether it goes on only while force is asked for.
    pub const fn waits_for_enable(&self) -> bool {
        self.when_asked || self.drives()
    }

    /// Whether the motors move the joints.
    pub const fn drives(&self) -> bool {
        matches!(self.reference, Reference::Stops(_) | Reference::Fields(_))
    }

    /// Whether it leads fields round ([`Reference::Fields`]).
    #[inline]
    pub(crate) const fn leads_fields(&self) -> bool {
        matches!(self.reference, Reference::Fields(_))
    }

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
                Reference::Stops(searches) => searches[joint].angle,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Commutation;

    const ENCODERS: [Encoder; 2] = [Encoder::geared(1_000.0, 1.0, 0.0), Encoder::geared(1_000.0, -2.0, 9.0)];
    const ANGLES: [f32; 2] = [0.5, -0.25];

    fn homing(reference: Reference<2>) -> Homing<2> {
        Homing::try_new(ENCODERS, reference, 5, 1, 50).unwrap()
    }

    fn at(counts: [i32; 2]) -> HomingInput<2> {
        HomingInput { counts: Some(counts.map(Counts)), index: [None; 2], rates: [0.0; 2], period: 2.5e-4 }
    }

    /// Runs the inputs to the end, and gives the tick after which nothing is waited for any more.
    fn run(homing: &Homing<2>, input: impl Fn(u32) -> HomingInput<2>) -> (u32, HomingProgress<2>) {
        let mut state = HomingState::default();
        let mut end = None;
        for tick in 0..100 {
            let progress = homing.tick(&mut state, input(tick));
            match end {
                None if progress != HomingProgress::Waiting => end = Some((tick, progress)),
                Some((_, first)) => assert_eq!(progress, first, "latched"),
                None => {}
            }
        }
        end.expect("it ends by the timeout")
    }

    fn angles(progress: HomingProgress<2>, counts: [i32; 2]) -> [f32; 2] {
        let HomingProgress::Done(encoders) = progress else { panic!("{progress:?}") };
        let [first, second] = counts;
        [encoders[0].angle(Counts(first)), encoders[1].angle(Counts(second))]
    }

    #[test]
    fn held_still_the_reference_pose_is_what_the_encoders_then_say() {
        // It moves for ten ticks, then trembles by a count.
        let (tick, progress) = run(&homing(Reference::Pose(ANGLES)), |tick| {
            at(if tick < 10 { [7 * tick as i32, 0] } else { [700 + (tick % 2) as i32, -300] })
        });
        // Anchored at tick 10, still for the five after it.
        assert_eq!(tick, 15);
        for (angle, expected) in angles(progress, [701, -300]).into_iter().zip(ANGLES) {
            // Roundings of 4.4 rad.
            assert!((angle - expected).abs() < 1e-6, "{angle} {expected}");
        }
    }

    #[test]
    fn a_device_that_never_rests_is_refused_when_the_time_is_over() {
        let drift = run(&homing(Reference::Pose(ANGLES)), |tick| at([tick as i32, 0]));
        assert_eq!(drift, (49, HomingProgress::Refused(Refusal::Moving)));
    }

    #[test]
    fn a_device_put_down_elsewhere_is_refused() {
        let known = Reference::KnownPose { angles: ANGLES, counts: [Counts(100), Counts(-100)], tolerance: 3 };
        let (_, good) = run(&homing(known), |_| at([103, -97]));
        assert!(matches!(good, HomingProgress::Done(_)));
        assert_eq!(run(&homing(known), |_| at([104, -97])), (5, HomingProgress::Refused(Refusal::OutOfTolerance)));
    }

    #[test]
    fn a_sensor_that_fails_is_refused_at_once() {
        let input = |tick| HomingInput { counts: (tick != 3).then_some([Counts(0); 2]), ..at([0; 2]) };
        for reference in [Reference::Pose(ANGLES), Reference::Index(ANGLES)] {
            assert_eq!(run(&homing(reference), input), (3, HomingProgress::Refused(Refusal::Sensor)));
        }
    }

    #[test]
    fn each_joint_passes_its_index_once_or_is_refused() {
        let input = |joints: usize| {
            move |tick: u32| {
                let mut input = at([tick as i32 * 10, 0]);
                for (joint, mark) in input.index.iter_mut().enumerate().take(joints) {
                    // A second pass elsewhere must not count.
                    *mark = match tick {
                        7 => Some(Counts(40 + joint as i32)),
                        9 => Some(Counts(900)),
                        _ => None,
                    };
                }
                input
            }
        };
        let homing = homing(Reference::Index(ANGLES));
        let (tick, progress) = run(&homing, input(2));
        assert_eq!(tick, 7);
        for (angle, expected) in angles(progress, [40, 41]).into_iter().zip(ANGLES) {
            assert!((angle - expected).abs() < 1e-6);
        }
        assert_eq!(run(&homing, input(1)), (49, HomingProgress::Refused(Refusal::NoIndex)));
    }

    #[test]
    fn with_encoders_that_were_measured_each_way_of_homing_has_the_angles_that_they_have() {
        // The second joint's encoder was found finer and the other way round, and zero elsewhere.
        let found = [Encoder::geared(1_000.0, 1.0, 0.3), Encoder::geared(1_000.0, 2.5, -0.7)];
        let stop = |angle| StopSearch { angle, speed: 1.0, torque: 0.1, clearance: 0.1, travel: 1.0 };
        let search = FieldSearch {
            commutation: Commutation { counts_per_turn: 1_000, pole_pairs: 7 },
            torque: 0.02,
            ramp_ticks: 10,
            turn_ticks: 64,
            turns: 1,
        };
        let (zeroes, counts) = (found.map(|encoder| encoder.angle_at_zero), [Counts(100), Counts(-100)]);
        for (built, expected) in [
            // What was measured is the angle in the pose, or at the mark.
            (Reference::Pose(ANGLES), Reference::Pose(zeroes)),
            (Reference::Index(ANGLES), Reference::Index(zeroes)),
            // What was measured is the angle at count zero, and the pose is elsewhere.
            (
                Reference::KnownPose { angles: ANGLES, counts, tolerance: 3 },
                Reference::KnownPose {
                    angles: [found[0].angle(counts[0]), found[1].angle(counts[1])],
                    counts,
                    tolerance: 3,
                },
            ),
            // Stops and poles are where they are.
            (Reference::Stops([stop(0.1), stop(0.2)]), Reference::Stops([stop(0.1), stop(0.2)])),
            (Reference::Fields([search; 2]), Reference::Fields([search; 2])),
        ] {
            let homing = Homing::try_new(ENCODERS, built, 5, 1, 1_000).unwrap().when_asked();
            let wanted = Homing::try_new(found, expected, 5, 1, 1_000).unwrap().when_asked();
            assert_eq!(homing.of_encoders(found), wanted);
        }
        // In a known pose every angle is then what the encoders say by themselves.
        let known = Reference::KnownPose { angles: ANGLES, counts, tolerance: 3 };
        let (_, progress) = run(&homing(known).of_encoders(found), |_| at([102, -98]));
        for (angle, expected) in
            angles(progress, [500, 500]).into_iter().zip(found.map(|encoder| encoder.angle(Counts(500))))
        {
            // Two counts of the pose, 6 and 2.5 mrad each.
            assert!((angle - expected).abs() < 0.013, "{angle} {expected}");
        }
    }

    #[test]
    fn numbers_that_make_no_sense_are_refused() {
        let with = |angle: f32, still, timeout| {
            Homing::try_new(ENCODERS, Reference::Pose([angle, 0.0]), still, 1, timeout).unwrap_err()
        };
        assert_eq!(with(f32::NAN, 5, 50), HomingError::Angle);
        assert_eq!(with(0.0, 0, 50), HomingError::StillTicks);
        assert_eq!(with(0.0, 5, 5), HomingError::TimeoutTicks);
    }

    #[test]
    fn counts_at_the_ends_of_their_range_are_far_apart_and_no_panic() {
        let (_, progress) = run(&homing(Reference::Pose(ANGLES)), |tick| {
            at(if tick % 2 == 0 { [i32::MIN, i32::MAX] } else { [i32::MAX, i32::MIN] })
        });
        assert_eq!(progress, HomingProgress::Refused(Refusal::Moving));
    }
}
