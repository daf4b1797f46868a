//! Second order: the distance from a probe to one rectangle of a patch's parameters.
//!
//! With `φ = ½ ‖f − Q‖²`, gradient `g` and Hessian `H = I + ΔR · D²f`, each step goes to the minimiser of
//! `g · δ + ½ δᵀ H δ` over the rectangle, where `H` is positive definite; where it is not, the absolute values of its
//! diagonal stand in, which lead away from a saddle, or all of `I` (Gauss–Newton). A step that does not lower `φ` is
//! halved. Beside a pole the step is one in polar coordinates ([`super::pole`]).

use super::locator::Candidate;
use super::pole::Pole;
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::{CurvedPoint, Patch as _, ShapeBounds, SplinePatch};

/// Evaluations that one candidate of a list may cost.
pub const MAX_EVALUATIONS_PER_CANDIDATE: u8 = 32;
/// The same on a convex body, whose search is shorter.
pub const MAX_EVALUATIONS_PER_CANDIDATE_CONVEX: u8 = 16;
/// A distance is found when the next step would change it by less than this, relative to the body's size: the rounding
/// of `f32` coordinates of that size.
const RESOLUTION: f32 = 2.0e-7;
/// It is found without another look where it is proved to be within this of what the model says: a fifth of what is
/// asked of a cold start, and a bound that is seldom near the truth.
const PROVED: f32 = 2.0e-6;
/// The same as a part of `φ`: a tenth of what the tracker changes over for.
const SHARE: f32 = 1.0e-4;
/// A determinant below this part of the product of the diagonal is rounding.
const MIN_DETERMINANT: f32 = 1.0e-4;
/// A second derivative of `φ` closer to 0 than this part of that without curvature is taken for so much.
const FLAT: f32 = 1.0e-2;
/// Halvings of one step.
const MAX_HALVINGS: u8 = 8;

/// A search in one rectangle, between two evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Descending {
    /// The rectangle.
    pub candidate: Candidate,
    /// The best parameters so far; the seed before the first evaluation.
    pub parameters: [f32; 2],
    /// `φ` there, m²; infinite before the first evaluation.
    pub half_squared: f32,
    /// Where the next evaluation will be, or the last one was.
    trial: [f32; 2],
    /// What the last evaluation said, until it is judged.
    seen: Option<Seen>,
    halvings: u8,
    /// Evaluations that it may still cost.
    left: u8,
}

/// What an evaluation found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// There is more to be had.
    Falling,
    /// The minimum of the rectangle is found.
    Found,
    /// The rectangle is proved to hold nothing nearer than what is known.
    Beaten,
    /// The evaluations are used up, or the steps too short.
    Exhausted,
}

impl Descending {
    /// From the middle of a candidate's rectangle, for so many evaluations at most.
    pub fn new(candidate: Candidate, most: u8) -> Self {
        let [lower, upper] = candidate.rectangle();
        let middle = [0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1])];
        Self {
            candidate,
            parameters: middle,
            half_squared: f32::INFINITY,
            trial: middle,
            seen: None,
            halvings: 0,
            left: most,
        }
    }

    /// Both halves of a step at one go.
    pub fn step(&mut self, patch: &SplinePatch, poles: u8, probe: Vec3, known: f32, size: f32) -> Judgement {
        self.evaluate(patch, probe);
        if poles == 0 { self.judge(patch, known, size) } else { self.judge_beside(patch, poles, known, size) }
    }

    /// Whether nothing has been evaluated yet.
    pub(super) const fn is_fresh(&self) -> bool {
        self.seen.is_none() && self.half_squared == f32::INFINITY
    }

    /// Whether the last evaluation is still to be judged.
    pub const fn has_evaluated(&self) -> bool {
        self.seen.is_some()
    }

    /// Where the last evaluation was, and `φ` there, m², until it is judged.
    pub(super) fn seen(&self) -> Option<([f32; 2], f32)> {
        self.seen.map(|seen| (self.trial, seen.half_squared))
    }

    /// The first half of a step: one evaluation.
    #[inline(never)]
    pub fn evaluate(&mut self, patch: &SplinePatch, probe: Vec3) {
        let curved = patch.evaluate_curved(self.trial[0], self.trial[1]);
        self.left = self.left.wrapping_sub(1);
        self.seen = Some(Seen::new(&curved, curved.surface.point - probe));
    }

    /// The second half on a face without poles: where to go from there. None of the arithmetic of poles is compiled in.
    /// `known` is the `φ` to beat, m²; `size` the body's, metres.
    #[inline(never)]
    pub fn judge(&mut self, patch: &SplinePatch, known: f32, size: f32) -> Judgement {
        self.judged(patch, 0, known, size)
    }

    /// The second half on a face that may have poles ([`super::Face::poles`]).
    #[inline(never)]
    pub fn judge_beside(&mut self, patch: &SplinePatch, poles: u8, known: f32, size: f32) -> Judgement {
        self.judged(patch, poles, known, size)
    }

    #[inline(always)]
    fn judged(&mut self, patch: &SplinePatch, poles: u8, known: f32, size: f32) -> Judgement {
        let Some(seen) = self.seen.take() else { return Judgement::Falling };
        let (at, half_squared) = (self.trial, seen.half_squared);
        if half_squared < self.half_squared {
            let pole = Pole::nearest(poles, at);
            let model = Model::new(pole.map_or(seen, |pole| seen.beside(pole)));
            let [lower, upper] = self.candidate.rectangle();
            let room = [[lower[0] - at[0], lower[1] - at[1]], [upper[0] - at[0], upper[1] - at[1]]];
            // A convex function lies above its tangent plane.
            if self.candidate.convex && half_squared + model.greatest_fall(room) > known {
                return Judgement::Beaten;
            }
            (self.parameters, self.half_squared, self.halvings) = (at, half_squared, 0);
            let (change, fall) = model.step(&seen, pole, room);
            // φ changes by d times the change of d. Beside a pole, where steps shrink with the distance to it, the last
            // bit of φ counts too.
            let distance = sqrt_from_above(2.0 * half_squared);
            let mut resolved = RESOLUTION * size;
            if pole.is_some() {
                resolved += f32::EPSILON * distance;
            }
            if -fall <= resolved * (distance + resolved) {
                return Judgement::Found;
            }
            self.trial = [0, 1].map(|axis| saturate(at[axis] + change[axis], lower[axis], upper[axis]));
            // What the model is proved to say rightly of its minimiser need not be seen there. Half of what it falls
            // by: of what is left after the step it says nothing else.
            if pole.is_none() && model.is_newton {
                let least = half_squared + fall;
                // And the sum is rounded.
                let misfit = misfit(&patch.shape(), change, seen.form, distance) + f32::EPSILON * half_squared;
                if misfit <= SHARE * least
                    && misfit * misfit <= (2.0 * PROVED * PROVED) * (size * size) * least
                    && misfit <= -0.5 * fall
                    && patch.beyond_knots(at, self.trial) == [0.0; 2]
                {
                    (self.parameters, self.half_squared) = (self.trial, least);
                    return Judgement::Found;
                }
            }
        } else {
            self.halvings += 1;
            self.trial = match Pole::nearest(poles, self.parameters) {
                None => [0, 1].map(|axis| 0.5 * (self.parameters[axis] + at[axis])),
                Some(pole) => {
                    let half = pole.halved([0, 1].map(|axis| at[axis] - self.parameters[axis]));
                    let [lower, upper] = self.candidate.rectangle();
                    [0, 1].map(|axis| saturate(self.parameters[axis] + half[axis], lower[axis], upper[axis]))
                }
            };
        }
        let exhausted = self.left == 0 || self.halvings >= MAX_HALVINGS;
        if exhausted { Judgement::Exhausted } else { Judgement::Falling }
    }
}

/// `φ` and its derivatives at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    half_squared: f32,
    gradient: [f32; 2],
    /// The first fundamental form, and the Hessian: `[uu, uv, vv]`.
    form: [f32; 3],
    newton: [f32; 3],
}

impl Seen {
    #[inline]
    fn new(CurvedPoint { surface, second }: &CurvedPoint, difference: Vec3) -> Self {
        let (f_u, f_v) = (surface.tangent_u, surface.tangent_v);
        let form = [f_u.dot(f_u), f_u.dot(f_v), f_v.dot(f_v)];
        let bend = second.along(difference);
        let newton = [form[0] + bend[0], form[1] + bend[1], form[2] + bend[2]];
        let gradient = [difference.dot(f_u), difference.dot(f_v)];
        Self { half_squared: 0.5 * difference.length_squared(), gradient, form, newton }
    }
}

impl Seen {
    /// The same in the coordinates of [`super::pole`].
    fn beside(mut self, pole: Pole) -> Self {
        self.newton[1] += pole.mixed(self.gradient);
        self
    }
}

/// A step of second order on a face that has poles.
#[derive(Clone, Copy)]
pub(super) struct StepBeside {
    /// Where it leads.
    pub parameters: [f32; 2],
    /// Whether a border holds it there, by parameter.
    pub is_held: [bool; 2],
    /// What it should lower `φ` by, m².
    pub fall: f32,
}

impl StepBeside {
    /// The step from a point, in the coordinates around the nearest pole. `None` where it would be rounding, or there
    /// is no pole.
    #[inline(never)]
    pub(super) fn new(poles: u8, at: [f32; 2], curved: &CurvedPoint, probe: Vec3, size: f32) -> Option<Self> {
        let pole = Pole::nearest(poles, at)?;
        let seen = Seen::new(curved, curved.surface.point - probe);
        let room = [at.map(|parameter| -parameter), at.map(|parameter| 1.0 - parameter)];
        let model = Model::new(seen.beside(pole));
        let (change, fall) = model.step(&seen, Some(pole), room);
        let (distance, resolved) = (sqrt_from_above(2.0 * seen.half_squared), RESOLUTION * size);
        let is_worth_it = -fall > resolved * (distance + resolved);
        if !is_worth_it {
            return None;
        }
        let parameters = [0, 1].map(|axis| saturate(at[axis] + change[axis], 0.0, 1.0));
        let slope = model.slope(change);
        let is_held = [0, 1].map(|axis| {
            let at = parameters[axis];
            (at <= 0.0 && slope[axis] > 0.0) || (at >= 1.0 && slope[axis] < 0.0)
        });
        Some(Self { parameters, is_held, fall: -fall })
    }
}

/// The quadratic model of `φ` at a point.
#[derive(Debug)]
struct Model {
    gradient: [f32; 2],
    /// `[uu, uv, vv]`, positive definite but for poles.
    hessian: [f32; 3],
    /// Whether that is the true one.
    is_newton: bool,
}

impl Model {
    fn new(Seen { gradient, form, newton, .. }: Seen) -> Self {
        let is_newton = is_positive_definite(newton);
        let hessian = if is_newton { newton } else { Self::stand_in(form, newton) };
        Self { gradient, hessian, is_newton }
    }

    /// What stands in for a Hessian that is not positive definite.
    #[inline(never)]
    fn stand_in(form: [f32; 3], newton: [f32; 3]) -> [f32; 3] {
        // Along an arc that is equally far everywhere φ is flat, and at a saddle it falls both ways: what is known of
        // the other parameter still counts.
        let mixed = [0, 2].map(|axis| saturate(newton[axis].abs(), FLAT * form[axis], f32::MAX));
        let mixed = [mixed[0], newton[1], mixed[1]];
        if is_positive_definite(mixed) {
            mixed
        } else if is_positive_definite(form) {
            form
        } else {
            // Near a pole: the trace is not below the greatest eigenvalue, a plain gradient step.
            let trace = form[0] + form[2];
            [trace, 0.0, trace]
        }
    }

    /// The step to the minimiser, beside a pole in the coordinates of [`super::pole`], and the model's value there.
    #[inline(always)]
    fn step(&self, seen: &Seen, pole: Option<Pole>, room: [[f32; 2]; 2]) -> ([f32; 2], f32) {
        let (change, fall) = self.minimiser(room);
        let Some(pole) = pole else { return (change, fall) };
        let bend = seen.newton[1] - seen.form[1];
        let around = pole.around(seen.gradient, bend, seen.form, room);
        around.unwrap_or((pole.unrolled(change, room), fall))
    }

    /// The model's gradient after a step.
    fn slope(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let [a, b, c] = self.hessian;
        [self.gradient[0] + a * u + b * v, self.gradient[1] + b * u + c * v]
    }

    /// The least value of `g · δ` with `δ` in `room`: not positive.
    fn greatest_fall(&self, [lower, upper]: [[f32; 2]; 2]) -> f32 {
        let along = |axis: usize| {
            let (low, high) = (self.gradient[axis] * lower[axis], self.gradient[axis] * upper[axis]);
            if low < high { low } else { high }
        };
        along(0) + along(1)
    }

    /// The minimiser of the model over `room`, and the model's value there. In two variables either the free minimiser
    /// lies inside, or the best of the four sides is the minimiser.
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
        self.minimiser_on_sides([lower, upper])
    }

    #[inline(never)]
    fn minimiser_on_sides(&self, [lower, upper]: [[f32; 2]; 2]) -> ([f32; 2], f32) {
        let [a, b, c] = self.hessian;
        let [p, q] = self.gradient;
        let mut best = ([0.0; 2], 0.0);
        for u in [lower[0], upper[0]] {
            self.consider([u, least_of_line(q + b * u, c, [lower[1], upper[1]])], &mut best);
        }
        for v in [lower[1], upper[1]] {
            self.consider([least_of_line(p + b * v, a, [lower[0], upper[0]]), v], &mut best);
        }
        best
    }

    /// Not inlined four times: the search has time, flash is scarce.
    #[inline(never)]
    fn consider(&self, change: [f32; 2], best: &mut ([f32; 2], f32)) {
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

/// By how much `φ` may differ from the quadratic model `q` at its minimiser over a rectangle, m², if both ends of the
/// step `w` lie in one span. With `a = Df w`, `b = D²f[w, w]` and Taylor's remainder `e` it is `φ − q = (ΔR + a)·e +
/// ½ a·b + ½ |½ b + e|²`, where the patch bounds `|b|` and `|e|`, and `|a|² = wᵀIw`.
#[inline(always)]
fn misfit(shape: &ShapeBounds, [w_u, w_v]: [f32; 2], form: [f32; 3], distance: f32) -> f32 {
    let (second, third) = (&shape.second_derivatives, &shape.third_derivatives);
    let (xx, yy, product) = (w_u * w_u, w_v * w_v, w_u * w_v);
    let (x, y, xy) = (w_u.abs(), w_v.abs(), product.abs());
    let bend = 0.5 * (second.uu * xx + second.vv * yy) + second.uv * xy;
    let twist = x * (third.uuu * xx + 3.0 * third.uuv * xy) + y * (third.vvv * yy + 3.0 * third.uvv * xy);
    let rest = (1.0 / 6.0) * twist;
    let length = sqrt_from_above(form[0] * xx + 2.0 * form[1] * product + form[2] * yy);
    bend * (length + 0.5 * bend) + rest * (distance + length + bend + 0.5 * rest)
}

/// The minimiser of `slope · x + ½ bend · x²` between two ends; the model's diagonal is not negative.
fn least_of_line(slope: f32, bend: f32, [low, high]: [f32; 2]) -> f32 {
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

    /// Against the least of a grid that has the minimiser's corners and sides on it.
    #[test]
    fn the_minimiser_of_a_model_is_the_least_on_its_rectangle() {
        let room = [[-1.0, -0.5], [0.75, 1.0]];
        for hessian in [[2.0, 0.5, 1.0], [1.0, -0.8, 1.5], [0.5, 0.0, 4.0]] {
            for turn in 0..24 {
                let (sine, cosine) = crate::math::sin_cos(turn as f32 * core::f32::consts::TAU / 24.0);
                let model = Model { gradient: [1.5 * cosine, sine], hessian, is_newton: true };
                let (at, fall) = model.minimiser(room);
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
