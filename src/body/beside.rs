//! A step of second order on a face that has a pole.

use super::enter::LEAST_FALL;
use super::feature::Face;
use super::minimise::StepBeside;
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::patch::CurvedPoint;
use crate::track::{Outcome, Witness, mode_at};

impl Body<'_> {
    /// One step of second order on a face that has a pole, where the certificate is of little use: bounds over the
    /// whole face do not know that around the pole all is small. The evaluation says whether the step was good; if not
    /// it is undone, and the next one is certified. Whether it was tried.
    #[inline(never)]
    pub(super) fn step_beside_pole(&self, face: &Face, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Witness { parameters, surface, second, halvings, .. } = state.witness;
        if halvings != 0 {
            return false;
        }
        let at = CurvedPoint { surface, second };
        let Some(plan) = StepBeside::new(face.poles(), parameters, &at, state.probe, self.size) else { return false };
        let reached = face.patch.evaluate_apart(plan.parameters);
        step.evaluations += 1;
        let before = (surface.point - state.probe).length_squared();
        let is_nearer = (reached.surface.point - state.probe).length_squared() <= before - 2.0 * LEAST_FALL * plan.fall;
        if is_nearer {
            state.witness.rest_at(plan.parameters, &reached);
            state.witness.mode = mode_at(plan.parameters, plan.is_held);
            step.outcome = Outcome::Moved;
        } else {
            (state.witness.is_free, state.witness.halvings) = (false, 1);
            step.outcome = Outcome::Undone;
        }
        true
    }
}
