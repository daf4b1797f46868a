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

/// So near a pole, in parameters, the tangent around it is rounding.
const AT_POLE: f32 = 1.0e-6;

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
}

impl Pole {
    /// The nearest of a face's poles.
    #[inline(always)]
    pub(super) fn nearest(poles: u8, at: [f32; 2]) -> Option<Self> {
        if poles == 0 {
            return None;
        }
        let mut nearest: Option<Self> = None;
        for side in 0..4_usize {
            let axis = side >> 1;
            let (inward, away) = if side & 1 == 0 { (1.0, at[axis]) } else { (-1.0, 1.0 - at[axis]) };
            if poles >> side & 1 == 1 && nearest.is_none_or(|nearest| away < nearest.away) {
                nearest = Some(Self { is_along_v: axis == 1, inward, away });
            }
        }
        nearest
    }

    /// What the mixed second derivative of `φ` is more by, with the gradient of `φ`.
    pub(super) fn mixed(&self, gradient: [f32; 2]) -> f32 {
        if self.away > AT_POLE { -self.inward * gradient[1 - self.axis()] / self.away } else { 0.0 }
    }

    /// By how much `η` may be more for a change of one across, for its room is the parameter's, and that is `η w / (w +
    /// ω)`: 0 at the pole, where nothing is told apart.
    pub(super) fn spread(&self) -> f32 {
        if self.away > AT_POLE { self.inward / self.away } else { 0.0 }
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
        if self.away > AT_POLE && left > AT_POLE {
            unrolled[1 - self.axis()] *= self.away / left;
        }
        unrolled
    }

    /// Half of a step, by its change of the parameters: the same way in `(η, ω)`.
    pub(super) fn halved(&self, change: [f32; 2]) -> [f32; 2] {
        let left = self.away + self.inward * change[self.axis()];
        let mut half = change.map(|change| 0.5 * change);
        if self.away > AT_POLE && left > AT_POLE {
            half[1 - self.axis()] *= left / self.away;
        }
        self.unrolled(half)
    }

    /// At the pole, where the slope into the face is not downhill here: the step to the end of the range where it
    /// should be, and what it should gain. `bend` is `φ_uv`, `form` the first fundamental form's `[uu, uv, vv]`, `room`
    /// how far the parameters may go.
    pub(super) fn around(
        &self,
        gradient: [f32; 2],
        bend: f32,
        form: [f32; 3],
        room: [[f32; 2]; 2],
    ) -> Option<([f32; 2], f32)> {
        if self.away > AT_POLE {
            return None;
        }
        let (across, along) = (self.axis(), 1 - self.axis());
        let (slope, turn) = (self.inward * gradient[across], self.inward * bend);
        let reach = room[usize::from(turn < 0.0)][along];
        let (downhill, stretch) = (slope + turn * reach, form[2 * across]);
        if !(slope >= 0.0 && downhill < 0.0 && stretch > f32::MIN_POSITIVE) {
            return None;
        }
        let mut change = [0.0; 2];
        change[along] = reach;
        change[across] = -self.inward * downhill / stretch;
        Some((change, 0.5 * downhill * downhill / -stretch))
    }
}
