//! Where a tick of second order goes: the decision, before the one evaluation.

use super::border::{self, BoundaryMode};
use super::boundary::{self, Descent, Landing, MAX_HALVINGS};
use super::gain::certified_gain;
use super::projection::ProjectionErrors;
use super::rounding::{is_above_zero, rises};
use super::second_order::{Model, Plan, exact_share};
use super::witness::{Outcome, Witness};
use crate::math::{Vec3, saturate, vec3};
use crate::patch::{CurvedPoint, Patch};

/// What a tick of second order goes for.
#[derive(Clone, Copy)]
pub(crate) struct Aim {
    /// Where the step ends.
    pub landing: Landing,
    /// What holds the witness point where it is.
    pub mode: BoundaryMode,
    /// What holds it where the step ends, as far as is known.
    pub beyond: BoundaryMode,
    /// The fall of `½ ‖ΔR‖²` to first order, metres squared. Not above 0 where there is nowhere to go.
    pub slope: f32,
    /// How much of the whole step.
    pub gain: f32,
    /// `‖ΔR‖²`, which the step must not raise.
    pub squared: f32,
}

impl Aim {
    /// The step to where the model is least over the square: in full, or as much of it as is certain.
    #[inline(always)]
    pub(crate) fn of<P: Patch>(patch: &P, witness: &Witness, probe: Vec3) -> Self {
        Self::in_full(patch, witness, probe).unwrap_or_else(|most| Self::in_part(most, patch, witness, probe))
    }

    /// The full step, where bounds alone say that it is certain; otherwise, where the model is convex, the full step
    /// that is not.
    #[inline(always)]
    pub(crate) fn in_full<P: Patch>(patch: &P, witness: &Witness, probe: Vec3) -> Result<Self, Option<Self>> {
        let errors = ProjectionErrors::new(&witness.surface, probe);
        let squared = errors.difference.length_squared();
        // After a rejected step it would be the same again.
        let model = Model::new(&errors, witness).filter(|_| witness.halvings == 0).ok_or(None)?;
        let plan = model.plan(witness.parameters);
        let full = Self::full(&plan, squared);
        if plan.is_certain(patch, witness, squared) { Ok(full) } else { Err(Some(full)) }
    }

    /// As much as is certain of what [`Self::in_full`] did not find certain.
    #[inline(always)]
    pub(crate) fn in_part<P: Patch>(most: Option<Self>, patch: &P, witness: &Witness, probe: Vec3) -> Self {
        match most {
            Some(full) => full
                .shortened(patch, witness, probe)
                .unwrap_or_else(|| to_first_order(patch, witness, probe.x, probe.y, probe.z)),
            None => without_model(patch, witness, probe.x, probe.y, probe.z),
        }
    }

    /// Whether there is anywhere to go.
    #[inline(always)]
    pub(crate) fn has_slope(&self) -> bool {
        is_above_zero(self.slope)
    }

    /// The same for a step that ends elsewhere, and is to lower `‖ΔR‖²` by no less than `fall`.
    #[inline]
    pub(crate) fn landing_at(&self, parameters: [f32; 2], fall: f32) -> Self {
        let landing = Landing { parameters, is_inside: border::is_inside(parameters) };
        Self { landing, squared: self.squared - fall, ..*self }
    }

    /// The step to an evaluated point: done, or rejected where the distance rose by more than rounding.
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

    /// As much of a full step as is certain; `None` if nothing is.
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

/// Where the model is not convex: the same with the shifted one. The certified step of first order at a pole, and after
/// a rejected step.
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
    // What is not a number, or too large for one, has come this far and goes no farther.
    let (landing, slope) = match boundary::advance(parameters, descent.direction, gain) {
        Some(landing) => (landing, descent.slope),
        None => (Landing { parameters, is_inside }, 0.0),
    };
    Aim { landing, mode: descent.mode, beyond: descent.mode, slope, gain, squared }
}
