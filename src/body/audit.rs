//! The search for a global start (after a jump too), and the audit of a tracker that follows.

use super::candidate_search::{CandidateSearch, CandidateStatus};
use super::feature::Feature;
use super::locator::Candidate;
use super::quadratic_model::DistanceDerivatives;
use super::search::{Best, Search};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness, StepLength};
use crate::field::Displacement;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::track::{Contact, Witness};

/// Relative difference of the squared distances above which the tracker changes to another candidate: far above the
/// rounding of `f32`, far below what a hand can feel.
const NEARER: f32 = 1.0e-3;
/// Relative to the body's size: a candidate is searched until it is certain to be farther by this. The more, the
/// longer the audit may rest.
const MARGIN: f32 = 0.01;
/// Maximum evaluations of one candidate in a pass.
pub(super) const MAX_EVALUATIONS_IN_AUDIT: u8 = 6;
/// At an effort of one: maximum ticks of a pass that the tracker has for itself because it is on its way or steps beside
/// a pole.
pub(super) const MAX_DEFERRED: u8 = 8;
/// Part of a root that covers its rounding.
const BELOW: f32 = 1.0 - 4.0 * f32::EPSILON;
/// No entry of the locator.
const NONE: u16 = u16::MAX;

/// The search beside the tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Seeking {
    /// For a start.
    Start(Search),
    /// For a point that is nearer than the tracker's.
    Nearer(Audit),
}

/// The audit: passes over the candidates of the probe's cell. A pass gives a certificate: while the probe stays in the
/// cell and near, no candidate holds a nearer point. It rests that long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Audit {
    descending: CandidateSearch,
    /// The probe for which the candidate is searched: a minimum that moved with the probe would never be found.
    asked: Vec3,
    /// The probe at the start of the pass, the lower bound of the distance there of all candidates so far, and how far
    /// the cell's walls were, metres.
    anchor: Vec3,
    floor: f32,
    room: f32,
    /// Index of the entry, and of the first of the list.
    entry: u16,
    first: u16,
    /// The entry that set the floor, and that of the last pass: it comes first in the next one.
    nearest: u16,
    favourite: u16,
    /// The entries that hold the tracker's point as their only minimum.
    held: [u16; 2],
    stage: Stage,
    /// The last evaluation, while it is not judged.
    seen: DistanceDerivatives,
}

/// The next action of the audit. At an effort of one each has a tick of its own, but for [`Stage::Fresh`] after
/// [`Stage::GoOn`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// To start a pass.
    Start,
    /// To skip the candidate if it holds the tracker's point.
    Fresh,
    /// To evaluate.
    Evaluate,
    /// To judge the evaluation.
    Judge,
    /// To move the tracker to the candidate's point, which is nearer.
    SetDown,
    /// To go on to the next candidate; `at_least` bounds `φ` of this one.
    GoOn,
    /// Nothing, while the certificate holds.
    Rest,
}

/// The faces that hold the tracker's point, with `(u, v)`: two on an edge.
type Places = [Option<(u16, [f32; 2])>; 2];

/// Whether the tracker's point is the nearest of a candidate: `φ` has one minimum there, and the tracker goes to it.
#[inline(never)]
fn holds(candidate: &Candidate, places: &Places) -> bool {
    let [lower, upper] = candidate.rectangle();
    let is_within = |[u, v]: [f32; 2]| lower[0] <= u && u <= upper[0] && lower[1] <= v && v <= upper[1];
    candidate.convex && places.iter().flatten().any(|(face, at)| *face == candidate.face && is_within(*at))
}

impl Audit {
    /// A pass in the cell of a probe; in the same cell with the entry first that was nearest in the last pass.
    fn new<D: Displacement>(body: &Body<'_, D>, probe: Vec3, last: Option<&Self>) -> Self {
        let (first, room) = body.locator.cell(body.at_rest(probe));
        let first = first as u16;
        let favourite = last.filter(|last| last.first == first).map_or(NONE, |last| last.nearest);
        let entry = if favourite == NONE { first } else { favourite };
        Self {
            descending: CandidateSearch::new(body.candidate(usize::from(entry)), MAX_EVALUATIONS_IN_AUDIT),
            asked: probe,
            anchor: probe,
            floor: f32::INFINITY,
            room,
            entry,
            first,
            nearest: NONE,
            favourite,
            held: [NONE; 2],
            stage: Stage::Fresh,
            seen: DistanceDerivatives::NONE,
        }
    }

    /// Whether no candidate is nearer than the tracker's point, by the certificate of the last pass.
    fn is_certain<D: Displacement>(&self, body: &Body<'_, D>, probe: Vec3, distance: f32, places: &Places) -> bool {
        let moved = sqrt_from_above((probe - self.anchor).length_squared());
        let is_held = |entry: &u16| *entry == NONE || holds(&body.candidate(usize::from(*entry)), places);
        moved <= self.room && distance * (1.0 - 0.5 * NEARER) + moved <= self.floor && self.held.iter().all(is_held)
    }

    /// Takes the lower bound of `φ` of the candidate, and goes on to the next; the last one ends the pass.
    #[inline(never)]
    fn go_on<D: Displacement>(&mut self, body: &Body<'_, D>) {
        let floor =
            sqrt(2.0 * self.descending.at_least) * BELOW - sqrt_from_above((self.asked - self.anchor).length_squared());
        if floor < self.floor {
            (self.floor, self.nearest) = (floor, self.entry);
        }
        self.skip(body);
    }

    /// The candidate's next evaluation.
    #[inline]
    fn evaluate<D: Displacement>(&mut self, body: &Body<'_, D>, probe: Vec3, step: &mut BodyStep) {
        step.evaluations += 1;
        if self.descending.is_fresh() {
            self.asked = probe;
        }
        if let Some(seen) = body.see(&self.descending, self.asked) {
            self.seen = seen;
        }
        self.stage = Stage::Judge;
    }

    /// Judges it, for a tracker at this squared distance from the probe. Whether another one follows.
    #[inline]
    fn judge<D: Displacement>(&mut self, body: &Body<'_, D>, squared: f32) -> bool {
        let (search, far) = (&mut self.descending, sqrt_from_above(squared) + MARGIN * body.size);
        let status = body.judge::<false>(search, &self.seen, 0.5 * far * far);
        match status {
            Some(CandidateStatus::Falling | CandidateStatus::Beaten) => {}
            Some(CandidateStatus::Found) => search.at_least = search.half_squared,
            Some(CandidateStatus::Exhausted) | None => search.at_least = 0.0,
        }
        let falls = status == Some(CandidateStatus::Falling);
        self.stage = if falls { Stage::Evaluate } else { Stage::GoOn };
        falls
    }

    fn skip<D: Displacement>(&mut self, body: &Body<'_, D>) {
        let was_favourite = self.entry == self.favourite;
        let mut is_last = !was_favourite && !self.descending.candidate.more;
        self.entry = if was_favourite { self.first } else { self.entry + 1 };
        // It has had its turn.
        if !is_last && self.entry == self.favourite {
            is_last = !body.candidate(usize::from(self.entry)).more;
            self.entry += 1;
        }
        self.stage = if is_last { Stage::Rest } else { Stage::Fresh };
        if !is_last {
            self.descending = CandidateSearch::new(body.candidate(usize::from(self.entry)), MAX_EVALUATIONS_IN_AUDIT);
        }
    }
}

impl<D: Displacement> Body<'_, D> {
    /// One part of the search for a start: the evaluations of a tick, and its end. `follows`: the probe is near that of
    /// the last tick. Returns whether the tracker may step.
    #[inline(never)]
    pub(super) fn search(&self, state: &mut BodyWitness, probe: Vec3, follows: bool, step: &mut BodyStep) -> bool {
        if !follows {
            if !probe.is_finite() {
                return false;
            }
            // A witness point that was placed before the first probe has not jumped.
            if state.probe.is_finite() || !state.is_located {
                state.forget();
            }
        }
        let before = core::mem::replace(&mut state.probe, probe);
        // Behind a convex body's surface there is no force: tracker and audit take turns.
        let steps_too = state.is_located && (state.contact != Contact::Behind || !self.is_convex());
        let mut left = self.effort.candidates;
        if !matches!(state.seeking, Some(Seeking::Start(_))) {
            state.seeking = Some(Seeking::Start(Search::new(self, probe)));
            // To find the list takes an evaluation's time.
            left -= 1;
        }
        let Some(Seeking::Start(search)) = &mut state.seeking else { return steps_too };
        while search.found().is_none() && left > 0 {
            left -= 1;
            step.evaluations += 1;
            search.advance::<D, false>(self, probe);
        }
        // The point that was found takes an evaluation too.
        let Some(found) = search.found().filter(|_| left > 0) else { return steps_too };
        // The tracker steps first from the point that was just found.
        (state.is_audited, state.is_trackers_turn, state.seeking) = (true, false, None);
        // The tracker has not stepped for this probe yet: its distance for the last probe counts too.
        let away = |probe: Vec3| (state.witness.surface.point - probe).length_squared();
        let (now, last) = (away(probe), away(before));
        let nearer = (0.5 - 0.5 * NEARER) * if last < now { last } else { now };
        if !state.is_located || found.half_squared < nearer {
            self.set_down(state, &found, nearer, step);
        }
        steps_too && !step.switched
    }

    /// The audit of a tick on a body that is not convex, after the tracker's steps. At most the evaluations of
    /// [`super::Effort`], and one for a point that is nearer. At an effort of one, one [`Stage`] a tick, and none in up to
    /// [`MAX_DEFERRED`] ticks of a pass in which the tracker is on its way or takes its dearest step, beside a pole.
    #[inline(never)]
    pub(super) fn audit(&self, state: &mut BodyWitness, is_settled: bool, step: &mut BodyStep) {
        let is_single = self.effort.candidates == 1;
        if is_single && (!is_settled || step.length == StepLength::NearPole) && state.deferred < MAX_DEFERRED {
            state.deferred += 1;
            return;
        }
        let probe = state.probe;
        let squared = |witness: &Witness| (witness.surface.point - probe).length_squared();
        let beaten = |squared: f32| (0.5 - 0.5 * NEARER) * squared;
        // The dearest stages, without the questions of the others.
        if is_single && let Some(Seeking::Nearer(audit)) = &mut state.seeking {
            match audit.stage {
                Stage::Evaluate => return audit.evaluate(self, probe, step),
                Stage::Judge => {
                    let squared = squared(&state.witness);
                    audit.judge(self, squared);
                    if audit.descending.half_squared < beaten(squared) {
                        (audit.stage, audit.descending.at_least) = (Stage::SetDown, 0.0);
                    }
                    return;
                }
                _ => {}
            }
        }
        let squared = squared(&state.witness);
        let known = beaten(squared);
        let stage = match &state.seeking {
            Some(Seeking::Nearer(audit)) => audit.stage,
            _ => Stage::Start,
        };
        // A tracker that is on its way is not at a minimum.
        let is_asked = !is_single || matches!(stage, Stage::Rest | Stage::Fresh | Stage::GoOn);
        let places = if is_settled && is_asked { self.places(&state.feature, &state.witness) } else { [None; 2] };
        // A candidate that is passed over at an effort of one is not followed by an evaluation.
        let mut left = if is_single && stage == Stage::Fresh { 0 } else { self.effort.candidates };
        if let Some(Seeking::Nearer(audit)) = &mut state.seeking
            && audit.stage == Stage::Rest
        {
            if audit.is_certain(self, probe, sqrt_from_above(squared), &places) {
                return;
            }
            audit.stage = Stage::Start;
            if is_single {
                return;
            }
        }
        let last = match &state.seeking {
            Some(Seeking::Nearer(audit)) => Some(audit),
            _ => None,
        };
        if last.is_none_or(|audit| audit.stage == Stage::Start) {
            state.seeking = Some(Seeking::Nearer(Audit::new(self, probe, last)));
            state.deferred = 0;
            if is_single {
                return;
            }
        }
        // A certificate is of one shape: a body that deforms is searched without end.
        if !self.by.is_rest()
            && let Some(Seeking::Nearer(audit)) = &mut state.seeking
        {
            audit.floor = 0.0;
        }
        // In its place: a copy there and back would take 180 instructions.
        while let Some(Seeking::Nearer(audit)) = &mut state.seeking {
            let mut is_nearer = false;
            match audit.stage {
                Stage::Start | Stage::Rest => return,
                Stage::Fresh => {
                    if holds(&audit.descending.candidate, &places)
                        && let Some(free) = audit.held.iter_mut().find(|held| **held == NONE)
                    {
                        *free = audit.entry;
                        audit.skip(self);
                        if is_single {
                            return;
                        }
                    } else if left > 0 || is_single {
                        audit.stage = Stage::Evaluate;
                    } else {
                        return;
                    }
                    continue;
                }
                Stage::Evaluate => {
                    if left == 0 {
                        return;
                    }
                    left -= 1;
                    audit.evaluate(self, probe, step);
                }
                Stage::Judge => {
                    let falls = audit.judge(self, squared);
                    is_nearer = audit.descending.half_squared < known && (!falls || left == 0);
                }
                Stage::SetDown => (audit.stage, is_nearer) = (Stage::GoOn, true),
                Stage::GoOn => {
                    audit.go_on(self);
                    left -= u8::from(is_single);
                    continue;
                }
            }
            if is_nearer {
                let CandidateSearch { candidate: Candidate { face, .. }, parameters, half_squared, .. } =
                    audit.descending;
                self.set_down(state, &Best { face, parameters, half_squared }, known, step);
                if step.switched {
                    // The point that was left may be the next that is nearer.
                    state.seeking = None;
                    return;
                }
            }
            if is_single {
                return;
            }
        }
    }

    /// The faces that hold the witness point, with `(u, v)` on each.
    #[inline(never)]
    fn places(&self, feature: &Feature, witness: &Witness) -> Places {
        match feature {
            Feature::Face(index) => [Some((*index, witness.parameters)), None],
            Feature::Edge(index) => match self.edges.get(usize::from(*index)) {
                Some(edge) => edge.faces.map(|of| self.position_on_face(of, witness.parameters[0])),
                None => [None; 2],
            },
            Feature::Vertex(_) => [None; 2],
        }
    }

    /// Moves the witness point to the result of the search if `½ ‖P − Q‖²` is below `nearer` there, m², or if it was
    /// not located before. One evaluation.
    #[inline(never)]
    fn set_down(&self, state: &mut BodyWitness, found: &Best, nearer: f32, step: &mut BodyStep) {
        let Some(face) = self.faces.get(usize::from(found.face)) else { return };
        let reached = self.patch(face).evaluate_apart(found.parameters);
        step.evaluations += 1;
        // The probe has moved since the search started.
        let is_nearer = 0.5 * (reached.surface.point - state.probe).length_squared() < nearer;
        if !state.is_located || is_nearer {
            state.witness.rest_at(found.parameters, &reached);
            (state.feature, state.is_located, step.switched) = (Feature::Face(found.face), true, true);
        }
    }
}
