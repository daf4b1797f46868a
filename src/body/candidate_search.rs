//! Second-order search for the closest point in one rectangle of a patch's parameters.
//!
//! Each step goes to the minimiser of the quadratic model ([`super::quadratic_model`]) over the rectangle. A step that
//! does not lower half the squared distance `φ` is halved.

use super::locator::Candidate;
use super::pole::Pole;
use super::quadratic_model::{DistanceDerivatives, Model};
use crate::field::{Displaced, Displacement, Rigid};
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::ALL_KINDS;
use crate::patch::{Patch as _, ShapeBounds, SplinePatch};

/// Maximum evaluations of one candidate of a list.
pub const MAX_EVALUATIONS_PER_CANDIDATE: u8 = 32;
/// Maximum evaluations of one candidate on a convex body, whose lists are short.
pub const MAX_EVALUATIONS_PER_CANDIDATE_CONVEX: u8 = 16;
/// Relative to the body's size: a search ends when the next step would change the distance by less. The rounding of
/// `f32` coordinates of that size.
pub(super) const RESOLUTION: f32 = 2.0e-7;
/// Relative to the body's size: proved error of the model's distance below which the last evaluation is skipped. A
/// fifth of the tolerance of a cold start.
const PROVED: f32 = 2.0e-6;
/// The same relative to `φ`: a tenth of the difference for which the tracker changes to another point.
const SHARE: f32 = 1.0e-4;
/// Maximum halvings of one step.
const MAX_HALVINGS: u8 = 8;

/// A search in one rectangle, between two evaluations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CandidateSearch {
    /// The rectangle.
    pub candidate: Candidate,
    /// The best parameters so far; the seed before the first evaluation.
    pub parameters: [f32; 2],
    /// `φ` there, m²; infinite before the first evaluation.
    pub half_squared: f32,
    /// Where the next evaluation will be, or the last one was.
    trial: [f32; 2],
    /// Lower bound of `φ` over the rectangle, once the search is [`CandidateStatus::Beaten`], m².
    pub(super) at_least: f32,
    halvings: u8,
    /// Evaluations left.
    left: u8,
    /// Whether the last step may go without an evaluation at its end.
    may_skip_last_evaluation: bool,
}

/// State of the search after an evaluation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CandidateStatus {
    /// The next step lowers the distance.
    Falling,
    /// The minimum of the rectangle is found.
    Found,
    /// The rectangle is proved to hold no point nearer than the known one.
    Beaten,
    /// The evaluations are used up, or the steps too short.
    Exhausted,
}

impl CandidateSearch {
    /// Starts in the middle of the candidate's rectangle, with at most `evaluations`.
    pub fn new(candidate: Candidate, evaluations: u8) -> Self {
        let [lower, upper] = candidate.rectangle();
        Self::from(candidate, [0.5 * (lower[0] + upper[0]), 0.5 * (lower[1] + upper[1])], evaluations)
    }

    /// Starts at a point of the rectangle.
    pub(super) const fn from(candidate: Candidate, parameters: [f32; 2], evaluations: u8) -> Self {
        Self {
            candidate,
            parameters,
            half_squared: f32::INFINITY,
            trial: parameters,
            at_least: 0.0,
            halvings: 0,
            left: evaluations,
            may_skip_last_evaluation: true,
        }
    }

    /// The same search with an evaluation at the end of every step: one evaluation more, and the smallest error.
    pub const fn with_last_evaluation(mut self) -> Self {
        self.may_skip_last_evaluation = false;
        self
    }

    /// One evaluation, and the choice of the next parameters. `known` is the `φ` to beat, m²; `size` is the body's,
    /// metres; `poles` as of [`super::Face::poles`].
    pub fn step(&mut self, patch: &SplinePatch, poles: u8, probe: Vec3, known: f32, size: f32) -> CandidateStatus {
        self.step_on::<_, false>(Displaced { rest: patch, by: Rigid::<ALL_KINDS> }, poles, probe, known, size)
    }

    /// The same on a displaced patch. With `TO_REST` it goes on to a rest of the distance where a model that stands in for
    /// the Hessian promises little; a tick's does not, since the tracker goes on.
    pub(super) fn step_on<D: Displacement, const TO_REST: bool>(
        &mut self,
        patch: Displaced<'_, D>,
        poles: u8,
        probe: Vec3,
        known: f32,
        size: f32,
    ) -> CandidateStatus {
        let seen = self.see(patch, probe);
        self.judge::<D, TO_REST>(patch, poles, &seen, known, size)
    }

    /// Whether nothing has been evaluated yet.
    pub(super) const fn is_fresh(&self) -> bool {
        self.half_squared == f32::INFINITY
    }

    /// The evaluation of a step.
    #[inline]
    pub(super) fn see<D: Displacement>(&self, patch: Displaced<'_, D>, probe: Vec3) -> DistanceDerivatives {
        let curved = patch.evaluate_apart(self.trial);
        DistanceDerivatives::new(&curved.surface, &curved.second, probe)
    }

    /// The choice of the next parameters from what was seen at the last ones.
    #[inline]
    pub(super) fn judge<D: Displacement, const TO_REST: bool>(
        &mut self,
        patch: Displaced<'_, D>,
        poles: u8,
        seen: &DistanceDerivatives,
        known: f32,
        size: f32,
    ) -> CandidateStatus {
        // Without poles their arithmetic is not compiled in.
        if poles == 0 {
            self.judge_apart::<D, TO_REST>(patch, seen, known, size)
        } else {
            self.judge_near_pole::<D, TO_REST>(patch, poles, seen, known, size)
        }
    }

    #[inline(never)]
    fn judge_apart<D: Displacement, const TO_REST: bool>(
        &mut self,
        patch: Displaced<'_, D>,
        seen: &DistanceDerivatives,
        known: f32,
        size: f32,
    ) -> CandidateStatus {
        self.judged::<D, TO_REST>(patch, 0, *seen, known, size)
    }

    #[inline(never)]
    fn judge_near_pole<D: Displacement, const TO_REST: bool>(
        &mut self,
        patch: Displaced<'_, D>,
        poles: u8,
        seen: &DistanceDerivatives,
        known: f32,
        size: f32,
    ) -> CandidateStatus {
        self.judged::<D, TO_REST>(patch, poles, *seen, known, size)
    }

    #[inline(always)]
    fn judged<D: Displacement, const TO_REST: bool>(
        &mut self,
        patch: Displaced<'_, D>,
        poles: u8,
        seen: DistanceDerivatives,
        known: f32,
        size: f32,
    ) -> CandidateStatus {
        self.left = self.left.wrapping_sub(1);
        let (at, half_squared) = (self.trial, seen.half_squared);
        if half_squared < self.half_squared {
            let pole = Pole::nearest(poles, at, patch.rest, size);
            let model = Model::new(&seen, pole);
            let [lower, upper] = self.candidate.rectangle();
            let range = [[lower[0] - at[0], lower[1] - at[1]], [upper[0] - at[0], upper[1] - at[1]]];
            if known < half_squared {
                self.at_least = least(&patch.shape(), &seen, range);
                // A convex function lies above its tangent plane.
                let above = half_squared + model.max_fall(range);
                if self.candidate.convex && above > self.at_least {
                    self.at_least = above;
                }
                if self.at_least > known {
                    return CandidateStatus::Beaten;
                }
            }
            (self.parameters, self.half_squared, self.halvings) = (at, half_squared, 0);
            let (mut change, mut fall) = model.step(&seen, pole, range);
            // φ changes by d times the change of d. Near a pole, where steps shrink with the distance to it, the last
            // bit of φ counts too.
            let distance = sqrt_from_above(2.0 * half_squared);
            let mut resolved = RESOLUTION * size;
            if pole.is_some() {
                resolved += f32::EPSILON * distance;
            }
            let worth = resolved * (distance + resolved);
            if -fall <= worth {
                if !TO_REST || model.is_newton || pole.is_some() {
                    return CandidateStatus::Found;
                }
                // The stand-in's steps are short along an arc where φ is nearly flat.
                (change, fall) = model.away_from_rest(&seen, range, worth);
                if -fall <= worth {
                    return CandidateStatus::Found;
                }
            }
            self.trial = [0, 1].map(|axis| saturate(at[axis] + change[axis], lower[axis], upper[axis]));
            // If the model is proved at its minimiser, no evaluation is needed there.
            if poles == 0
                && self.may_skip_last_evaluation
                && model.is_newton
                && is_proved(&patch.shape(), &model, &seen, change, fall, size)
                && patch.beyond_knots(at, self.trial) == [0.0; 2]
            {
                (self.parameters, self.half_squared) = (self.trial, half_squared + fall);
                return CandidateStatus::Found;
            }
        } else {
            self.halvings += 1;
            self.trial = match Pole::nearest(poles, self.parameters, patch.rest, size) {
                None => [0, 1].map(|axis| 0.5 * (self.parameters[axis] + at[axis])),
                Some(pole) => {
                    let half = pole.halved([0, 1].map(|axis| at[axis] - self.parameters[axis]));
                    let [lower, upper] = self.candidate.rectangle();
                    [0, 1].map(|axis| saturate(self.parameters[axis] + half[axis], lower[axis], upper[axis]))
                }
            };
        }
        let exhausted = self.left == 0 || self.halvings >= MAX_HALVINGS;
        if exhausted { CandidateStatus::Exhausted } else { CandidateStatus::Falling }
    }
}

/// Lower bound of `φ` over a range around a point: along the direction from the point to the probe, the patch comes
/// nearer by its tangents and by the bound of its second derivatives at most. None at a crease.
#[inline]
fn least(shape: &ShapeBounds, seen: &DistanceDerivatives, [lower, upper]: [[f32; 2]; 2]) -> f32 {
    let (second, third) = (&shape.second_derivatives, &shape.third_derivatives);
    let most = |axis: usize| if -lower[axis] > upper[axis] { -lower[axis] } else { upper[axis] };
    let (x, y) = (most(0), most(1));
    let bend = 0.5 * (second.uu * x * x + 2.0 * second.uv * x * y + second.vv * y * y);
    let along = |axis: usize| {
        let (low, high) = (seen.gradient[axis] * lower[axis], seen.gradient[axis] * upper[axis]);
        if low < high { low } else { high }
    };
    let distance = sqrt_from_above(2.0 * seen.half_squared);
    let least = (2.0 * seen.half_squared + along(0) + along(1)) / distance - bend;
    let is_known = least > 0.0 && third.jump_uu < f32::INFINITY && third.jump_vv < f32::INFINITY;
    if is_known { 0.5 * least * least } else { 0.0 }
}

/// Whether `φ` is proved to be near the quadratic model's value at its minimiser over a rectangle, and to have little
/// left to fall from there: a step `w` away, with both ends in one span, after the model has fallen by `fall`.
///
/// With `a = Df w`, `b = D²f[w, w]` and Taylor's remainder `e` the derivative along the parameter `i` is off from the
/// model's by `g_i = f_i·(½ b + e) + D f_i w·(a + ½ b + e)` and the remainder of `f_i`, `½ D²f_i[w, w]`, times the new
/// `ΔR`, where the patch bounds second and third derivatives and `|a|² = wᵀIw`. At the fraction `t` of the step it is
/// off by `t² g` at most, so that `φ` is off by a third of `|g|·|w|`; and `φ` has `½ gᵀH⁻¹g` left, by the Hessian at
/// the start of the step.
#[inline(always)]
fn is_proved(
    shape: &ShapeBounds,
    model: &Model,
    seen: &DistanceDerivatives,
    [w_u, w_v]: [f32; 2],
    fall: f32,
    size: f32,
) -> bool {
    let (second, third) = (&shape.second_derivatives, &shape.third_derivatives);
    let least = seen.half_squared + fall;
    let (share, proved) = (SHARE * least, PROVED * size * sqrt_from_above(2.0 * least));
    let is_little = |off: f32| off <= share && off <= proved;
    let (x, y) = (w_u.abs(), w_v.abs());
    let turn = [second.uu * x + second.uv * y, second.uv * x + second.vv * y];
    let bend = 0.5 * (turn[0] * x + turn[1] * y);
    let [stretch_u, skew, stretch_v] = seen.form;
    let (xx, yy) = (w_u * w_u, w_v * w_v);
    let length = sqrt_from_above(stretch_u * xx + 2.0 * skew * (w_u * w_v) + stretch_v * yy);
    // Most steps that are too long fail here already.
    if !is_little(bend * length) {
        return false;
    }
    let xy = x * y;
    let twist = [
        third.uuu * xx + 2.0 * third.uuv * xy + third.uvv * yy,
        third.uuv * xx + 2.0 * third.uvv * xy + third.vvv * yy,
    ];
    let beside = bend + (1.0 / 6.0) * (x * twist[0] + y * twist[1]);
    let moved = length + beside;
    let half = 0.5 * (sqrt_from_above(2.0 * seen.half_squared) + moved);
    let gradient = [
        sqrt_from_above(stretch_u) * beside + turn[0] * moved + twist[0] * half,
        sqrt_from_above(stretch_v) * beside + turn[1] * moved + twist[1] * half,
    ];
    // The last term is the rounding of the sum.
    let value = (1.0 / 3.0) * (gradient[0] * x + gradient[1] * y) + f32::EPSILON * seen.half_squared;
    is_little(value) && is_little(model.fall_at_most(gradient))
}
