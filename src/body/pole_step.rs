//! A step of second order on a face that has a pole.

use super::candidate_search::RESOLUTION;
use super::face_entry::LEAST_FALL;
use super::feature::{Face, Side};
use super::pole::{Pole, at_pole};
use super::quadratic_model::{DistanceDerivatives, Model};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::CurvedPoint;
use crate::track::{Outcome, Witness, mode_at};

impl Body<'_> {
    /// One step of second order on a face that has a pole, where the certificate is of little use: bounds over the
    /// whole face do not know that around the pole all is small. The evaluation says whether the step was good; if not
    /// it is rejected, and the next one is certified. Whether it was tried.
    #[inline(never)]
    pub(super) fn step_near_pole(&self, face: &Face, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Witness { parameters, surface, second, halvings, .. } = state.witness;
        if halvings != 0 {
            return false;
        }
        let at = CurvedPoint { surface, second };
        let Some(plan) = PoleStep::new(face, parameters, &at, state.probe, self.size) else {
            return self.leave_pole(face, state, step);
        };
        let reached = face.patch.evaluate_apart(plan.parameters);
        step.evaluations += 1;
        let before = (surface.point - state.probe).length_squared();
        let is_nearer = (reached.surface.point - state.probe).length_squared() <= before - 2.0 * LEAST_FALL * plan.fall;
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

    /// From a pole where the face has nothing nearer to its vertex, where an edge does: it leads to the face that has.
    /// Whether it has gone there.
    #[inline(never)]
    fn leave_pole(&self, face: &Face, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Some(index) = self.pole_at(face, state.witness.parameters) else { return false };
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return false };
        let (towards, before) = (state.probe - vertex.point, state.probe - state.witness.surface.point);
        let [now, before] = [towards, before].map(Vec3::length_squared);
        let Some((fall, _)) = self.steepest(vertex, towards) else { return false };
        let is_worth_it = 0.5 * fall * fall > worth(before, self.size);
        if !is_worth_it || !self.is_no_rise(now, before, vertex.point, state.probe) {
            return false;
        }
        step.switched = self.rest_on_vertex(index, state);
        step.switched
    }

    /// The vertex that a pole of a face is, where parameters are at it.
    #[inline]
    pub(super) fn pole_at(&self, face: &Face, [u, v]: [f32; 2]) -> Option<u16> {
        let near = at_pole(&face.patch, self.size);
        face.sides.iter().zip([u, 1.0 - u, v, 1.0 - v]).find_map(|(side, away)| match side {
            Side::Pole { vertex } if away <= near => Some(*vertex),
            _ => None,
        })
    }
}

/// What `φ` has to fall by for a step not to be rounding, m², at a squared distance on a body of a size.
#[inline]
fn worth(squared: f32, size: f32) -> f32 {
    let resolved = RESOLUTION * size;
    resolved * (sqrt_from_above(squared) + resolved)
}

/// A step of second order on a face that has poles.
#[derive(Clone, Copy)]
struct PoleStep {
    /// Where it leads.
    parameters: [f32; 2],
    /// Whether a border holds it there, by parameter.
    is_held: [bool; 2],
    /// What it should lower `φ` by, m².
    fall: f32,
}

impl PoleStep {
    /// The step from a point, in the coordinates around the nearest pole. `None` where it would be rounding, or there
    /// is no pole.
    #[inline(never)]
    fn new(face: &Face, at: [f32; 2], curved: &CurvedPoint, probe: Vec3, size: f32) -> Option<Self> {
        let pole = Pole::nearest(face.poles(), at, &face.patch, size)?;
        let seen = DistanceDerivatives::new(curved, curved.surface.point - probe);
        let room = [at.map(|parameter| -parameter), at.map(|parameter| 1.0 - parameter)];
        let model = Model::new(seen.near_pole(pole));
        let (change, fall) = model.step(&seen, Some(pole), room);
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
