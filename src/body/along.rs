//! One step along an edge: the controller of one parameter.

use super::curve::{CurvePoint, SplineCurve};
use crate::math::{Vec3, sqrt};

/// Where a step along an edge starts from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Along {
    /// `ΔR = c − Q`, metres.
    pub difference: Vec3,
    /// `‖c'‖²`, m².
    pub stretch: f32,
    /// `ΔR · c'`, m².
    pub gradient: f32,
}

impl Along {
    #[inline]
    pub(super) fn new(at: &CurvePoint, probe: Vec3) -> Self {
        let difference = at.point - probe;
        let (stretch, gradient) = (at.tangent.length_squared(), difference.dot(at.tangent));
        Self { difference, stretch, gradient }
    }

    /// Whether an end of the edge holds the witness point: nearer lies only what is beyond it.
    #[inline]
    pub(super) fn is_held(&self, t: f32) -> bool {
        (t <= 0.0 && self.gradient >= 0.0) || (t >= 1.0 && self.gradient <= 0.0)
    }

    /// The parameter after one step, cut at the ends: Eq. (1)'s law `−g/G` with the longest gain that is proved to lower the
    /// distance, by the argument of [`crate::track::certified_gain`] in one parameter.
    #[inline]
    pub(super) fn advanced(&self, curve: &SplineCurve, t: f32) -> f32 {
        if !(self.stretch > f32::MIN_POSITIVE && self.gradient != 0.0) {
            return t;
        }
        let change = -self.gradient / self.stretch;
        let slope = -self.gradient * change;
        let bend = curve.second_derivative * change * change;
        let reach = sqrt(slope) + bend;
        let gain = slope / (reach * reach + bend * sqrt(self.difference.length_squared()));
        let target = t + if gain < 1.0 { gain } else { 1.0 } * change;
        // Also brings a NaN back.
        crate::math::saturate(target, 0.0, 1.0)
    }

    /// How far the probe is beyond a face's region, as the cosine-weighted distance `(Q − c) · m`, metres, with `m` the unit conormal made
    /// of the face's cross derivative: its part normal to the edge. Positive once the probe has left the face.
    #[inline]
    pub(super) fn beyond(&self, at: &CurvePoint, cross: Vec3) -> f32 {
        if self.stretch <= f32::MIN_POSITIVE || self.stretch.is_nan() {
            return -self.difference.dot(cross);
        }
        let conormal = cross - at.tangent * (cross.dot(at.tangent) / self.stretch);
        let squared = conormal.length_squared();
        if squared > f32::MIN_POSITIVE { -self.difference.dot(conormal) / sqrt(squared) } else { 0.0 }
    }
}
