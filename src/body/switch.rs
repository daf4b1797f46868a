//! The top level: from which feature the tracker goes to which other one. A switch never moves the witness point by
//! more than rounding.

use super::along::Along;
use super::curve::CurvePoint;
use super::enter::{Border, Entry};
use super::feature::{EdgeFace, EdgeKind, Feature, Side};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::math::Vec3;
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::track::{BoundaryMode, Witness};

/// Faces of an edge.
pub(super) const BOTH: u8 = 2;

/// Where a face's border is left.
#[derive(Clone, Copy)]
struct Crossing {
    /// The face.
    from: u16,
    /// The edge that the side lies on, the parameter along it, and how the side runs: along `v`, against the edge.
    edge: u16,
    t: f32,
    is_along_v: bool,
    is_reversed: bool,
}

impl Body {
    /// Hands over through the side that holds the witness point. While the witness point is free there is nothing to
    /// ask: the controller brings it to the side through which the probe has left, and there the measure numbers of the
    /// projection errors change sign where the probe passes the separator. Whether the tick is spent, or the edge's.
    #[inline(never)]
    pub(super) fn leave_face(&self, index: u16, is_curved: bool, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
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
        match side {
            Side::Pole { vertex } => {
                step.switched = self.rest_on_vertex(*vertex, state);
                step.switched
            }
            Side::Edge { edge, reversed, .. } => {
                let along = if number < 2 { v } else { u };
                let t = if *reversed { 1.0 - along } else { along };
                let crossing = Crossing { from: index, edge: *edge, t, is_along_v: number < 2, is_reversed: *reversed };
                self.cross_side(crossing, is_curved, state, step)
            }
        }
    }

    /// From a face to the one beyond the edge, if that takes the probe. Otherwise to the edge.
    #[inline]
    fn cross_side(&self, crossing: Crossing, is_curved: bool, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Crossing { from, edge: index, t, is_along_v, is_reversed } = crossing;
        let Some(edge) = self.edges.get(usize::from(index)) else { return false };
        let from_second = edge.faces[0].face != from;
        let other = edge.faces[usize::from(!from_second)];
        let is_other = other.face != from && other != EdgeFace::NONE;
        if is_other && let Some(entry) = self.entry_across(other, edge.kind, crossing, is_curved, state) {
            self.enter(&entry, is_curved, state, step);
            return true;
        }
        // The border of the face is the edge: no evaluation.
        let Witness { surface, second, .. } = &state.witness;
        let (tangent, half_second) =
            if is_along_v { (surface.tangent_v, second.half_vv) } else { (surface.tangent_u, second.half_uu) };
        let at =
            CurvePoint { point: surface.point, tangent: if is_reversed { -tangent } else { tangent }, half_second };
        state.rest_on_edge(index, t, &at);
        (state.declined, step.switched) = (u8::from(is_other), true);
        true
    }

    /// Where the face beyond a side is entered, if it takes the probe. Not inlined: what it keeps on the stack is not
    /// there when the face is evaluated, nor when the edge is stepped along.
    #[inline(never)]
    fn entry_across(
        &self,
        other: EdgeFace,
        kind: EdgeKind,
        crossing: Crossing,
        is_curved: bool,
        state: &BodyWitness,
    ) -> Option<Entry> {
        let Crossing { t, is_along_v, is_reversed, .. } = crossing;
        let surface = &state.witness.surface;
        let tangent = if is_along_v { surface.tangent_v } else { surface.tangent_u };
        let tangent = if is_reversed { -tangent } else { tangent };
        let border = Border { along: Along::new(surface.point, tangent, state.probe), tangent, t };
        self.entry(other, kind == EdgeKind::Smooth, &border, is_curved, state, f32::INFINITY)
    }

    /// From an edge to the face whose region holds the probe, or to the vertex at the end that holds the witness point;
    /// otherwise one step along it.
    #[inline(never)]
    pub(super) fn tick_on_edge(&self, index: u16, is_curved: bool, state: &mut BodyWitness, step: &mut BodyStep) {
        let Some(edge) = self.edges.get(usize::from(index)) else { return };
        let (t, probe) = (state.witness.parameters[0], state.probe);
        let tangent = state.witness.surface.tangent_u;
        let border = Border { along: Along::new(state.witness.surface.point, tangent, probe), tangent, t };
        // An edge that has just been come to asks in the next tick.
        if !step.switched {
            for of in edge.faces {
                if let Some(entry) = self.entry(of, false, &border, is_curved, state, f32::INFINITY) {
                    self.enter(&entry, is_curved, state, step);
                    return;
                }
            }
            state.declined = BOTH;
        }
        if !border.along.is_held(t) {
            step.outcome = self.slide(index, &border.along, is_curved, state);
        } else if state.declined == BOTH {
            step.switched = self.rest_on_vertex(if t <= 0.0 { edge.ends[0] } else { edge.ends[1] }, state);
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
            state.declined = 0;
        }
    }

    #[inline(never)]
    fn rest_on_vertex(&self, index: u16, state: &mut BodyWitness) -> bool {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return false };
        state.feature = Feature::Vertex(index);
        let surface = SurfacePoint { point: vertex.point, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        state.witness = Witness {
            parameters: [0.0; 2],
            surface,
            second: SecondDerivatives::NONE,
            mode: BoundaryMode::Corner,
            is_free: false,
            halvings: 0,
        };
        true
    }
}
