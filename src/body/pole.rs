//! Second order near a pole: a side of a face that is one point.
//!
//! Around a pole the surface is `p + w d(y)`, like polar coordinates: all of `f_y` shrinks with the distance `w` from
//! the pole. A good change of `y` is far too long a little farther out, and leads around the pole a little nearer to
//! it. The unknown is instead `η` in `y + η w / (w + ω)`, with `ω` the change of `w`: a step in the tangent plane. In
//! `(η, ω)` the gradient is the same and the mixed second derivative of `φ` is `φ_yw − φ_y / w`; on a planar triangle
//! that makes the quadratic model exact.
//!
//! At the pole there is no `φ_y`. The slope `φ_w` into the face is then a function of `y`, with the derivative `φ_yw`.

use super::feature::{Face, Side};
use crate::math::{Vec3, saturate};
use crate::patch::{Patch as _, SplinePatch, SurfacePoint};

/// Distance from a pole, relative to the body's size, below which the tangent around it may be rounding: coordinates
/// are rounded by `6e-8` of the size, a hundredth of this and less with the tangents computed from them.
const AT_POLE: f32 = 1.0e-5;

/// The same in parameters of a patch, for a body of a size, metres.
#[inline]
pub(super) fn at_pole(patch: &SplinePatch, size: f32) -> f32 {
    AT_POLE * size / patch.size()
}

/// Minimum of a second derivative of `φ`, relative to its part without curvature.
const FLAT: f32 = 1.0e-2;

/// Positive replacement for a second derivative of `φ` along one parameter: its absolute value, but at least [`FLAT`]
/// times its part without curvature.
pub(super) fn bend_of(newton: f32, form: f32) -> f32 {
    saturate(newton.abs(), FLAT * form, f32::MAX)
}

impl Face<'_> {
    /// The sides that are poles, as bits.
    #[inline]
    pub const fn poles(&self) -> u8 {
        let [lower_u, upper_u, lower_v, upper_v] = &self.sides;
        bit(lower_u) | bit(upper_u) << 1 | bit(lower_v) << 2 | bit(upper_v) << 3
    }
}

const fn bit(side: &Side) -> u8 {
    matches!(side, Side::Pole { .. }) as u8
}

/// A pole, relative to a point of its face.
#[derive(Clone, Copy)]
pub(super) struct Pole {
    /// Whether `v` leads away from it, not `u`: as an index 0 or 1, known to the compiler.
    is_along_v: bool,
    /// 1 if that parameter rises away from the pole, else −1.
    inward: f32,
    /// Distance of the point from the pole along that parameter.
    away: f32,
    /// Distance below which the point is at the pole, see [`at_pole`].
    near: f32,
}

impl Pole {
    /// The nearest of a face's poles, on a patch of a body of a size, metres.
    #[inline(always)]
    pub(super) fn nearest(poles: u8, at: [f32; 2], patch: &SplinePatch, size: f32) -> Option<Self> {
        if poles == 0 {
            return None;
        }
        let near = at_pole(patch, size);
        let mut nearest: Option<Self> = None;
        for side in 0..4_usize {
            let axis = side >> 1;
            let (inward, away) = if side & 1 == 0 { (1.0, at[axis]) } else { (-1.0, 1.0 - at[axis]) };
            if poles >> side & 1 == 1 && nearest.is_none_or(|nearest| away < nearest.away) {
                nearest = Some(Self { is_along_v: axis == 1, inward, away, near });
            }
        }
        nearest
    }

    /// The tangent that leads away from the pole, at a point of its face.
    pub(super) fn meridian(&self, at: &SurfacePoint) -> Vec3 {
        (if self.is_along_v { at.tangent_v } else { at.tangent_u }) * self.inward
    }

    /// Whether the parameter around the pole is only rounding at the point.
    #[inline]
    pub(super) fn is_at_pole(&self) -> bool {
        self.away <= self.near
    }

    /// Correction of the mixed second derivative of `φ` for the gradient of `φ`.
    pub(super) fn mixed(&self, gradient: [f32; 2]) -> f32 {
        if self.is_at_pole() { 0.0 } else { -self.inward * self.turned(gradient)[0] / self.away }
    }

    /// Change of the range of `η` for a change of one across: the range is that of the parameter, which is `η w / (w +
    /// ω)`. 0 at the pole.
    pub(super) fn spread(&self) -> f32 {
        if self.is_at_pole() { 0.0 } else { self.inward / self.away }
    }

    /// The index of the parameter that leads away from it.
    pub(super) const fn axis(&self) -> usize {
        self.is_along_v as usize
    }

    /// Numbers of `u` and `v` as those around the pole and away from it, and back.
    #[inline(always)]
    pub(super) const fn turned(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        if self.is_along_v { [u, v] } else { [v, u] }
    }

    /// The change of the parameters for a step `(η, ω)`. A step that ends at the pole keeps its `η`: the parameter
    /// there does not matter.
    pub(super) fn unrolled(&self, change: [f32; 2]) -> [f32; 2] {
        let [beside, out] = self.turned(change);
        let left = self.away + self.inward * out;
        let is_around = !self.is_at_pole() && left > self.near;
        self.turned([if is_around { beside * (self.away / left) } else { beside }, out])
    }

    /// Half of a step that is given by its change of the parameters, in the same direction in `(η, ω)`.
    pub(super) fn halved(&self, change: [f32; 2]) -> [f32; 2] {
        let [beside, out] = self.turned(change);
        let left = self.away + self.inward * out;
        let is_around = !self.is_at_pole() && left > self.near;
        let half = if is_around { 0.5 * beside * (left / self.away) } else { 0.5 * beside };
        self.unrolled(self.turned([half, 0.5 * out]))
    }

    /// At the pole: the step into the face, and its predicted gain. `None` if no slope into the face is downhill.
    /// `newton` is the Hessian, `form` the first fundamental form, `[uu, uv, vv]`; `range` is the range of the changes.
    ///
    /// Here the slope is a function of `y` alone. The step goes straight on, unless the slope at the end of the range
    /// where it falls should be twice as steep: a straight line overshoots a cosine.
    pub(super) fn out_of(
        &self,
        gradient: [f32; 2],
        newton: [f32; 3],
        form: [f32; 3],
        range: [[f32; 2]; 2],
    ) -> Option<([f32; 2], f32)> {
        let (across, along) = (self.axis(), 1 - self.axis());
        let (slope, turn) = (self.inward * gradient[across], self.inward * (newton[1] - form[1]));
        let reach = range[usize::from(turn < 0.0)][along];
        let at_end = slope + turn * reach;
        let mut change = [0.0; 2];
        let mut downhill = slope;
        if at_end < 0.0 && at_end < 2.0 * slope {
            (change[along], downhill) = (reach, at_end);
        }
        let bend = bend_of(newton[2 * across], form[2 * across]);
        if !(downhill < 0.0 && bend > f32::MIN_POSITIVE) {
            return None;
        }
        let most = range[usize::from(self.inward > 0.0)][across].abs();
        let way = saturate(-downhill / bend, 0.0, most);
        change[across] = self.inward * way;
        Some((change, way * (downhill + 0.5 * bend * way)))
    }
}
