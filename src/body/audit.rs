//! The search for a global start (after a jump too), and the rolling audit of a tracker that follows.

use super::feature::Feature;
use super::search::{Best, Rival, Search};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::math::Vec3;
use crate::track::{Contact, Witness};

/// Relative difference of the distances above which the tracker changes to another candidate: far above the rounding
/// of `f32`, far below what a hand can feel.
const NEARER: f32 = 1.0e-3;

impl Body<'_> {
    /// One part of the search for a start, or of the rolling audit: its start, half an evaluation, or its end.
    /// `follows`: the probe is near that of the last tick. Returns whether the tracker may step.
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
        let is_located = state.is_located;
        let steps_too = is_located && (state.contact != Contact::Behind || !self.is_convex());
        let Some(search) = &mut state.search else {
            state.search = Some(Search::new(self, probe));
            return steps_too;
        };
        // The tracker has not stepped for this probe yet: its distance for the last probe counts too.
        let away = |probe: Vec3| (state.witness.surface.point - probe).length_squared();
        let (now, last) = (away(probe), away(before));
        let nearer = (0.5 - 0.5 * NEARER) * if last < now { last } else { now };
        let Some(found) = search.found() else {
            // In front of a convex body no other point is nearer.
            let asks = state.is_audited && !self.is_convex();
            let places = || self.places(&state.feature, &state.witness);
            let rival = asks.then(|| Rival { half_squared: nearer, places: places() });
            search.advance_against(self, probe, rival.as_ref());
            step.evaluations += u8::from(search.has_evaluated());
            // No tracker steps until it is located: there is time for both halves.
            if !is_located {
                search.advance(self, probe);
                step.evaluations += u8::from(search.has_evaluated());
            }
            return steps_too;
        };
        let is_audit = state.is_audited && !self.is_convex();
        // The tracker steps first from the point that was just found.
        (state.is_audited, state.is_trackers_turn) = (true, false);
        if !state.is_located || found.half_squared < nearer {
            self.set_down(state, &found, probe, nearer, step);
            // The point is not nearer for the present probe: continue with the other candidates.
            if is_audit
                && !step.switched
                && let Some(search) = &mut state.search
            {
                search.resume(self);
                return steps_too;
            }
        }
        state.search = None;
        steps_too && !step.switched
    }

    /// The faces that hold the witness point, with `(u, v)` on each.
    #[inline(never)]
    fn places(&self, feature: &Feature, witness: &Witness) -> [Option<(u16, [f32; 2])>; 2] {
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
    fn set_down(&self, state: &mut BodyWitness, found: &Best, probe: Vec3, nearer: f32, step: &mut BodyStep) {
        let Some(face) = self.faces.get(usize::from(found.face)) else { return };
        let reached = face.patch.evaluate_apart(found.parameters);
        step.evaluations += 1;
        // The probe has moved since the search started.
        let is_nearer = 0.5 * (reached.surface.point - probe).length_squared() < nearer;
        if !state.is_located || is_nearer {
            state.witness.rest_at(found.parameters, &reached);
            (state.feature, state.is_located, step.switched) = (Feature::Face(found.face), true, true);
        }
    }
}
