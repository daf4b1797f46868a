//! Where a tick of second order goes: the decision, before the one evaluation.

use super::border::{self, BoundaryMode};
use super::boundary::{self, Descent, Landing, MAX_HALVINGS};
use super::gain::certified_gain;
use super::law::Law;
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
    /// `‖ΔR‖²`.
    pub squared: f32,
}

impl Aim {
    /// The step to where the model is least over the square: in full, or as much of it as is certain.
    #[inline(always)]
    pub(crate) fn of<P: Patch>(patch: &P, witness: &Witness, probe: Vec3) -> Self {
        let errors = ProjectionErrors::new(&witness.surface, probe);
        let squared = errors.difference.length_squared();
        match Model::new(&errors, witness) {
            // After a step that had to be undone it would be the same again.
            Some(model) if witness.halvings == 0 => Self::towards(&model, patch, witness, probe, squared)
                .unwrap_or_else(|| to_first_order(patch, witness, probe.x, probe.y, probe.z)),
            _ => without_model(patch, witness, probe.x, probe.y, probe.z),
        }
    }

    /// Whether there is anywhere to go.
    #[inline(always)]
    pub(crate) fn has_slope(&self) -> bool {
        is_above_zero(self.slope)
    }

    /// The step to an evaluated point: done, or undone where the distance rose by more than rounding.
    #[inline(always)]
    pub(crate) fn settle(&self, reached: &CurvedPoint, witness: &mut Witness, probe: Vec3, size: f32) -> Outcome {
        if rises(&witness.surface, &reached.surface, probe, self.squared, size) {
            witness.is_free = false;
            witness.halvings = (witness.halvings + 1).min(MAX_HALVINGS);
            return Outcome::Undone;
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

    /// The full step to where a model is least, or as much of it as is certain; `None` if nothing is.
    #[inline(always)]
    fn towards<P: Patch>(model: &Model, patch: &P, witness: &Witness, probe: Vec3, squared: f32) -> Option<Self> {
        let [u, v] = witness.parameters;
        let free = model.free([u, v]);
        if free.is_inside && free.is_certain(patch, witness, squared) {
            return Some(Self::full(&free, squared));
        }
        let plan = if free.is_inside { free } else { model.on_border([u, v], free.change) };
        let Plan { change, slope, .. } = plan;
        let full = Self::full(&plan, squared);
        if !free.is_inside && plan.is_certain(patch, witness, squared) {
            return Some(full);
        }
        let share = exact_share(patch, witness, probe.x, probe.y, probe.z, change, slope);
        if share >= 1.0 {
            return Some(full);
        }
        let part = |from: f32, change: f32| saturate(from + share * change, 0.0, 1.0);
        let parameters = [part(u, change[0]), part(v, change[1])];
        let landing = Landing { parameters, is_inside: border::is_inside(parameters) };
        (share > 0.0).then_some(Self { landing, beyond: full.mode, gain: share, ..full })
    }
}

/// Where the model is not convex: the same with the shifted one. The certified step of first order at a pole, and after
/// an undone step.
#[inline(never)]
fn without_model<P: Patch>(patch: &P, witness: &Witness, x: f32, y: f32, z: f32) -> Aim {
    let probe = vec3(x, y, z);
    let errors = ProjectionErrors::new(&witness.surface, probe);
    if witness.halvings == 0
        && let Some(model) = Model::shifted(&errors, witness)
        && let Some(aim) = Aim::towards(&model, patch, witness, probe, errors.difference.length_squared())
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
    let descent = Descent::of(Law::MeasureNumbers, &errors, witness);
    let gain = certified_gain(&descent, &patch.bounds(), squared);
    let (parameters, is_inside) = (witness.parameters, witness.is_free);
    // What is not a number, or too large for one, has come this far and goes no farther.
    let (landing, slope) = match boundary::advance(parameters, descent.direction, gain) {
        Some(landing) => (landing, descent.slope),
        None => (Landing { parameters, is_inside }, 0.0),
    };
    Aim { landing, mode: descent.mode, beyond: descent.mode, slope, gain, squared }
}
