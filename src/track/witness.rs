//! The probe, the witness point, and the result of a step.

use super::border::{BoundaryMode, is_inside};
use crate::math::{Vec3, inverse_sqrt, saturate, sqrt};
use crate::patch::{CurvedPoint, Patch, SecondDerivatives, SurfacePoint};

/// The probe in the body's frame.
///
/// ```
/// use palpate::math::vec3;
/// use palpate::track::Probe;
///
/// let moving = Probe { position: vec3(0.01, 0.0, 0.02), velocity: vec3(0.1, 0.0, 0.0) };
/// let resting = Probe::at(moving.position);
/// assert_eq!(resting.velocity, vec3(0.0, 0.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probe {
    /// Position `Q`, metres.
    pub position: Vec3,
    /// Velocity `q̇` relative to the body, m/s: for feed-forward.
    pub velocity: Vec3,
}

impl Probe {
    /// A probe at rest.
    pub const fn at(position: Vec3) -> Self {
        Self { position, velocity: Vec3::ZERO }
    }
}

/// The witness point: the controller's whole state on one patch.
///
/// ```
/// use palpate::math::vec3;
/// use palpate::patch::{SplinePatch, SplineTable};
/// use palpate::track::{Controller, Outcome, Probe, Witness};
///
/// static WALL: SplinePatch = SplineTable::UNIT_SQUARE.checked();
/// // One step from the middle to the point below the probe.
/// let mut witness = Witness::at(&WALL, 0.5, 0.5);
/// let step = Controller::SecondOrder.step(&WALL, &mut witness, Probe::at(vec3(0.7, 0.2, 0.3)), 0.001);
/// assert_eq!(step.outcome, Outcome::Moved);
/// assert!((witness.surface.point - vec3(0.7, 0.2, 0.0)).length() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// `(u, v)`, in `[0, 1]²` always.
    pub parameters: [f32; 2],
    /// The patch evaluated there.
    pub surface: SurfacePoint,
    /// Its second derivatives there; a first-order law does not update them.
    pub second: SecondDerivatives,
    /// The boundary mode of the last step.
    pub mode: BoundaryMode,
    /// Whether the next step may skip the borders, because both parameters are away from them, and `halvings`.
    pub is_free: bool,
    /// Number of halvings of the next step: one more after each rejected step in a row.
    pub halvings: u8,
}

/// Outcome of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Outcome {
    /// The witness point moved, and is not farther from the probe.
    Moved,
    /// No step lowers the distance.
    AtRest,
    /// The step would have raised the distance by more than rounding; the witness point stayed, and the next step is
    /// half as long. Does not happen with valid bounds on a patch that is C¹.
    Rejected,
}

/// Result of a step. Lengths are kept squared: the tick does not need their roots.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Step {
    /// `‖ΔR‖²` from the probe to the witness point before the step, metres squared.
    pub distance_squared_before: f32,
    /// The square of [`Self::residual`], metres squared.
    pub residual_squared: f32,
    /// The gain `K h` used.
    pub gain: f32,
    /// Outcome of the step.
    pub outcome: Outcome,
}

impl Step {
    /// The step that moved nothing.
    #[inline(always)]
    pub(super) const fn at_rest(distance_squared_before: f32) -> Self {
        Self { distance_squared_before, residual_squared: 0.0, gain: 0.0, outcome: Outcome::AtRest }
    }

    /// `‖ΔR‖` from the probe to the witness point before the step, metres.
    pub fn distance_before(&self) -> f32 {
        sqrt(self.distance_squared_before)
    }

    /// Length in space of the full requested correction, metres: the projection error, 0 at the closest point.
    pub fn residual(&self) -> f32 {
        sqrt(self.residual_squared)
    }
}

impl Witness {
    /// A witness point at `(u, v)`, saturated to `[0, 1]²`; NaN becomes 0. One evaluation.
    pub fn at<P: Patch>(patch: &P, u: f32, v: f32) -> Self {
        let [u, v] = [u, v].map(|parameter| saturate(parameter, 0.0, 1.0));
        let CurvedPoint { surface, second } = patch.evaluate_curved(u, v);
        Self {
            parameters: [u, v],
            surface,
            second,
            mode: BoundaryMode::Interior,
            is_free: is_inside([u, v]),
            halvings: 0,
        }
    }

    /// Moves the point to `(u, v)` in `[0, 1]²`. One evaluation, with second derivatives if `is_curved`.
    #[inline(always)]
    pub(crate) fn set_down<P: Patch>(&mut self, patch: &P, [u, v]: [f32; 2], is_curved: bool) {
        if is_curved {
            self.rest_at([u, v], &patch.evaluate_curved(u, v));
        } else {
            self.surface = patch.evaluate(u, v);
            self.reset_at([u, v]);
        }
    }

    /// Moves the point to where the patch has been evaluated.
    #[inline(always)]
    pub(crate) fn rest_at(&mut self, parameters: [f32; 2], reached: &CurvedPoint) {
        (self.surface, self.second) = (reached.surface, reached.second);
        self.reset_at(parameters);
    }

    #[inline(always)]
    fn reset_at(&mut self, parameters: [f32; 2]) {
        (self.parameters, self.is_free) = (parameters, is_inside(parameters));
        (self.mode, self.halvings) = (BoundaryMode::Interior, 0);
    }

    /// The outward unit normal at the witness point; `None` if the tangents span no plane by more than rounding: at a
    /// pole.
    #[inline(always)]
    pub fn normal<P: Patch>(&self, patch: &P) -> Option<Vec3> {
        let across = self.surface.tangent_u.cross(self.surface.tangent_v);
        let (squared, size) = (across.length_squared(), patch.size());
        // A tangent of zero is rounded by a few units in the last place of the size, and the other is about as long.
        let rounding = (16.0 * f32::EPSILON) * (size * size);
        (squared > rounding * rounding).then(|| across * (patch.orientation() * inverse_sqrt(squared)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::patch::{Coefficients, SplineTable};

    #[test]
    fn a_tangent_that_is_rounding_gives_no_normal() {
        let plane = Coefficients::Polynomial(&[[0.03, 0.03, 0.0], [0.0, 0.06, 0.0], [0.06, 0.0, 0.0], [0.0; 3]]);
        let patch = SplineTable { coefficients: plane, size_m: 0.06, ..SplineTable::UNIT_SQUARE }.checked_in_body();
        let mut witness = Witness::at(&patch, 0.5, 1.0);
        let is_up = |witness: &Witness| witness.normal(&patch).is_some_and(|normal| normal.distance(Vec3::Z) < 1e-6);
        assert!(is_up(&witness));
        // An error of a unit in the last place of a coordinate.
        witness.surface.tangent_u = vec3(-3.7e-9, 0.0, 1.9e-9);
        assert_eq!(witness.normal(&patch), None);
        // A thousandth of a millimetre is a tangent.
        witness.surface.tangent_u = vec3(1e-6, 0.0, 0.0);
        assert!(is_up(&witness));
    }
}
