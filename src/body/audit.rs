//! When the tracker does not follow: the search for a start, after a jump too, and the rolling audit.

use super::feature::Feature;
use super::search::{Located, Search};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::math::Vec3;
use crate::track::Contact;

/// The distance of another candidate must be shorter by this part before the tracker changes over: far above what `f32`
/// rounds, far below what a hand feels.
const NEARER: f32 = 1.0e-3;

impl Body {
    /// One part of the search for a start, or of the rolling audit: its beginning, half an evaluation, or
    /// its end. `follows` is whether the probe is near that of the last tick. Whether the tracker may step.
    #[inline(never)]
    pub(super) fn search(
        &self,
        is_curved: bool,
        state: &mut BodyWitness,
        probe: Vec3,
        follows: bool,
        step: &mut BodyStep,
    ) -> bool {
        if !follows {
            if !probe.is_finite() {
                return false;
            }
            // Set down by hand before the first probe, it has not jumped.
            if state.probe.is_finite() || !state.is_located {
                state.forget();
            }
        }
        state.probe = probe;
        // Behind the surface there is no force, and no haste: tracker and audit take turns.
        let steps_too = state.contact != Contact::Behind;
        let Some(search) = &mut state.search else {
            state.search = Some(Search::new(self, probe));
            return steps_too;
        };
        let Some(found) = search.found() else {
            search.turn(self, probe);
            step.evaluations += u8::from(search.has_evaluated());
            return steps_too;
        };
        state.search = None;
        let known = 0.5 * (state.witness.surface.point - probe).length_squared();
        if !state.is_located || found.half_squared < (1.0 - NEARER) * known {
            self.set_down(is_curved, state, &found, probe, step);
        }
        state.is_audited = true;
        steps_too && !step.switched
    }

    /// Sets the witness point down where the search has ended. One evaluation.
    fn set_down(&self, is_curved: bool, state: &mut BodyWitness, found: &Located, probe: Vec3, step: &mut BodyStep) {
        let Some(face) = self.faces.get(usize::from(found.face)) else { return };
        let [u, v] = found.parameters;
        let mut witness = state.witness;
        witness.set_down(&face.patch, [u, v], is_curved);
        step.evaluations += 1;
        // The probe has moved since the search began.
        let nearer =
            (witness.surface.point - probe).length_squared() < (state.witness.surface.point - probe).length_squared();
        if !state.is_located || nearer {
            step.switched = true;
            state.feature = Feature::Face(found.face);
            state.witness = witness;
            state.is_located = true;
        }
    }
}
