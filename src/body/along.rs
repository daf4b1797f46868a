//! One step along an edge: the controller of one parameter.

use super::curve::{CurvePoint, SplineCurve};
use super::feature::Separator;
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

    /// Whether the probe is beyond a face's region at the parameter `t` of its edge, `(Q − c) · m > 0` with `m` the face's conormal there.
    #[inline]
    pub(super) fn is_beyond(&self, separator: &Separator, at: &CurvePoint, t: f32, probe: Vec3) -> bool {
        match separator {
            Separator::Plane { normal, offset } => normal.dot(probe) > *offset,
            // The conormal is the part of the cross derivative that is normal to the edge; times the tangent's square there is nothing to
            // divide.
            Separator::Ruled(cross) => {
                let cross = cross.evaluate(t).point;
                let out = self.difference.dot(cross);
                if self.stretch <= f32::MIN_POSITIVE {
                    return out < 0.0;
                }
                self.stretch * out < cross.dot(at.tangent) * self.gradient
            }
        }
    }
}
