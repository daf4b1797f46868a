//! Second order: the distance from a probe to one rectangle of a patch's parameters.
//!
//! Each step goes to the minimiser of the quadratic model ([`super::quadratic`]) over the rectangle; one that does not
//! lower half the squared distance `φ` is halved.

use super::locator::Candidate;
use super::pole::Pole;
use super::quadratic::{Model, Seen};
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::{Patch as _, ShapeBounds, SplinePatch};

/// Evaluations that one candidate of a list may cost.
pub const MAX_EVALUATIONS_PER_CANDIDATE: u8 = 32;
/// The same on a convex body, whose search is shorter.
pub const MAX_EVALUATIONS_PER_CANDIDATE_CONVEX: u8 = 16;
/// A distance is found when the next step would change it by less than this, relative to the body's size: the rounding
/// of `f32` coordinates of that size.
pub(super) const RESOLUTION: f32 = 2.0e-7;
/// It is found without another look where it is proved to be within this of what the model says: a fifth of what is
/// asked of a cold start, and a bound that is seldom near the truth.
const PROVED: f32 = 2.0e-6;
/// The same as a part of `φ`: a tenth of what the tracker changes over for.
const SHARE: f32 = 1.0e-4;
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
