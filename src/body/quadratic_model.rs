//! The quadratic model of half the squared distance at a point of a patch, and its minimiser over a rectangle of
//! parameters.
//!
//! With `φ = ½ ‖f − Q‖²`, gradient `g` and Hessian `H = I + ΔR · D²f` it is `g · δ + ½ δᵀ H δ` if `H` is positive
//! definite. Otherwise the absolute values of the diagonal replace it, which lead away from a saddle, or `I` alone
//! (Gauss–Newton). Near a pole the model is one in polar coordinates ([`super::pole`]).

use super::pole::{Pole, bend_of};
use crate::math::{Vec3, saturate};
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::track::shifted;

/// A determinant below this fraction of the product of the diagonal is rounding.
const MIN_DETERMINANT: f32 = 1.0e-4;
/// `φ` and its derivatives at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DistanceDerivatives {
    pub half_squared: f32,
    pub gradient: [f32; 2],
    /// The first fundamental form, and the Hessian: `[uu, uv, vv]`.
    pub form: [f32; 3],
    pub newton: [f32; 3],
}

impl DistanceDerivatives {
    pub const NONE: Self = Self { half_squared: 0.0, gradient: [0.0; 2], form: [0.0; 3], newton: [0.0; 3] };

    #[inline]
    pub(super) fn new(surface: &SurfacePoint, second: &SecondDerivatives, probe: Vec3) -> Self {
        let (f_u, f_v, difference) = (surface.tangent_u, surface.tangent_v, surface.point - probe);
        let form = [f_u.dot(f_u), f_u.dot(f_v), f_v.dot(f_v)];
        let bend = second.along(difference);
        let newton = [form[0] + bend[0], form[1] + bend[1], form[2] + bend[2]];
        let gradient = [difference.dot(f_u), difference.dot(f_v)];
        Self { half_squared: 0.5 * difference.length_squared(), gradient, form, newton }
    }
}

/// The quadratic model of `φ` at a point.
#[derive(Debug)]
pub(super) struct Model {
    gradient: [f32; 2],
    /// `[uu, uv, vv]`, positive definite but for poles.
    hessian: [f32; 3],
    /// Whether that is the Hessian itself.
    pub is_newton: bool,
}

impl Model {
    /// At a point, beside a pole in the coordinates of [`super::pole`].
    #[inline(always)]
    pub(super) fn new(
        &DistanceDerivatives { gradient, form, newton: [uu, uv, vv], .. }: &DistanceDerivatives,
        pole: Option<Pole>,
    ) -> Self {
        let newton = [uu, pole.map_or(uv, |pole| uv + pole.mixed(gradient)), vv];
        let is_newton = is_positive_definite(newton);
        let hessian = if is_newton { newton } else { Self::stand_in(form, newton) };
        Self { gradient, hessian, is_newton }
    }

    /// Replacement for a Hessian that is not positive definite.
    #[inline(never)]
    fn stand_in(form: [f32; 3], newton: [f32; 3]) -> [f32; 3] {
        // Along an arc of equal distance φ is flat, and at a saddle it falls both ways: the other parameter still
        // counts.
        let mixed = [0, 2].map(|axis| bend_of(newton[axis], form[axis]));
        let mixed = [mixed[0], newton[1], mixed[1]];
        if is_positive_definite(mixed) {
            mixed
        } else if is_positive_definite(form) {
            form
        } else {
            // Near a pole: the trace is not below the largest eigenvalue, a plain gradient step.
            let trace = form[0] + form[2];
            [trace, 0.0, trace]
        }
    }

    /// The step to the minimiser, beside a pole in the coordinates of [`super::pole`], and the model's value there.
    #[inline(always)]
    pub(super) fn step(&self, seen: &DistanceDerivatives, pole: Option<Pole>, range: [[f32; 2]; 2]) -> ([f32; 2], f32) {
        let Some(pole) = pole else { return self.minimiser(range) };
        if pole.is_at_pole()
            && let Some(step) = pole.out_of(seen.gradient, seen.newton, seen.form, range)
        {
            return step;
        }
        let (change, fall) = self.minimiser_near_pole(&pole, range);
        (pole.unrolled(change), fall)
    }

    /// At a rest where `H` is not positive definite: the step to the minimum over `range` of the quadratic itself along
    /// what no border holds, away from a saddle; or, if the shifted model promises more than `worth`, its step. And the
    /// value there.
    #[inline(never)]
    pub(super) fn away_from_rest(
        &self,
        seen: &DistanceDerivatives,
        [lower, upper]: [[f32; 2]; 2],
        worth: f32,
    ) -> ([f32; 2], f32) {
        if is_positive_definite(seen.form) {
            let shifted = Self { hessian: shifted(seen.form, seen.newton), ..*self };
            let step = shifted.minimiser([lower, upper]);
            if -step.1 > worth {
                return step;
            }
        }
        let free = |axis: usize| {
            let slope = self.gradient[axis];
            let is_held = (lower[axis] >= 0.0 && slope > 0.0) || (upper[axis] <= 0.0 && slope < 0.0);
            if is_held { [0.0; 2] } else { [lower[axis], upper[axis]] }
        };
        let ([low_u, high_u], [low_v, high_v]) = (free(0), free(1));
        Self { hessian: seen.newton, ..*self }.minimiser_on_sides([[low_u, low_v], [high_u, high_v]], None)
    }

    /// The model's gradient after a step.
    pub(super) fn slope(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let [a, b, c] = self.hessian;
        [self.gradient[0] + a * u + b * v, self.gradient[1] + b * u + c * v]
    }

    /// Minimum of `g · δ` with `δ` in `range`: not positive.
    pub(super) fn max_fall(&self, [lower, upper]: [[f32; 2]; 2]) -> f32 {
        let along = |axis: usize| {
            let (low, high) = (self.gradient[axis] * lower[axis], self.gradient[axis] * upper[axis]);
            if low < high { low } else { high }
        };
        along(0) + along(1)
    }

    /// Upper bound of the fall of `φ` from a point where its derivatives are at most these, m², by this Hessian: `½
    /// gᵀH⁻¹g`.
    #[inline(always)]
    pub(super) fn fall_at_most(&self, [p, q]: [f32; 2]) -> f32 {
        let [a, b, c] = self.hessian;
        (0.5 * (c * p * p + a * q * q) + b.abs() * p * q) / (a * c - b * b)
    }

    /// The minimiser of the model over `range`, and the model's value there. Either the free minimiser is inside, or the
    /// minimiser is on a side that the free one is beyond: the model falls all the way to the free one.
    #[inline(always)]
    fn minimiser(&self, [lower, upper]: [[f32; 2]; 2]) -> ([f32; 2], f32) {
        let [a, b, c] = self.hessian;
        let [p, q] = self.gradient;
        let determinant = a * c - b * b;
        let free = [(b * q - c * p) / determinant, (b * p - a * q) / determinant];
        let inside = |axis: usize| free[axis] >= lower[axis] && free[axis] <= upper[axis];
        if determinant > 0.0 && inside(0) && inside(1) {
            return (free, self.value(free));
        }
        self.minimiser_on_sides([lower, upper], (determinant > 0.0).then_some(free))
    }

    /// On the sides that the free minimiser is beyond; on all four if there is none.
    #[inline(never)]
    fn minimiser_on_sides(&self, [lower, upper]: [[f32; 2]; 2], free: Option<[f32; 2]>) -> ([f32; 2], f32) {
        let [a, b, c] = self.hessian;
        let [p, q] = self.gradient;
        let mut best = ([0.0; 2], 0.0);
        let is_below = |axis: usize| free.is_none_or(|free| free[axis] < lower[axis]);
        let is_above = |axis: usize| free.is_none_or(|free| free[axis] > upper[axis]);
        for (u, _) in [(lower[0], is_below(0)), (upper[0], is_above(0))].into_iter().filter(|side| side.1) {
            self.consider(u, minimiser_on_line(q + b * u, c, [lower[1], upper[1]]), &mut best);
        }
        for (v, _) in [(lower[1], is_below(1)), (upper[1], is_above(1))].into_iter().filter(|side| side.1) {
            self.consider(minimiser_on_line(p + b * v, a, [lower[0], upper[0]]), v, &mut best);
        }
        best
    }

    /// The same in the coordinates of a pole: the range of `η` is a wedge, as wide at the point as that of the
    /// parameter.
    #[inline(never)]
    fn minimiser_near_pole(&self, pole: &Pole, [lower, upper]: [[f32; 2]; 2]) -> ([f32; 2], f32) {
        let ([a, b, c], spread) = (self.hessian, pole.spread());
        let [p, q] = self.gradient;
        let determinant = a * c - b * b;
        let free = [(b * q - c * p) / determinant, (b * p - a * q) / determinant];
        let [[left, nearest], [right, farthest]] = [lower, upper].map(|ends| pole.turned(ends));
        let ([slope_beside, slope_out], [bend_beside, bend_out]) = (pole.turned(self.gradient), pole.turned([a, c]));
        let [beside, out] = pole.turned(free);
        let width = 1.0 + spread * out;
        let is_beyond = [out < nearest, out > farthest, beside < left * width, beside > right * width];
        // As in `minimiser`: a convex model falls all the way to its free minimiser.
        let is_asked = if determinant > 0.0 { is_beyond } else { [true; 4] };
        if is_asked == [false; 4] {
            return (free, self.value(free));
        }
        let mut best = ([0.0; 2], 0.0);
        for (out, _) in [(nearest, is_asked[0]), (farthest, is_asked[1])].into_iter().filter(|side| side.1) {
            let width = 1.0 + spread * out;
            let beside = minimiser_on_line(slope_beside + b * out, bend_beside, [left * width, right * width]);
            self.consider_here(pole.turned([beside, out]), &mut best);
        }
        for (end, _) in [(left, is_asked[2]), (right, is_asked[3])].into_iter().filter(|side| side.1) {
            let lean = end * spread;
            let slope = slope_out + b * end + lean * (slope_beside + bend_beside * end);
            let bend = lean * (bend_beside * lean + b + b) + bend_out;
            let out = minimiser_on_line(slope, bend, [nearest, farthest]);
            self.consider_here(pole.turned([end + lean * out, out]), &mut best);
        }
        best
    }

    /// Not inlined four times: flash is scarce, and the search is not in a hurry.
    #[inline(never)]
    fn consider(&self, u: f32, v: f32, best: &mut ([f32; 2], f32)) {
        self.consider_here([u, v], best);
    }

    /// Near a pole, where a tick asks.
    #[inline(always)]
    fn consider_here(&self, change: [f32; 2], best: &mut ([f32; 2], f32)) {
        let value = self.value(change);
        if value < best.1 {
            *best = (change, value);
        }
    }

    fn value(&self, [u, v]: [f32; 2]) -> f32 {
        let [a, b, c] = self.hessian;
        self.gradient[0] * u + self.gradient[1] * v + 0.5 * (a * u * u + 2.0 * b * u * v + c * v * v)
    }
}

/// The minimiser of `slope · x + ½ bend · x²` between two ends; the model's diagonal is not negative.
fn minimiser_on_line(slope: f32, bend: f32, [low, high]: [f32; 2]) -> f32 {
    if bend > f32::MIN_POSITIVE {
        saturate(-slope / bend, low, high)
    } else if slope > 0.0 {
        low
    } else {
        high
    }
}

fn is_positive_definite([a, b, c]: [f32; 3]) -> bool {
    a > 0.0 && a * c - b * b > MIN_DETERMINANT * a * c
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The wedge of a pole at `u = 0` or `v = 1`, against a grid that contains its corners and sides.
    #[test]
    fn the_minimiser_near_a_pole_is_the_least_on_its_wedge() {
        let patch = crate::patch::SplineTable::UNIT_SQUARE.checked_in_body();
        let at = [0.25, 0.375];
        let range = [at.map(|parameter| -parameter), at.map(|parameter| 1.0 - parameter)];
        for (poles, hessian) in [1_u8, 8]
            .into_iter()
            .flat_map(|poles| [[2.0, 0.5, 1.0], [1.0, -0.8, 1.5], [0.5, 0.0, 4.0]].map(|hessian| (poles, hessian)))
        {
            let pole = Pole::nearest(poles, at, &patch, 1.0).unwrap();
            let [lower, upper] = range.map(|ends| pole.turned(ends));
            for turn in 0..24 {
                let (sine, cosine) = crate::math::sin_cos(turn as f32 * core::f32::consts::TAU / 24.0);
                let model = Model { gradient: [1.5 * cosine, sine], hessian, is_newton: true };
                let (change, fall) = model.minimiser_near_pole(&pole, range);
                assert!((model.value(change) - fall).abs() < 1e-6);
                let least = (0..=64).flat_map(|i| (0..=64).map(move |j| (i, j))).fold(0.0_f32, |least, (i, j)| {
                    let along = |axis: usize, step: i32| lower[axis] + (upper[axis] - lower[axis]) * step as f32 / 64.0;
                    let out = along(1, i);
                    let beside = along(0, j) * (1.0 + pole.spread() * out);
                    least.min(model.value(pole.turned([beside, out])))
                });
                // Rounding of values below 8, and a grid's distance from a minimum between its points.
                assert!(fall <= least + 4.0 * f32::EPSILON && fall >= least - 2e-3, "{model:?}: {fall} {least}");
            }
        }
    }

    /// Against the minimum of a grid that contains the minimiser's corners and sides.
    #[test]
    fn the_minimiser_of_a_model_is_the_least_on_its_rectangle() {
        let range = [[-1.0, -0.5], [0.75, 1.0]];
        for hessian in [[2.0, 0.5, 1.0], [1.0, -0.8, 1.5], [0.5, 0.0, 4.0]] {
            for turn in 0..24 {
                let (sine, cosine) = crate::math::sin_cos(turn as f32 * core::f32::consts::TAU / 24.0);
                let model = Model { gradient: [1.5 * cosine, sine], hessian, is_newton: true };
                let (at, fall) = model.minimiser(range);
                assert!(at[0] >= -1.0 && at[0] <= 0.75 && at[1] >= -0.5 && at[1] <= 1.0, "{at:?}");
                assert!((model.value(at) - fall).abs() < 1e-6);
                for (i, j) in (0..=56).flat_map(|i| (0..=48).map(move |j| (i, j))) {
                    let other = [i as f32 / 32.0 - 1.0, j as f32 / 32.0 - 0.5];
                    // Rounding of values below 8.
                    assert!(model.value(other) >= fall - 4.0 * f32::EPSILON, "{model:?}: {at:?}, {other:?}");
                }
            }
        }
    }
}
