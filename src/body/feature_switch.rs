//! The switch: the transitions of the tracker between features. No switch raises the distance by more than rounding.

use super::curve::CurvePoint;
use super::edge_step::EdgeStep;
use super::face_entry::{EdgePoint, Entry};
use super::feature::{Edge, EdgeFace, EdgeKind, Face, Feature, Side, Spoke, Vertex};
use super::inside_test::counted;
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::field::Displacement;
use crate::math::Vec3;
use crate::patch::{SecondDerivatives, SurfacePoint};
use crate::track::{BoundaryMode, Outcome, Witness};

impl<D: Displacement> Body<'_, D> {
    /// Hands over through the side that holds the witness point. While the witness point is free there is no need: the
    /// controller brings it to the side through which the probe has left, and there the measure numbers of the
    /// projection errors change sign as the probe passes the separator. Returns whether the tick is spent, or the
    /// edge's.
    #[inline(never)]
    pub(super) fn leave_face(&self, index: u16, state: &mut BodyWitness, step: &mut BodyStep) -> bool {
        let Some(face) = self.faces.get(usize::from(index)) else { return false };
        let [u, v] = state.witness.parameters;
        let number = match state.witness.mode {
            BoundaryMode::LowerU => 0,
            BoundaryMode::UpperU => 1,
            BoundaryMode::LowerV => 2,
            BoundaryMode::UpperV => 3,
            // At a corner a smooth edge would hand over a probe that belongs to the other side, and get it back.
            BoundaryMode::Corner => {
                let [first, second] = [usize::from(u > 0.5), 2 + usize::from(v > 0.5)];
                let [kind, other] = [first, second].map(|number| self.kind_of_side(face, number));
                let is_other_sharp = other.is_some_and(|other| other != EdgeKind::Smooth);
                if kind == Some(EdgeKind::Smooth) && is_other_sharp { second } else { first }
            }
            BoundaryMode::Interior => return false,
        };
        let Some(side) = face.sides.get(number) else { return false };
        match side {
            Side::Pole { vertex } => {
                step.switched = self.rest_on_vertex(*vertex, state);
                step.switched
            }
            Side::Edge { edge, reversed, .. } => {
                // The border is the edge: no evaluation is needed.
                let Witness { surface, second, halvings, .. } = &state.witness;
                let (point, halvings) = (surface.point, *halvings);
                let (along, tangent, half_second) = if number < 2 {
                    (v, surface.tangent_v, second.half_vv)
                } else {
                    (u, surface.tangent_u, second.half_uu)
                };
                let (t, tangent) = if *reversed { (1.0 - along, -tangent) } else { (along, tangent) };
                state.rest_on_edge(*edge, t, &CurvePoint { point, tangent, half_second });
                // After a rejected step the other face is entered at the border.
                state.witness.halvings = halvings;
                step.switched = true;
                true
            }
        }
    }

    /// The kind of the edge that a side of a face is; `None` of a pole.
    pub(super) fn kind_of_side(&self, face: &Face, number: usize) -> Option<EdgeKind> {
        let Some(Side::Edge { edge, .. }) = face.sides.get(number) else { return None };
        self.edges.get(usize::from(*edge)).map(|edge| edge.kind)
    }

    /// On an edge: hands over to the face whose region holds the probe, or to the vertex at the end that holds the
    /// witness point; otherwise takes one step along the edge. If the tracker has just come from the face `from`, only
    /// the other face is asked.
    #[inline(never)]
    pub(super) fn tick_on_edge(
        &self,
        index: u16,
        from: u16,
        is_curved: bool,
        state: &mut BodyWitness,
        step: &mut BodyStep,
    ) {
        let Some(edge) = self.edges.get(usize::from(index)) else { return };
        let (t, probe) = (state.witness.parameters[0], state.probe);
        let tangent = state.witness.surface.tangent_u;
        let border = EdgePoint { along: EdgeStep::new(state.witness.surface.point, tangent, probe), tangent, t };
        let comes_from_face = from != EdgeFace::NONE.face;
        state.no_face_took_probe = false;
        // A smooth edge owns no probe.
        if comes_from_face
            && edge.kind == EdgeKind::Smooth
            && self.cross_smooth_edge(edge, from, is_curved, state, step)
        {
            return;
        }
        // After a vertex the faces are asked in the next tick.
        let faces = if comes_from_face || !step.switched { &edge.faces[..] } else { &[] };
        for of in faces.iter().copied() {
            if of.face != from
                && let Some(beyond) = self.neighbour(edge, of, &border, probe, false)
            {
                let entry = beyond.entry(&border, border.along.stretch, is_curved, state, f32::INFINITY);
                self.enter_face(&entry, is_curved, state, step);
                // At a corner the face may take the probe over this edge and not over the other one.
                if step.outcome == Outcome::Rejected && border.along.is_held(t) {
                    step.outcome = Outcome::AtRest;
                    step.switched = self.rest_on_vertex(if t <= 0.0 { edge.ends[0] } else { edge.ends[1] }, state);
                }
                return;
            }
        }
        state.no_face_took_probe = !comes_from_face && !step.switched;
        if !border.along.is_held(t) {
            step.outcome = self.step_along_edge(index, &border.along, is_curved, state);
        } else if state.no_face_took_probe {
            step.switched = self.rest_on_vertex(if t <= 0.0 { edge.ends[0] } else { edge.ends[1] }, state);
        }
    }

    /// Enters the other face of a smooth edge at the border. Returns whether there is another.
    #[inline]
    fn cross_smooth_edge(
        &self,
        edge: &Edge,
        from: u16,
        is_curved: bool,
        state: &mut BodyWitness,
        step: &mut BodyStep,
    ) -> bool {
        let Witness { parameters: [t, _], halvings, .. } = state.witness;
        let Some(other) = edge.faces.iter().copied().find(|of| of.face != from) else { return false };
        let Some((face, parameters)) = self.position_on_face(other, t) else { return false };
        self.enter_face(&Entry { face, parameters, fall: 0.0 }, is_curved, state, step);
        // A step over the edge that was rejected is not tried again from the other side.
        state.witness.halvings = halvings;
        true
    }

    /// From a vertex to the edge along which the distance falls most steeply, if it falls along any.
    #[inline(never)]
    pub(super) fn leave_vertex(&self, index: u16, state: &mut BodyWitness, step: &mut BodyStep) {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
        if let Some((_, spoke)) = self.steepest(vertex, state.probe - self.place(vertex))
            && let Some(edge) = self.edges.get(usize::from(spoke.edge))
        {
            step.switched = true;
            let t = if spoke.at_upper_end { 1.0 } else { 0.0 };
            state.rest_on_edge(spoke.edge, t, &self.on_edge(edge, t));
        }
    }

    /// The edge along which the distance to a probe at the offset `towards` falls most steeply from a vertex, and how
    /// far along its tangent the probe is, metres; `None` if no edge leads nearer.
    pub(crate) fn steepest(&self, vertex: &Vertex, towards: Vec3) -> Option<(f32, &Spoke)> {
        let mut steepest: Option<(f32, &Spoke)> = None;
        for spoke in counted(self.spokes_of(vertex)) {
            let fall = towards.dot(self.spoke_direction(vertex, spoke));
            if fall > 0.0 && steepest.is_none_or(|(most, _)| fall > most) {
                steepest = Some((fall, spoke));
            }
        }
        steepest
    }

    #[inline(never)]
    pub(super) fn rest_on_vertex(&self, index: u16, state: &mut BodyWitness) -> bool {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return false };
        state.feature = Feature::Vertex(index);
        let surface = SurfacePoint { point: self.place(vertex), tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
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
