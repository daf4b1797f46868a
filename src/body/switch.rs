//! The top level: from which feature the tracker goes to which other one. A switch never moves the witness point by more than rounding.

use super::along::Along;
use super::curve::CurvePoint;
use super::feature::{EdgeFace, EdgeKind, Feature, Side};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::math::Vec3;
use crate::patch::SurfacePoint;
use crate::track::{BoundaryMode, Witness};

/// Faces of an edge.
pub(super) const BOTH: u8 = 2;

impl Body {
    /// Hands over through the side that holds the witness point. While the witness point is free there is nothing to ask: the controller
    /// brings it to the side through which the probe has left, and there the measure numbers of the projection errors change sign where
    /// the probe passes the separator. Whether it switched.
    #[inline(never)]
    pub(super) fn leave_face(&self, index: u16, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Some(face) = self.faces.get(usize::from(index)) else { return false };
        let [u, v] = state.witness.parameters;
        // At a corner the side that the step along the other one would meet.
        let number = match state.witness.mode {
            BoundaryMode::LowerU => 0,
            BoundaryMode::UpperU => 1,
            BoundaryMode::LowerV => 2,
            BoundaryMode::UpperV => 3,
            BoundaryMode::Corner => usize::from(u > 0.5),
            BoundaryMode::Interior => return false,
        };
        let Some(side) = face.sides.get(number) else { return false };
        step.switched = match side {
            Side::Pole { vertex } => self.rest_on_vertex(*vertex, state),
            Side::Edge { edge, reversed, .. } => {
                let along = if number < 2 { v } else { u };
                let t = if *reversed { 1.0 - along } else { along };
                self.cross_side(index, *edge, t, number < 2, state, step)
            }
        };
        step.switched
    }

    /// From a face to the one beyond the edge, if that takes the probe: over a smooth edge it does, for between the two lies no region.
    /// Otherwise to the edge.
    #[inline]
    fn cross_side(
        &self,
        from: u16,
        index: u16,
        t: f32,
        is_along_v: bool,
        state: &mut BodyWitness,
        step: &mut BodyStep,
    ) -> bool {
        let Some(edge) = self.edges.get(usize::from(index)) else { return false };
        let from_second = edge.faces[0].face != from;
        let other = edge.faces[usize::from(!from_second)];
        let is_other = other.face != from && other != EdgeFace::NONE;
        if is_other && (edge.kind == EdgeKind::Smooth || self.takes_across(other, t, is_along_v, state)) {
            return self.enter_across(other.face, other.side, t, state, step);
        }
        let (at, probe) = (edge.curve.evaluate(t), state.probe);
        let squared = (state.witness.surface.point - probe).length_squared();
        if !self.is_no_rise((at.point - probe).length_squared(), squared, at.point, probe) {
            return false;
        }
        state.rest_on_edge(index, t, &at);
        (state.asks_second, state.declined) = (is_other && from_second, u8::from(is_other));
        true
    }

    /// Whether the face beyond a side takes the probe, at the witness point with the parameter `t` of the edge there. Which way the tangent
    /// along the edge points does not matter. Not inlined: what it keeps on the stack is not there when the other face is evaluated.
    #[inline(never)]
    fn takes_across(&self, other: EdgeFace, t: f32, is_along_v: bool, state: &BodyWitness) -> bool {
        let surface = &state.witness.surface;
        let tangent = if is_along_v { surface.tangent_v } else { surface.tangent_u };
        let at = CurvePoint { point: surface.point, tangent };
        self.takes(other, &Along::new(&at, state.probe), &at, t, state.probe)
    }

    /// Whether a face takes the probe over one of its sides.
    #[inline(always)]
    fn takes(&self, of: EdgeFace, along: &Along, at: &CurvePoint, t: f32, probe: Vec3) -> bool {
        match self.faces.get(usize::from(of.face)).and_then(|face| face.sides.get(usize::from(of.side))) {
            Some(Side::Edge { separator, .. }) => !along.is_beyond(separator, at, t, probe),
            _ => false,
        }
    }

    /// From an edge to the face whose region holds the probe, or to the vertex at the end that holds the witness point; otherwise one step
    /// along it.
    #[inline(never)]
    pub(super) fn tick_on_edge(&self, index: u16, state: &mut BodyWitness, step: &mut BodyStep) {
        let Some(edge) = self.edges.get(usize::from(index)) else { return };
        let (t, probe) = (state.witness.parameters[0], state.probe);
        let at = CurvePoint { point: state.witness.surface.point, tangent: state.witness.surface.tangent_u };
        let along = Along::new(&at, probe);
        // One face a tick, in turn.
        let of = edge.faces[usize::from(state.asks_second)];
        state.asks_second = !state.asks_second;
        if self.takes(of, &along, &at, t, probe) {
            step.switched = self.enter_across(of.face, of.side, t, state, step);
            return;
        }
        state.declined = (state.declined + 1).min(BOTH);
        if state.declined == BOTH && along.is_held(t) {
            step.switched = self.rest_on_vertex(if t <= 0.0 { edge.ends[0] } else { edge.ends[1] }, state);
        } else {
            step.outcome = self.slide(index, &along, state);
        }
    }

    /// From a vertex along the edge that falls most steeply, if one does.
    #[inline(never)]
    pub(super) fn leave_vertex(&self, index: u16, state: &mut BodyWitness, step: &mut BodyStep) {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
        let first = usize::from(vertex.first_spoke);
        let spokes = self.spokes.get(first..first + usize::from(vertex.spokes)).unwrap_or(&[]);
        let towards = state.probe - vertex.point;
        let mut steepest: Option<(f32, u16, bool)> = None;
        for spoke in spokes {
            let fall = towards.dot(spoke.direction);
            if fall > 0.0 && steepest.is_none_or(|(most, ..)| fall > most) {
                steepest = Some((fall, spoke.edge, spoke.at_upper_end));
            }
        }
        if let Some((_, edge, at_upper_end)) = steepest
            && let Some(curve) = self.edges.get(usize::from(edge)).map(|edge| &edge.curve)
        {
            step.switched = true;
            let t = if at_upper_end { 1.0 } else { 0.0 };
            state.rest_on_edge(edge, t, &curve.evaluate(t));
            (state.asks_second, state.declined) = (false, 0);
        }
    }

    /// Into a face over one of its sides, at the edge's parameter. The point stays the same. One evaluation.
    #[inline(never)]
    fn enter_across(&self, index: u16, number: u8, t: f32, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Some(face) = self.faces.get(usize::from(index)) else { return false };
        let Some(side) = face.sides.get(usize::from(number)) else { return false };
        let along = if matches!(side, Side::Edge { reversed: true, .. }) { 1.0 - t } else { t };
        let [u, v] = match number {
            0 => [0.0, along],
            1 => [1.0, along],
            2 => [along, 0.0],
            _ => [along, 1.0],
        };
        state.feature = Feature::Face(index);
        state.witness = Witness::at(&face.patch, u, v);
        step.evaluations += 1;
        true
    }

    #[inline]
    fn rest_on_vertex(&self, index: u16, state: &mut BodyWitness) -> bool {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return false };
        state.feature = Feature::Vertex(index);
        let surface = SurfacePoint { point: vertex.point, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        state.witness =
            Witness { parameters: [0.0; 2], surface, mode: BoundaryMode::Corner, is_free: false, halvings: 0 };
        true
    }
}
