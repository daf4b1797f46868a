//! One step along an edge: the controller of one parameter.

use super::curve::{CurvePoint, SplineCurve};
use super::feature::{Edge, Separator};
use crate::math::{Vec3, saturate, sqrt_from_above};

/// The least second derivative of `½ ‖ΔR‖²` at which its model is solved, as a part of `‖c'‖²`.
const MIN_CURVATURE: f32 = 1.0e-3;

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

    /// The parameter after one step of second order, where it is certain: the certificate of theory §12 in one
    /// parameter, with bounds alone.
    #[inline]
    pub(super) fn minimiser(&self, edge: &Edge, half_second: Vec3, t: f32) -> Option<f32> {
        let bend = self.difference.dot(half_second);
        let hessian = self.stretch + bend + bend;
        let is_convex = hessian > MIN_CURVATURE * self.stretch;
        if !is_convex {
            return None;
        }
        let target = saturate(t - self.gradient / hessian, 0.0, 1.0);
        let change = target - t;
        let (slope, square) = (-self.gradient * change, change * change);
        let distance = sqrt_from_above(self.difference.length_squared());
        let bend = edge.curve.second_derivative * square;
        let twist = edge.third_derivative * square * change.abs();
        let length = sqrt_from_above(slope + distance * bend);
        let more = bend * (2.0 * length + bend) + (2.0 / 3.0) * (distance * twist);
        let beyond = edge.curve.beyond_knots(t, target);
        let is_certain = more <= slope && (beyond <= 0.0 || more + 2.0 * distance * edge.jump * beyond <= slope);
        is_certain.then_some(target)
    }

    /// The parameter after one step of first order, cut at the ends: Eq. (1)'s law `−g/G` with the longest gain that is
    /// proved to lower the distance, by the argument of [`crate::track::certified_gain`] in one parameter.
    #[inline]
    pub(super) fn advanced(&self, curve: &SplineCurve, t: f32) -> f32 {
        if !(self.stretch > f32::MIN_POSITIVE && self.gradient != 0.0) {
            return t;
        }
        let change = -self.gradient / self.stretch;
        let slope = -self.gradient * change;
        let bend = curve.second_derivative * change * change;
        let (length, distance) = (sqrt_from_above(slope), sqrt_from_above(self.difference.length_squared()));
        let gain = slope / (slope + bend * (bend + 2.0 * length + distance));
        let target = t + if gain < 1.0 { gain } else { 1.0 } * change;
        // Also brings a NaN back.
        saturate(target, 0.0, 1.0)
    }

    /// Whether the probe is beyond a face's region at the parameter `t` of its edge, `(Q − c) · m > 0` with `m` the
    /// face's conormal there.
    #[inline]
    pub(super) fn is_beyond(&self, separator: &Separator, at: &CurvePoint, t: f32, probe: Vec3) -> bool {
        match separator {
            Separator::Plane { normal, offset } => normal.dot(probe) > *offset,
            // The conormal is the part of the cross derivative that is normal to the edge; times the tangent's square
            // there is nothing to divide.
            Separator::Ruled(cross) => {
                let cross = cross.point(t);
                let out = self.difference.dot(cross);
                if self.stretch <= f32::MIN_POSITIVE {
                    return out < 0.0;
                }
                self.stretch * out < cross.dot(at.tangent) * self.gradient
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::patch::Coefficients;

    /// 2 m along x, from the middle.
    const fn straight(second_derivative: f32) -> SplineCurve {
        SplineCurve {
            degree: 1,
            breaks: &[0.0, 1.0],
            coefficients: Coefficients::Polynomial(&[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]),
            second_derivative,
        }
    }

    #[test]
    fn a_step_is_as_long_as_the_bound_of_the_bend_allows() {
        let curve = straight(8.0);
        let at = curve.evaluate(0.25);
        // 0.5 m farther along and 1.2 m beside it: 1.3 m away.
        let along = Along::new(&at, at.point + vec3(0.5, 1.2, 0.0));
        assert_eq!([along.stretch, along.gradient], [4.0, -1.0]);
        // w = 1/4, s = 1/4, K w² = 1/2: the gain is s / ((√s + K w²)² + 1.3 K w²) = 0.25 / 1.65, with
        // roots from above.
        let expected = 0.25 + 0.25 * 0.25 / 1.65;
        let found = along.advanced(&curve, 0.25);
        let shortest = 0.25 + 0.25 * 0.25 / (1.65 * crate::math::ROOT_EXCESS * crate::math::ROOT_EXCESS);
        assert!(shortest <= found && found <= expected + f32::EPSILON, "{found}");
        // Where nothing bends, all the way.
        assert_eq!(along.advanced(&straight(0.0), 0.25), 0.5);
    }

    #[test]
    fn beyond_a_face_is_beyond_its_separator() {
        let curve = straight(0.0);
        let at = curve.evaluate(0.5);
        let plane = Separator::Plane { normal: vec3(0.0, 1.0, 0.0), offset: 0.25 };
        // The face's cross derivative, slanted along the edge: its conormal is y all the same.
        let ruled = Separator::Ruled(SplineCurve {
            degree: 0,
            breaks: &[0.0, 1.0],
            coefficients: Coefficients::Polynomial(&[[3.0, 1.0, 0.0]]),
            second_derivative: 0.0,
        });
        for (height, is_beyond) in [(0.5, true), (0.2, false), (-0.5, false)] {
            let probe = vec3(0.1, height, 0.0);
            assert_eq!(Along::new(&at, probe).is_beyond(&plane, &at, 0.5, probe), is_beyond, "{height}");
        }
        for (height, is_beyond) in [(0.5, true), (-0.5, false)] {
            let probe = vec3(0.1, height, 0.0);
            assert_eq!(Along::new(&at, probe).is_beyond(&ruled, &at, 0.5, probe), is_beyond, "{height}");
        }
    }
}
