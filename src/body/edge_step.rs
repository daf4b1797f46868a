//! One step along an edge: the controller of one parameter.

use super::curve::SplineCurve;
use super::deformed::Cross;
use crate::math::{Vec3, saturate, sqrt_from_above};

/// Minimum second derivative of `½ ‖ΔR‖²` at which the model is solved, relative to `‖c'‖²`.
const MIN_CURVATURE: f32 = 1.0e-3;

/// Minimum of `1 + κ gap`: nearer to a focus, the border does not predict the closest point.
pub(super) const MIN_STRETCH: f32 = 0.25;

/// The start of a step along an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeStep {
    /// `ΔR = c − Q`, metres.
    pub difference: Vec3,
    /// `‖c'‖²`, m².
    pub stretch: f32,
    /// `ΔR · c'`, m².
    pub gradient: f32,
    /// `‖ΔR‖²`, m².
    pub squared: f32,
}

/// Position of a probe relative to the border of a face. `m` is the face's outward conormal there, with the length of
/// the derivative across the border along it; `k` is a positive number.
#[derive(Clone, Copy, Debug)]
pub(super) struct BorderSide {
    /// `k ΔR · m`, below 0 where the probe is beyond the face's region.
    product: f32,
    /// `k ‖m‖²`.
    square: f32,
    /// `k`.
    scale: f32,
    /// The derivative across the border, outward, times the edge's tangent, m².
    skew: f32,
}

impl BorderSide {
    /// Prediction of the closest point on the face from its border: the Gauss–Newton step across, shortened by
    /// `stretch`, and Newton's step along, where `½ ‖ΔR‖²` has the second derivative `hessian`, m². Returns the change
    /// of the parameter across, the parameter of the edge, and the first-order fall of `½ ‖ΔR‖²`, m².
    #[inline]
    pub(super) fn landing(&self, along: &EdgeStep, hessian: f32, t: f32, stretch: f32) -> ([f32; 2], f32) {
        let inside = saturate(self.product / (self.square * stretch), 0.0, 1.0);
        let beside = if hessian > MIN_STRETCH * along.stretch {
            saturate(t + (inside * self.skew - along.gradient) / hessian, 0.0, 1.0)
        } else {
            t
        };
        ([inside, beside], inside * self.product / self.scale)
    }
}

impl EdgeStep {
    #[inline]
    pub(super) fn new(point: Vec3, tangent: Vec3, probe: Vec3) -> Self {
        let difference = point - probe;
        let (stretch, gradient) = (tangent.length_squared(), difference.dot(tangent));
        Self { difference, stretch, gradient, squared: difference.length_squared() }
    }

    /// The second derivative of `½ ‖ΔR‖²` along the edge, m², by half of the edge's own.
    #[inline]
    pub(super) fn hessian(&self, half_second: Vec3) -> f32 {
        let bend = self.difference.dot(half_second);
        self.stretch + bend + bend
    }

    /// Whether an end of the edge holds the witness point: no point of the edge is nearer.
    #[inline]
    pub(super) fn is_held(&self, t: f32) -> bool {
        (t <= 0.0 && self.gradient >= 0.0) || (t >= 1.0 && self.gradient <= 0.0)
    }

    /// The parameter after one second-order step, if it is certified: theory §12 in one parameter, by bounds alone, of
    /// `‖c''‖`, `‖c'''‖` and the jumps of `c''`. Otherwise the uncertified one, if the model is convex.
    #[inline]
    pub(super) fn minimiser(
        &self,
        curve: &SplineCurve,
        [second, third, jump]: [f32; 3],
        half_second: Vec3,
        t: f32,
    ) -> Result<f32, Option<f32>> {
        let hessian = self.hessian(half_second);
        let is_convex = hessian > MIN_CURVATURE * self.stretch;
        if !is_convex {
            return Err(None);
        }
        let target = saturate(t - self.gradient / hessian, 0.0, 1.0);
        let change = target - t;
        let (slope, square) = (-self.gradient * change, change * change);
        let distance = sqrt_from_above(self.squared);
        let bend = second * square;
        let twist = third * square * change.abs();
        let length = sqrt_from_above(slope + distance * bend);
        let more = bend * (2.0 * length + bend) + (2.0 / 3.0) * (distance * twist);
        let beyond = curve.beyond_knots(t, target);
        let is_certain = more <= slope && (beyond <= 0.0 || more + 2.0 * distance * jump * beyond <= slope);
        if is_certain { Ok(target) } else { Err(Some(target)) }
    }

    /// The parameter after one first-order step, cut at the ends: Eq. (1)'s law `−g/G` with the longest gain that is
    /// proved to lower the distance, by the argument of [`crate::track::certified_gain`] in one parameter.
    #[inline]
    pub(super) fn advanced(&self, second_derivative: f32, t: f32) -> f32 {
        if !(self.stretch > f32::MIN_POSITIVE && self.gradient != 0.0) {
            return t;
        }
        let change = -self.gradient / self.stretch;
        let slope = -self.gradient * change;
        let bend = second_derivative * change * change;
        let (length, distance) = (sqrt_from_above(slope), sqrt_from_above(self.squared));
        let gain = slope / (slope + bend * (bend + 2.0 * length + distance));
        let target = t + if gain < 1.0 { gain } else { 1.0 } * change;
        // Also brings a NaN back.
        saturate(target, 0.0, 1.0)
    }

    /// [`BorderSide`]'s product alone: below 0 where the probe is beyond the border of a face, at a point of its edge
    /// with this tangent.
    #[inline(always)]
    pub(super) fn product(&self, cross: &Cross, tangent: Vec3, probe: Vec3) -> f32 {
        match cross {
            Cross::Plane { across, offset } => *offset - across.dot(probe),
            // The conormal is the part of the cross derivative that is normal to the edge; multiplied by the squared
            // tangent it needs no division.
            Cross::Ruled(cross) => {
                let out = self.difference.dot(*cross);
                if self.stretch > f32::MIN_POSITIVE {
                    self.stretch * out - cross.dot(tangent) * self.gradient
                } else {
                    out
                }
            }
        }
    }

    /// Position of the probe relative to that border.
    #[inline(always)]
    pub(super) fn inward(&self, cross: &Cross, tangent: Vec3, product: f32) -> BorderSide {
        match cross {
            Cross::Plane { across, .. } => {
                BorderSide { product, square: 1.0, scale: across.length_squared(), skew: 0.0 }
            }
            Cross::Ruled(cross) if self.stretch > f32::MIN_POSITIVE => {
                let skew = cross.dot(tangent);
                let square = self.stretch * cross.length_squared() - skew * skew;
                BorderSide { product, square, scale: self.stretch, skew }
            }
            Cross::Ruled(_) => BorderSide { product, square: f32::INFINITY, scale: 1.0, skew: 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;
    use crate::patch::Coefficients;

    /// 2 m along x, from the middle.
    const fn straight(second_derivative: f32) -> SplineCurve<'static> {
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
        let along = EdgeStep::new(at.point, at.tangent, at.point + vec3(0.5, 1.2, 0.0));
        assert_eq!([along.stretch, along.gradient], [4.0, -1.0]);
        // w = 1/4, s = 1/4, K w² = 1/2: the gain is s / ((√s + K w²)² + 1.3 K w²) = 0.25 / 1.65, with
        // roots from above.
        let expected = 0.25 + 0.25 * 0.25 / 1.65;
        let found = along.advanced(curve.second_derivative, 0.25);
        let shortest = 0.25 + 0.25 * 0.25 / (1.65 * crate::math::ROOT_EXCESS * crate::math::ROOT_EXCESS);
        assert!(shortest <= found && found <= expected + f32::EPSILON, "{found}");
        // Where nothing bends, all the way.
        assert_eq!(along.advanced(0.0, 0.25), 0.5);
    }

    /// A face that grows by 4 m a unit of its parameter away from the edge, towards −y, its separator given both ways:
    /// as a plane, and by a cross derivative that slants along the edge.
    fn separators() -> [Cross; 2] {
        [Cross::Plane { across: vec3(0.0, 0.25, 0.0), offset: 0.0 }, Cross::Ruled(vec3(3.0, 4.0, 0.0))]
    }

    #[test]
    fn beyond_a_face_is_beyond_its_separator() {
        let at = straight(0.0).evaluate(0.5);
        for (height, is_beyond) in [(0.5, true), (-0.5, false)] {
            let probe = vec3(0.1, height, 0.0);
            let along = EdgeStep::new(at.point, at.tangent, probe);
            for separator in &separators() {
                let product = along.product(separator, at.tangent, probe);
                assert_eq!(product < 0.0, is_beyond, "{height}, {separator:?}");
            }
        }
    }

    /// Of a plane face `f(w, t) = c(t) − w d`: with `d = (3, 4, 0)` and `c' = (2, 0, 0)` the foot is exact.
    #[test]
    fn a_flat_face_is_entered_at_the_foot_of_the_probe() {
        let at = straight(0.0).evaluate(0.5);
        let probe = at.point + vec3(0.2, -1.0, 3.0);
        let along = EdgeStep::new(at.point, at.tangent, probe);
        // Across, w = 1/4. EdgeStep, 2 Δt − 3 w = 0.2 where the derivative slants, 2 Δt = 0.2 where it does not.
        for (separator, beside) in separators().iter().zip([0.6, 0.975]) {
            let inward = along.inward(separator, at.tangent, along.product(separator, at.tangent, probe));
            let ([inside, t], slope) = inward.landing(&along, along.stretch, 0.5, 1.0);
            // A few roundings of numbers near 1.
            assert!((inside - 0.25).abs() < 4.0 * f32::EPSILON, "{inside}");
            assert!((t - beside).abs() < 4.0 * f32::EPSILON, "{t}");
            // The square of the way across, 1 m.
            assert!((slope - 1.0).abs() < 8.0 * f32::EPSILON, "{slope}");
        }
        let [plane, _] = separators();
        let inward = along.inward(&plane, at.tangent, along.product(&plane, at.tangent, probe));
        assert_eq!(
            inward.landing(&along, along.stretch, 0.5, f32::INFINITY).0[0],
            0.0,
            "where nothing is known of the face"
        );
        assert_eq!(inward.landing(&along, along.stretch, 0.5, 0.125).0[0], 1.0, "not beyond the other side");
    }
}
