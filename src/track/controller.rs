//! The switching controller of Theorem 1: one step, one evaluation.

use super::boundary::{self, BoundaryMode, Descent};
use super::gain::certified_gain;
use super::projection::ProjectionErrors;
use crate::math::{Vec3, saturate, sqrt};
use crate::patch::{Patch, SurfacePoint};

/// The controller's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Controller {
    /// The gain `K`, 1/s. Infinite means: the largest that is proved monotone. The certified gain caps it in any case.
    gain: f32,
}

/// The witness point: the controller's whole state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness {
    /// `(u, v)`, in `[0, 1]²` always.
    pub parameters: [f32; 2],
    /// The patch evaluated there.
    pub surface: SurfacePoint,
    /// The boundary mode of the last step.
    pub mode: BoundaryMode,
    /// What the certified gain is multiplied by: 1, or less for a while after a step had to be undone.
    pub caution: f32,
}

/// What became of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// The witness point moved, and is not farther from the probe.
    Moved,
    /// There was nowhere nearer to go.
    AtRest,
    /// The step would have raised the distance by more than rounding can explain and was undone; the gain was halved.
    /// With bounds that hold, on a patch that is C¹, it does not happen.
    Undone,
}

/// What a step found out on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// `‖ΔR‖` from the probe to the witness point before the step, metres.
    pub distance_before: f32,
    /// Length in space of the full correction that was asked for, metres: the projection error, 0 at the closest point.
    pub residual: f32,
    /// The gain `K h` used.
    pub gain: f32,
    /// What became of it.
    pub outcome: Outcome,
}

/// A rise of the squared distance is rounding as long as it is below this many units in the last place of the
/// coordinates, times the distance. Horner's rule at degree 5 in both parameters rounds about 20 times a coordinate, at
/// both ends of a step; 32 halves (a rise `δ` of the distance shows as `2 R δ`) leave a margin and are 1 µm on a body of 1 m.
const ROUNDING: f32 = 32.0 * f32::EPSILON;
/// Caution never goes below this, so that a witness point is never stuck for good.
const LEAST_CAUTION: f32 = 1.0 / 1024.0;

impl Controller {
    /// The controller at the largest gain that is proved monotone, each tick.
    pub const CERTIFIED: Self = Self { gain: f32::INFINITY };

    /// A controller of gain `K`, 1/s, capped by the certified gain. A `K` that is not positive is taken as certified.
    pub const fn with_gain(gain: f32) -> Self {
        if gain > 0.0 { Self { gain } } else { Self::CERTIFIED }
    }

    /// One step of the law of Eq. (1) towards the point of the patch closest to `probe`, over `period` seconds.
    ///
    /// Invariance: `(u, v)` stays in `[0, 1]²`. Descent: the computed distance to `probe` never rises by more than
    /// rounding; a step that would is undone. Work: one evaluation of the patch. No panic; a probe that is not finite leaves the
    /// witness point where it is.
    #[inline]
    pub fn step<P: Patch>(&self, patch: &P, witness: &mut Witness, probe: Vec3, period: f32) -> Step {
        let errors = ProjectionErrors::new(&witness.surface, probe);
        let squared = errors.difference.length_squared();
        let distance_before = sqrt(squared);
        let descent = Descent::new(&errors, witness.parameters);
        witness.mode = descent.mode;
        // Also false for NaN.
        if !(descent.slope > 0.0 && squared < f32::INFINITY) {
            return Step { distance_before, residual: 0.0, gain: 0.0, outcome: Outcome::AtRest };
        }
        let certified = certified_gain(&descent, &patch.bounds(), distance_before) * witness.caution;
        let gain = certified.min(self.gain * period);
        let parameters = boundary::advance(witness.parameters, descent.direction, gain);
        let surface = patch.evaluate(parameters[0], parameters[1]);
        let outcome = if rises(&witness.surface, &surface, probe, squared, distance_before) {
            witness.caution = (0.5 * witness.caution).max(LEAST_CAUTION);
            Outcome::Undone
        } else {
            witness.caution = (2.0 * witness.caution).min(1.0);
            witness.parameters = parameters;
            witness.surface = surface;
            Outcome::Moved
        };
        Step { distance_before, residual: sqrt(descent.slope), gain, outcome }
    }
}

/// Whether the squared distance rose by more than rounding. Written so that NaN counts as a rise.
#[inline]
fn rises(before: &SurfacePoint, after: &SurfacePoint, probe: Vec3, squared: f32, distance: f32) -> bool {
    let now = (after.point - probe).length_squared();
    if now <= squared {
        return false;
    }
    let coordinates = (before.point.abs() + probe.abs()).max_element();
    let within_rounding = now - squared <= ROUNDING * coordinates * distance;
    !within_rounding
}

impl Witness {
    /// A witness point at `(u, v)`, moved into `[0, 1]²` if it lies outside; NaN is 0. One evaluation.
    pub fn at<P: Patch>(patch: &P, u: f32, v: f32) -> Self {
        let (u, v) = (saturate(u, 0.0, 1.0), saturate(v, 0.0, 1.0));
        Self { parameters: [u, v], surface: patch.evaluate(u, v), mode: BoundaryMode::Interior, caution: 1.0 }
    }

    /// The outward unit normal at the witness point; `None` where the tangents span no plane.
    #[inline]
    pub fn normal<P: Patch>(&self, patch: &P) -> Option<Vec3> {
        let across = self.surface.tangent_u.cross(self.surface.tangent_v);
        let squared = across.length_squared();
        (squared > f32::MIN_POSITIVE).then(|| across * (patch.orientation() / sqrt(squared)))
    }
}
