//! The witness point, and what a step found out.

use super::border::{BoundaryMode, is_inside};
use crate::math::{Vec3, inverse_sqrt, saturate, sqrt};
use crate::patch::{CurvedPoint, Patch, SecondDerivatives, SurfacePoint};

/// The probe as the controller sees it, in the body's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Probe {
    /// Position `Q`, metres.
    pub position: Vec3,
    /// Velocity `q̇` relative to the body, m/s. Only feed-forward looks at it.
    pub velocity: Vec3,
}

impl Probe {
    /// A probe that is not known to move.
    pub const fn at(position: Vec3) -> Self {
        Self { position, velocity: Vec3::ZERO }
    }
}

/// The witness point: the controller's whole state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// `(u, v)`, in `[0, 1]²` always.
    pub parameters: [f32; 2],
    /// The patch evaluated there.
    pub surface: SurfacePoint,
    /// Its second derivatives there; a controller that does not look at them leaves them alone.
    pub second: SecondDerivatives,
    /// The boundary mode of the last step.
    pub mode: BoundaryMode,
    /// Whether the next step need look neither at the borders, for both parameters are away from them, nor at
    /// `halvings`.
    pub is_free: bool,
    /// How often the next step is halved: once more after each in a row that was rejected.
    pub halvings: u8,
}

/// What became of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Outcome {
    /// The witness point moved, and is not farther from the probe.
    Moved,
    /// There was nowhere nearer to go.
    AtRest,
    /// The step would have raised the distance by more than rounding can explain and was rejected; the next is half as
    /// long. With bounds that hold, on a patch that is C¹, it does not happen.
    Rejected,
}

/// What a step found out on its way. Lengths are kept squared: the tick does not ask for their roots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// `‖ΔR‖²` from the probe to the witness point before the step, metres squared.
    pub distance_squared_before: f32,
    /// The square of [`Self::residual`], metres squared.
    pub residual_squared: f32,
    /// The gain `K h` used.
    pub gain: f32,
    /// What became of it.
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

    /// Length in space of the full correction that was asked for, metres: the projection error, 0 at the closest point.
    pub fn residual(&self) -> f32 {
        sqrt(self.residual_squared)
    }
}

impl Witness {
    /// A witness point at `(u, v)`, moved into `[0, 1]²` if it lies outside; NaN is 0. One evaluation.
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

    /// Sets the point down at `(u, v)` in `[0, 1]²`. One evaluation, with second derivatives where these are looked at.
    #[inline(always)]
    pub(crate) fn set_down<P: Patch>(&mut self, patch: &P, [u, v]: [f32; 2], is_curved: bool) {
        if is_curved {
            self.rest_at([u, v], &patch.evaluate_curved(u, v));
        } else {
            self.surface = patch.evaluate(u, v);
            self.begin_at([u, v]);
        }
    }

    /// Sets the point down where the patch has been evaluated.
    #[inline(always)]
    pub(crate) fn rest_at(&mut self, parameters: [f32; 2], reached: &CurvedPoint) {
        (self.surface, self.second) = (reached.surface, reached.second);
        self.begin_at(parameters);
    }

    #[inline(always)]
    fn begin_at(&mut self, parameters: [f32; 2]) {
        (self.parameters, self.is_free) = (parameters, is_inside(parameters));
        (self.mode, self.halvings) = (BoundaryMode::Interior, 0);
    }

    /// The outward unit normal at the witness point; `None` where the tangents span no plane, or none that is more
    /// than rounding: at a pole.
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
        // A unit in the last place of a coordinate, across what it ought to be.
        witness.surface.tangent_u = vec3(-3.7e-9, 0.0, 1.9e-9);
        assert_eq!(witness.normal(&patch), None);
        // A thousandth of a millimetre is a tangent.
        witness.surface.tangent_u = vec3(1e-6, 0.0, 0.0);
        assert!(is_up(&witness));
    }
}
