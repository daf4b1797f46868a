//! The tracker that joins both levels: the Voronoi switch, then one controller step on the active feature (theory §9).

use super::along::Along;
use super::curve::CurvePoint;
use super::feature::{EdgeFace, EdgeKind, Feature, Separator, Side};
use super::search::{Located, Search};
use super::table::Body;
use crate::math::{Vec3, sqrt};
use crate::patch::{Patch as _, SurfacePoint};
use crate::render::Contact;
use crate::track::{BoundaryMode, Controller, Outcome, Probe, Witness};

/// A probe that moves farther than this between two ticks, in sizes of the body, has jumped: it is located anew.
const JUMP: f32 = 0.125;
/// The distance of another candidate must be shorter by this part before the tracker changes over: far above what `f32` rounds, far
/// below what a hand feels.
const NEARER: f32 = 1.0e-3;
/// A rise of the squared distance below this many units of the coordinates, times the distance, is rounding: a point of a border is
/// computed from the patch and from the edge's own curve.
const ROUNDING: f32 = 64.0 * f32::EPSILON;

/// The tracker's whole state: at most 256 bytes for a body of any size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWitness {
    /// The feature that owns the closest point, as far as is known.
    pub feature: Feature,
    /// The witness point. On an edge `parameters[0]` is the edge's parameter and `tangent_u` its tangent.
    pub witness: Witness,
    /// On a face: the parameters of its edges closest to the probe, one a side.
    pub sides: [f32; 4],
    /// Unit vector out of the body at the witness point; zero before the first tick on a face.
    pub normal: Vec3,
    /// Signed gap along it, metres; negative inside the body.
    pub gap: f32,
    /// Whether the body is touched.
    pub contact: Contact,
    /// Whether the witness point has been located. Until then there is no gap and no force.
    pub is_located: bool,
    /// Whether a search has ended since the witness point was set down: until then it may be on the far side of the body.
    is_audited: bool,
    /// The search for a global start, or the rolling audit.
    search: Search,
    /// The probe of the last tick; NaN before the first.
    probe: Vec3,
}

/// What a tick found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyStep {
    /// `‖ΔR‖` before the step, metres.
    pub distance_before: f32,
    /// What became of the step.
    pub outcome: Outcome,
    /// Whether the active feature changed.
    pub switched: bool,
    /// Evaluations of patches spent, second-order ones included.
    pub evaluations: u8,
    /// Whether the probe is deeper inside than the least radius of curvature of the face: the closest point is no longer unique and the
    /// witness point is not proved to follow (theory §11).
    pub too_deep: bool,
}

impl Body {
    /// The state before the first tick: nothing is known.
    pub fn start(&self) -> BodyWitness {
        BodyWitness {
            feature: Feature::Face(0),
            witness: Witness::at(&self.faces[0].patch, 0.5, 0.5),
            sides: [0.5; 4],
            normal: Vec3::ZERO,
            gap: 0.0,
            contact: Contact::Behind,
            is_located: false,
            is_audited: false,
            search: Search::new(self, Vec3::ZERO),
            probe: Vec3::NAN,
        }
    }

    /// The state with the witness point set down on a face, wherever the probe may be. Of parameters that are not in `[0, 1]` the
    /// nearest that are; an index that is no face's gives [`Self::start`].
    pub fn start_on(&self, face: u16, [u, v]: [f32; 2]) -> BodyWitness {
        let mut state = self.start();
        if let Some(patch) = self.faces.get(usize::from(face)).map(|face| &face.patch) {
            let witness = Witness::at(patch, u, v);
            self.enter_face(face, witness.parameters, Some(witness), &mut state);
            state.is_located = true;
        }
        state
    }

    /// One tick: at most one controller step, one evaluation of a patch for the search and four of border curves. Bounded, and
    /// without a panic; a probe that is not finite changes nothing.
    ///
    /// The distance to the probe never rises by more than rounding, at a switch neither. Outside, the witness point ends at a point that no
    /// neighbouring feature improves: on a convex body with the probe in front of it that is the closest one, otherwise the rolling audit finds
    /// it. While the body is touched there is no audit: the witness point is the god-object (theory §11), which hands over across common edges only.
    #[inline]
    pub fn step(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period: f32) -> BodyStep {
        let position = probe.position;
        let mut step = BodyStep {
            distance_before: 0.0,
            outcome: Outcome::AtRest,
            switched: false,
            evaluations: 0,
            too_deep: false,
        };
        if !position.is_finite() {
            return step;
        }
        let jump = JUMP * self.size;
        let moved = (position - state.probe).length_squared();
        if moved.is_nan() || (state.is_located && moved > jump * jump) {
            // The first probe is no jump, but says in which cell to search.
            state.is_located &= moved.is_nan();
            state.is_audited = false;
            state.search = Search::new(self, position);
        }
        state.probe = position;
        self.audit(state, position, &mut step);
        if !state.is_located {
            state.contact = Contact::Behind;
            return step;
        }
        let squared = (state.witness.surface.point - position).length_squared();
        step.distance_before = sqrt(squared);
        match state.feature {
            Feature::Face(face) => {
                self.leave_face(face, state, position, squared, &mut step);
            }
            Feature::Edge(edge) => self.leave_edge(edge, state, position, &mut step),
            Feature::Vertex(vertex) => self.leave_vertex(vertex, state, position, &mut step),
        }
        match state.feature {
            Feature::Face(face) => {
                if let Some(face) = self.faces.get(usize::from(face)) {
                    let done = controller.step(&face.patch, &mut state.witness, probe, period);
                    step.outcome = done.outcome;
                    step.evaluations += 1;
                }
            }
            Feature::Edge(edge) => step.outcome = self.slide(edge, state, position),
            Feature::Vertex(_) => {}
        }
        self.orient(state, position, &mut step);
        step
    }

    /// The search for a start, or the rolling audit: one evaluation of one candidate.
    ///
    /// No audit while the body is touched. Nor of a convex body with the probe in front of the witness point: then no other point is
    /// nearer. From behind, the far side of a convex body holds a witness point as well.
    #[inline]
    fn audit(&self, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let is_sure = state.is_audited && self.is_convex && state.contact != Contact::Behind;
        if state.is_located && (is_sure || state.contact == Contact::Touching) {
            return;
        }
        step.evaluations += 1;
        let Some(found) = state.search.step(self, probe) else { return };
        state.search = Search::new(self, probe);
        state.is_audited = true;
        let known = 0.5 * (state.witness.surface.point - probe).length_squared();
        if !state.is_located || found.half_squared < (1.0 - NEARER) * known {
            self.jump(state, &found, probe);
            step.switched = true;
        }
    }

    /// Sets the witness point down where the search has ended.
    fn jump(&self, state: &mut BodyWitness, found: &Located, probe: Vec3) {
        let Some(face) = self.faces.get(usize::from(found.face)) else { return };
        let [u, v] = found.parameters;
        let witness = Witness::at(&face.patch, u, v);
        // The probe has moved since the search began.
        let nearer =
            (witness.surface.point - probe).length_squared() < (state.witness.surface.point - probe).length_squared();
        if state.is_located && !nearer {
            return;
        }
        self.enter_face(found.face, [u, v], Some(witness), state);
        state.is_located = true;
    }

    /// The witness point on a face, at given parameters; the closest points of its sides begin there too.
    #[inline]
    fn enter_face(&self, index: u16, [u, v]: [f32; 2], witness: Option<Witness>, state: &mut BodyWitness) {
        let Some(face) = self.faces.get(usize::from(index)) else { return };
        state.feature = Feature::Face(index);
        state.witness = witness.unwrap_or_else(|| Witness::at(&face.patch, u, v));
        for (number, side) in face.sides.iter().enumerate() {
            let along = if number < 2 { v } else { u };
            let reversed = matches!(side, Side::Edge { reversed: true, .. });
            if let Some(parameter) = state.sides.get_mut(number) {
                *parameter = if reversed { 1.0 - along } else { along };
            }
        }
    }

    /// Follows the closest points of the face's sides and hands over to the nearest edge through which the probe has left.
    #[inline]
    fn leave_face(&self, index: u16, state: &mut BodyWitness, probe: Vec3, squared: f32, step: &mut BodyStep) {
        let Some(face) = self.faces.get(usize::from(index)) else { return };
        let mut nearest: Option<(f32, u16, f32, CurvePoint)> = None;
        for (side, parameter) in face.sides.iter().zip(&mut state.sides) {
            let Side::Edge { edge, separator, .. } = side else { continue };
            let Some(curve) = self.edges.get(usize::from(*edge)).map(|edge| &edge.curve) else { continue };
            let (at, along, beyond) = match separator {
                Separator::Plane { normal, offset } => {
                    let beyond = normal.dot(probe) - offset;
                    if beyond <= 0.0 {
                        continue;
                    }
                    let at = curve.evaluate(*parameter);
                    (at, Along::new(&at, probe), beyond)
                }
                Separator::Ruled(cross) => {
                    let at = curve.evaluate(*parameter);
                    let along = Along::new(&at, probe);
                    (at, along, along.beyond(&at, cross.evaluate(*parameter).point))
                }
            };
            let t = *parameter;
            *parameter = along.advanced(curve, t);
            let side_squared = along.difference.length_squared();
            if beyond > 0.0 && nearest.is_none_or(|(least, ..)| side_squared < least) {
                nearest = Some((side_squared, *edge, t, at));
            }
        }
        if let Some((side_squared, edge, t, at)) = nearest
            && self.is_no_rise(side_squared, squared, at.point, probe)
        {
            step.switched = true;
            let other = self.edges.get(usize::from(edge)).and_then(|edge| across_smooth(edge.kind, edge.faces, index));
            match other {
                // The faces hand over directly: between them lies no region.
                Some(EdgeFace { face, side }) => self.enter_across(face, side, t, state),
                None => rest_on_edge(edge, t, &at, state),
            }
        } else if let Some(vertex) = held_pole(&face.sides, &state.witness) {
            step.switched = true;
            self.rest_on_vertex(vertex, state);
        }
    }

    /// From an edge to the face whose region holds the probe, or to the vertex at the end that holds the witness point.
    #[inline]
    fn leave_edge(&self, index: u16, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let Some(edge) = self.edges.get(usize::from(index)) else { return };
        let t = state.witness.parameters[0];
        let at = CurvePoint { point: state.witness.surface.point, tangent: state.witness.surface.tangent_u };
        let along = Along::new(&at, probe);
        let mut entered: Option<(f32, EdgeFace)> = None;
        for of in edge.faces {
            let Some(face) = self.faces.get(usize::from(of.face)) else { continue };
            let Some(Side::Edge { separator, .. }) = face.sides.get(usize::from(of.side)) else { continue };
            let beyond = match separator {
                Separator::Plane { normal, offset } => normal.dot(probe) - offset,
                Separator::Ruled(cross) => along.beyond(&at, cross.evaluate(t).point),
            };
            // The face over which the probe is farthest in.
            if beyond <= 0.0 && entered.is_none_or(|(least, _)| beyond < least) {
                entered = Some((beyond, of));
            }
        }
        if let Some((_, EdgeFace { face, side })) = entered {
            step.switched = true;
            self.enter_across(face, side, t, state);
        } else if along.is_held(t) {
            step.switched = true;
            self.rest_on_vertex(if t <= 0.0 { edge.ends[0] } else { edge.ends[1] }, state);
        }
    }

    /// From a vertex along the edge that falls most steeply, if one does.
    #[inline]
    fn leave_vertex(&self, index: u16, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
        let first = usize::from(vertex.first_spoke);
        let spokes = self.spokes.get(first..first + usize::from(vertex.spokes)).unwrap_or(&[]);
        let towards = probe - vertex.point;
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
            rest_on_edge(edge, t, &curve.evaluate(t), state);
        }
    }

    /// One step along an edge; undone if the distance would rise.
    #[inline]
    fn slide(&self, index: u16, state: &mut BodyWitness, probe: Vec3) -> Outcome {
        let Some(edge) = self.edges.get(usize::from(index)) else { return Outcome::AtRest };
        let t = state.witness.parameters[0];
        let at = CurvePoint { point: state.witness.surface.point, tangent: state.witness.surface.tangent_u };
        let along = Along::new(&at, probe);
        let next = along.advanced(&edge.curve, t);
        if next == t {
            return Outcome::AtRest;
        }
        let reached = edge.curve.evaluate(next);
        let before = along.difference.length_squared();
        if !self.is_no_rise((reached.point - probe).length_squared(), before, reached.point, probe) {
            return Outcome::Undone;
        }
        rest_on_edge(index, next, &reached, state);
        Outcome::Moved
    }

    /// Into a face over one of its sides, at the edge's parameter. The point stays the same.
    #[inline]
    fn enter_across(&self, index: u16, number: u8, t: f32, state: &mut BodyWitness) {
        let Some(side) = self.faces.get(usize::from(index)).and_then(|face| face.sides.get(usize::from(number))) else {
            return;
        };
        let along = if matches!(side, Side::Edge { reversed: true, .. }) { 1.0 - t } else { t };
        let parameters = match number {
            0 => [0.0, along],
            1 => [1.0, along],
            2 => [along, 0.0],
            _ => [along, 1.0],
        };
        self.enter_face(index, parameters, None, state);
        if let Some(parameter) = state.sides.get_mut(usize::from(number)) {
            *parameter = t;
        }
    }

    fn rest_on_vertex(&self, index: u16, state: &mut BodyWitness) {
        let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
        state.feature = Feature::Vertex(index);
        let surface = SurfacePoint { point: vertex.point, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };
        state.witness = Witness { parameters: [0.0; 2], surface, mode: BoundaryMode::Corner, caution: 1.0 };
    }

    /// Normal, signed gap and contact after the step.
    #[inline]
    fn orient(&self, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let away = probe - state.witness.surface.point;
        let open = match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return };
                // At a pole there is none: the last one stands.
                state.normal = state.witness.normal(&face.patch).unwrap_or(state.normal);
                state.gap = away.dot(state.normal);
                let greatest = face.patch.shape().curvature.greatest;
                step.too_deep = -state.gap * greatest > 1.0;
                false
            }
            Feature::Edge(index) => {
                let kind = self.edges.get(usize::from(index)).map_or(EdgeKind::Mixed, |edge| edge.kind);
                state.point_away(away, kind);
                kind == EdgeKind::Open
            }
            Feature::Vertex(index) => {
                state.point_away(away, EdgeKind::Mixed);
                self.vertices.get(usize::from(index)).is_some_and(|vertex| vertex.is_open)
            }
        };
        // Over the rim of an open body there is neither front nor back; and nothing is touched with a witness point that may be on the far side.
        state.contact = if open || !state.is_audited {
            Contact::Behind
        } else {
            state.contact.next(state.gap, BoundaryMode::Interior)
        };
    }

    /// Whether a squared distance is not above another by more than rounding.
    #[inline]
    fn is_no_rise(&self, now: f32, before: f32, point: Vec3, probe: Vec3) -> bool {
        if now <= before {
            return true;
        }
        let coordinates = (point.abs() + probe.abs()).max_element() + self.size;
        now - before <= ROUNDING * coordinates * sqrt(before)
    }
}

impl BodyWitness {
    /// On an edge or a vertex: from the witness point towards the probe outside, the other way inside. Where the edge does not say which
    /// side the probe is on it is where it was: nothing goes through the surface without a face.
    #[inline]
    fn point_away(&mut self, away: Vec3, kind: EdgeKind) {
        let outward = match kind {
            EdgeKind::Convex | EdgeKind::Open => true,
            EdgeKind::Reflex => false,
            EdgeKind::Smooth | EdgeKind::Mixed => self.gap >= 0.0,
        };
        let distance = sqrt(away.length_squared());
        let sign = if outward { 1.0 } else { -1.0 };
        if distance > f32::MIN_POSITIVE {
            self.normal = away * (sign / distance);
        }
        self.gap = sign * distance;
    }
}

#[inline]
fn rest_on_edge(index: u16, t: f32, at: &CurvePoint, state: &mut BodyWitness) {
    state.feature = Feature::Edge(index);
    let surface = SurfacePoint { point: at.point, tangent_u: at.tangent, tangent_v: Vec3::ZERO };
    let mode = if t <= 0.0 || t >= 1.0 { BoundaryMode::Corner } else { BoundaryMode::LowerV };
    state.witness = Witness { parameters: [t, 0.0], surface, mode, caution: 1.0 };
}

/// The face beyond a smooth edge.
#[inline]
fn across_smooth(kind: EdgeKind, [first, second]: [EdgeFace; 2], from: u16) -> Option<EdgeFace> {
    let other = if first.face == from { second } else { first };
    (kind == EdgeKind::Smooth && other.face != from && other != EdgeFace::NONE).then_some(other)
}

/// The pole at which the witness point is held.
#[inline]
fn held_pole(sides: &[Side; 4], witness: &Witness) -> Option<u16> {
    let [u, v] = witness.parameters;
    let held = [
        (u <= 0.0, BoundaryMode::LowerU),
        (u >= 1.0, BoundaryMode::UpperU),
        (v <= 0.0, BoundaryMode::LowerV),
        (v >= 1.0, BoundaryMode::UpperV),
    ];
    sides.iter().zip(held).find_map(|(side, (at_border, mode))| match side {
        Side::Pole { vertex } if at_border && (witness.mode == mode || witness.mode == BoundaryMode::Corner) => {
            Some(*vertex)
        }
        _ => None,
    })
}
