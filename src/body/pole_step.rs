//! A second-order step of the tracker on a face that has a pole.

use super::candidate_search::RESOLUTION;
use super::face_entry::MIN_FALL;
use super::feature::{Face, Side};
use super::pole::{Pole, at_pole};
use super::quadratic_model::{DistanceDerivatives, Model};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness, StepLength};
use crate::field::Displacement;
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::SplinePatch;
use crate::track::{Outcome, Witness, mode_at};

impl<D: Displacement> Body<'_, D> {
    /// One second-order step on a face that has a pole. There the certificate is of little use, because bounds over
    /// the whole face ignore that all derivatives are small around the pole. The evaluation decides; a step that is
    /// not nearer is rejected, and the next one is certified. Returns whether the step was tried.
    #[inline(never)]
    pub(super) fn step_near_pole(&self, face: &Face, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let poles = face.poles();
        if state.witness.halvings != 0 || poles == 0 {
            return false;
        }
        let Some(plan) = PoleStep::new(poles, &face.patch, &state.witness, state.probe, self.size) else {
            return self.leave_pole(face, state, step);
        };
        let reached = self.patch(face).evaluate_apart(plan.parameters);
        step.evaluations += 1;
        step.length = StepLength::NearPole;
        let before = (state.witness.surface.point - state.probe).length_squared();
        let is_nearer = (reached.surface.point - state.probe).length_squared() <= before - 2.0 * MIN_FALL * plan.fall;
        if is_nearer {
            state.witness.rest_at(plan.parameters, &reached);
            state.witness.mode = mode_at(plan.parameters, plan.is_held);
            step.outcome = Outcome::Moved;
        } else {
            (state.witness.is_free, state.witness.halvings) = (false, 1);
            step.outcome = Outcome::Rejected;
        }
        true
    }

    /// From a pole to its vertex if an edge leads nearer and the face does not: the edge leads to the next face.
    /// Returns whether it did.
    #[inline(never)]
    fn leave_pole(&self, face: &Face, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Some(index) = self.pole_at(face, state.witness.parameters) else { return false };
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return false };
        let point = self.place(vertex);
        let (towards, before) = (state.probe - point, state.probe - state.witness.surface.point);
        let [now, before] = [towards, before].map(Vec3::length_squared);
        let Some((fall, _)) = self.steepest(vertex, towards) else { return false };
        let is_worth_it = 0.5 * fall * fall > worth(before, self.size);
        if !is_worth_it || !self.is_no_rise(now, before, point, state.probe) {
            return false;
        }
        step.switched = self.rest_on_vertex(index, state);
        step.switched
    }

    /// The vertex of the pole at these parameters, if they are at a pole.
    #[inline]
    pub(crate) fn pole_at(&self, face: &Face, [u, v]: [f32; 2]) -> Option<u16> {
        let near = at_pole(&face.patch, self.size);
        face.sides.iter().zip([u, 1.0 - u, v, 1.0 - v]).find_map(|(side, away)| match side {
            Side::Pole { vertex } if away <= near => Some(*vertex),
            _ => None,
        })
    }
}

/// Minimum fall of `φ` that is more than rounding, m², at a squared distance on a body of this size.
#[inline]
fn worth(squared: f32, size: f32) -> f32 {
    let resolved = RESOLUTION * size;
    resolved * (sqrt_from_above(squared) + resolved)
}

/// A second-order step on a face that has poles.
#[derive(Clone, Copy)]
struct PoleStep {
    /// `(u, v)` at its end.
    parameters: [f32; 2],
    /// Whether a border holds each parameter there.
    is_held: [bool; 2],
    /// Predicted fall of `φ`, m².
    fall: f32,
}

impl PoleStep {
    /// The step from a point, in the coordinates around the nearest pole. `None` if it would be rounding, or if there
    /// is no pole.
    #[inline(always)]
    fn new(poles: u8, patch: &SplinePatch, witness: &Witness, probe: Vec3, size: f32) -> Option<Self> {
        let at = witness.parameters;
        let pole = Pole::nearest(poles, at, patch, size)?;
        let seen = DistanceDerivatives::new(&witness.surface, &witness.second, probe);
        let range = [at.map(|parameter| -parameter), at.map(|parameter| 1.0 - parameter)];
        let model = Model::new(&seen, Some(pole));
        let (change, fall) = model.step(&seen, Some(pole), range);
        let is_worth_it = -fall > worth(2.0 * seen.half_squared, size);
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
