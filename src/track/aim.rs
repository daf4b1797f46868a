//! The decision of a second-order tick, before its one evaluation.

use super::border::{self, BoundaryMode};
use super::boundary::{self, Descent, Landing, MAX_HALVINGS};
use super::gain::certified_gain;
use super::projection::ProjectionErrors;
use super::rounding::{is_above_zero, rises};
use super::second_order::{Model, Plan, exact_share};
use super::witness::{Outcome, Witness};
use crate::math::{Vec3, saturate, vec3};
use crate::patch::{CurvedPoint, Patch};

/// The step of a second-order tick.
#[derive(Clone, Copy)]
pub(crate) struct Aim {
    /// Where the step ends.
    pub landing: Landing,
    /// Boundary mode at the witness point.
    pub mode: BoundaryMode,
    /// Boundary mode at the end of the step, as predicted.
    pub beyond: BoundaryMode,
    /// First-order fall of `½ ‖ΔR‖²`, metres squared. Not above 0 if no step is needed.
    pub slope: f32,
    /// Fraction of the full step.
    pub gain: f32,
    /// `‖ΔR‖²`, which the step must not raise.
    pub squared: f32,
}

impl Aim {
    /// The step to the model's minimiser over the square: the full step, or the certified fraction of it.
    #[inline(always)]
    pub(crate) fn of<P: Patch>(patch: &P, witness: &Witness, probe: Vec3) -> Self {
        Self::in_full(patch, witness, probe).unwrap_or_else(|most| Self::in_part(most, patch, witness, probe))
    }

    /// The full step if bounds alone certify it; otherwise the uncertified full step, if the model is convex.
    #[inline(always)]
    pub(crate) fn in_full<P: Patch>(patch: &P, witness: &Witness, probe: Vec3) -> Result<Self, Option<Self>> {
        let errors = ProjectionErrors::new(&witness.surface, probe);
        let squared = errors.difference.length_squared();
        // After a rejected step it would be the same step.
        let model = Model::new(&errors, witness).filter(|_| witness.halvings == 0).ok_or(None)?;
        let plan = model.plan(witness.parameters);
        let full = Self::full(&plan, squared);
        if plan.is_certain(patch, witness, squared) { Ok(full) } else { Err(Some(full)) }
    }

    /// The certified part of a step that [`Self::in_full`] did not certify.
    #[inline(always)]
    pub(crate) fn in_part<P: Patch>(most: Option<Self>, patch: &P, witness: &Witness, probe: Vec3) -> Self {
        match most {
            Some(full) => full
                .shortened(patch, witness, probe)
                .unwrap_or_else(|| to_first_order(patch, witness, probe.x, probe.y, probe.z)),
            None => without_model(patch, witness, probe.x, probe.y, probe.z),
        }
    }

    /// Whether the step lowers the distance.
    #[inline(always)]
    pub(crate) fn has_slope(&self) -> bool {
        is_above_zero(self.slope)
    }

    /// The same for a step with another end, which must lower `‖ΔR‖²` by `fall` at least.
    #[inline]
    pub(crate) fn landing_at(&self, parameters: [f32; 2], fall: f32) -> Self {
        let landing = Landing { parameters, is_inside: border::is_inside(parameters) };
        Self { landing, squared: self.squared - fall, ..*self }
    }

    /// Takes the step to an evaluated point, or rejects it if the distance rose by more than rounding.
    #[inline(always)]
    pub(crate) fn settle(&self, reached: &CurvedPoint, witness: &mut Witness, probe: Vec3, size: f32) -> Outcome {
        if rises(&witness.surface, &reached.surface, probe, self.squared, size) {
            witness.is_free = false;
            witness.halvings = (witness.halvings + 1).min(MAX_HALVINGS);
            return Outcome::Rejected;
        }
        (witness.surface, witness.second) = (reached.surface, reached.second);
        (witness.parameters, witness.is_free) = (self.landing.parameters, self.landing.is_inside);
        witness.halvings = 0;
        Outcome::Moved
    }

    #[inline(always)]
    fn full(plan: &Plan, squared: f32) -> Self {
        let Plan { parameters, is_inside, mode, beyond, slope, .. } = *plan;
        Self { landing: Landing { parameters, is_inside }, mode, beyond, slope, gain: 1.0, squared }
    }

    /// The certified fraction of a full step; `None` if it is 0.
    #[inline(always)]
    fn shortened<P: Patch>(&self, patch: &P, witness: &Witness, probe: Vec3) -> Option<Self> {
        let ([u, v], [to_u, to_v]) = (witness.parameters, self.landing.parameters);
        let change = [to_u - u, to_v - v];
        let share = exact_share(patch, witness, probe.x, probe.y, probe.z, change, self.slope);
        if share >= 1.0 {
            return Some(*self);
        }
        let part = |from: f32, change: f32| saturate(from + share * change, 0.0, 1.0);
        let parameters = [part(u, change[0]), part(v, change[1])];
        let landing = Landing { parameters, is_inside: border::is_inside(parameters) };
        (share > 0.0).then_some(Self { landing, beyond: self.mode, gain: share, ..*self })
    }
}

/// For a model that is not convex: the certified fraction of the step of the shifted model. At a pole and after a
/// rejected step, the certified step of first order.
#[inline(never)]
fn without_model<P: Patch>(patch: &P, witness: &Witness, x: f32, y: f32, z: f32) -> Aim {
    let probe = vec3(x, y, z);
    let errors = ProjectionErrors::new(&witness.surface, probe);
    if witness.halvings == 0
        && let Some(model) = Model::shifted(&errors, witness)
        && let full = Aim::full(&model.plan(witness.parameters), errors.difference.length_squared())
        && let Some(aim) = full.shortened(patch, witness, probe)
    {
        return aim;
    }
    to_first_order(patch, witness, x, y, z)
}

/// The certified step of first order.
#[inline(never)]
fn to_first_order<P: Patch>(patch: &P, witness: &Witness, x: f32, y: f32, z: f32) -> Aim {
    let errors = ProjectionErrors::new(&witness.surface, vec3(x, y, z));
    let squared = errors.difference.length_squared();
    let descent = Descent::of(&errors, witness);
    let gain = certified_gain(&descent, &patch.bounds(), squared);
    let (parameters, is_inside) = (witness.parameters, witness.is_free);
    // A step that is not finite moves nothing.
    let (landing, slope) = match boundary::advance(parameters, descent.direction, gain) {
        Some(landing) => (landing, descent.slope),
        None => (Landing { parameters, is_inside }, 0.0),
    };
    Aim { landing, mode: descent.mode, beyond: descent.mode, slope, gain, squared }
}
