//! Second order beside a pole: a side of a face that is one point.
//!
//! Around a pole the surface is `p + w d(y)`, like polar coordinates: all of `f_y` shrinks with the distance `w` from
//! the pole, so that a change of `y` that is good here is far too long a little farther out, and leads around the pole
//! a little nearer to it. Searched for is instead `η` in `y + η w / (w + ω)`, with `ω` the change of `w`: a step in the
//! tangent plane. In `(η, ω)` the gradient is the same and the mixed second derivative of `φ` is `φ_yw − φ_y / w`; on a
//! planar triangle that makes the quadratic model the distance itself.
//!
//! At the pole there is no `φ_y`. The slope `φ_w` into the face is then a function of `y`, and `φ_yw` says where it
//! falls.

use super::feature::{Face, Side};
use crate::math::saturate;
use crate::patch::{Patch as _, SplinePatch};

/// So near a pole, in sizes of the body, the tangent around it may be rounding: coordinates of that size are rounded by
/// `6e-8`, a hundredth of this and less with the tangents made of them.
const AT_POLE: f32 = 1.0e-5;

/// The same in parameters of a patch, for a body of a size, metres.
#[inline]
pub(super) fn at_pole(patch: &SplinePatch, size: f32) -> f32 {
    AT_POLE * size / patch.size()
}

/// A second derivative of `φ` closer to 0 than this part of that without curvature is taken for so much.
const FLAT: f32 = 1.0e-2;

/// What stands in for a second derivative of `φ` along one parameter: the same without its sign, not close to 0 by
/// what it is without curvature.
pub(super) fn bend_of(newton: f32, form: f32) -> f32 {
    saturate(newton.abs(), FLAT * form, f32::MAX)
}

impl Face<'_> {
    /// Which of its sides are poles, as bits.
    #[inline]
    pub const fn poles(&self) -> u8 {
        let [lower_u, upper_u, lower_v, upper_v] = &self.sides;
        bit(lower_u) | bit(upper_u) << 1 | bit(lower_v) << 2 | bit(upper_v) << 3
    }
}

const fn bit(side: &Side) -> u8 {
    matches!(side, Side::Pole { .. }) as u8
}

/// A pole as seen from a point of its face.
#[derive(Clone, Copy)]
pub(super) struct Pole {
    /// Whether `v` leads away from it, not `u`: as an index 0 or 1, which the compiler sees.
    is_along_v: bool,
    /// Whether that parameter rises on the way: 1, else −1.
    inward: f32,
    /// How far the point is from the pole along it.
    away: f32,
    /// So near it is at the pole, see [`at_pole`].
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

    /// Whether nothing around it can be told apart from the point.
    #[inline]
    fn is_at_pole(&self) -> bool {
        self.away <= self.near
    }

    /// What the mixed second derivative of `φ` is more by, with the gradient of `φ`.
    pub(super) fn mixed(&self, gradient: [f32; 2]) -> f32 {
        if self.is_at_pole() { 0.0 } else { -self.inward * gradient[1 - self.axis()] / self.away }
    }

    /// By how much `η` may be more for a change of one across, for its room is the parameter's, and that is `η w / (w +
    /// ω)`: 0 at the pole, where nothing is told apart.
    pub(super) fn spread(&self) -> f32 {
        if self.is_at_pole() { 0.0 } else { self.inward / self.away }
    }

    /// The index of the parameter that leads away from it.
    pub(super) const fn axis(&self) -> usize {
        self.is_along_v as usize
    }

    /// From a step `(η, ω)` to the change of the parameters. One that ends at the pole keeps its `η`: where on the pole
    /// does not matter.
    pub(super) fn unrolled(&self, change: [f32; 2]) -> [f32; 2] {
        let left = self.away + self.inward * change[self.axis()];
        let mut unrolled = change;
        if !self.is_at_pole() && left > self.near {
            unrolled[1 - self.axis()] *= self.away / left;
        }
        unrolled
    }

    /// Half of a step, by its change of the parameters: the same way in `(η, ω)`.
    pub(super) fn halved(&self, change: [f32; 2]) -> [f32; 2] {
        let left = self.away + self.inward * change[self.axis()];
        let mut half = change.map(|change| 0.5 * change);
        if !self.is_at_pole() && left > self.near {
            half[1 - self.axis()] *= left / self.away;
        }
        self.unrolled(half)
    }

    /// From the pole: the step into the face, and what it should gain. `None` away from it, or where no slope into the
    /// face is downhill. `newton` is the Hessian, `form` the first fundamental form, `[uu, uv, vv]`; `room` how far the
    /// parameters may go.
    ///
    /// Here the slope is a function of `y` alone. Straight on, unless at the end of the range where it falls it should
    /// be twice as steep: a straight line overshoots a cosine.
    pub(super) fn out_of(
        &self,
        gradient: [f32; 2],
        newton: [f32; 3],
        form: [f32; 3],
        room: [[f32; 2]; 2],
    ) -> Option<([f32; 2], f32)> {
        if !self.is_at_pole() {
            return None;
        }
        let (across, along) = (self.axis(), 1 - self.axis());
        let (slope, turn) = (self.inward * gradient[across], self.inward * (newton[1] - form[1]));
        let reach = room[usize::from(turn < 0.0)][along];
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
        let most = room[usize::from(self.inward > 0.0)][across].abs();
        let way = saturate(-downhill / bend, 0.0, most);
        change[across] = self.inward * way;
        Some((change, way * (downhill + 0.5 * bend * way)))
    }
}
