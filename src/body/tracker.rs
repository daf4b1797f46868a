//! The tracker that joins both levels: the Voronoi switch, or one controller step on the active feature (theory §9).

use super::along::Along;
use super::curve::CurvePoint;
use super::feature::{EdgeKind, Feature};
use super::search::Search;
use super::table::Body;
use crate::math::{Vec3, inverse_sqrt, sqrt};
use crate::patch::Patch as _;
use crate::render::Contact;
use crate::track::{BoundaryMode, Controller, Outcome, Probe, Witness};

/// A probe that moves farther than this between two ticks, in sizes of the body, has jumped: it is located anew.
const JUMP: f32 = 0.125;
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
    /// Unit vector out of the body at the witness point; zero before the first tick on a face.
    pub normal: Vec3,
    /// Signed gap along it, metres; negative inside the body.
    pub gap: f32,
    /// Whether the body is touched.
    pub contact: Contact,
    /// Whether the witness point has been located. Until then there is no gap and no force.
    pub is_located: bool,
    /// Whether a search has ended since the witness point was set down: until then it may be on the far side of the body.
    pub(super) is_audited: bool,
    /// Behind the surface: whether the tracker has its turn, or the audit.
    pub(super) rests: bool,
    /// On an edge: which of its faces is asked next.
    pub(super) asks_second: bool,
    /// The search for a global start, or the rolling audit, once begun.
    pub(super) search: Option<Search>,
    /// The probe of the last tick; infinite before the first.
    pub(super) probe: Vec3,
}

/// What a tick found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyStep {
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

const _: () = assert!(size_of::<BodyWitness>() <= 256);

impl BodyStep {
    /// Nothing done.
    pub(super) const NOTHING: Self =
        Self { outcome: Outcome::AtRest, switched: false, evaluations: 0, too_deep: false };
}

impl Body {
    /// The state before the first tick: nothing is known.
    pub fn start(&self) -> BodyWitness {
        BodyWitness {
            feature: Feature::Face(0),
            witness: Witness::at(&self.faces[0].patch, 0.5, 0.5),
            normal: Vec3::ZERO,
            gap: 0.0,
            contact: Contact::Behind,
            is_located: false,
            is_audited: false,
            rests: false,
            asks_second: false,
            search: None,
            probe: Vec3::INFINITY,
        }
    }

    /// The state with the witness point set down on a face, wherever the probe may be. Of parameters that are not in `[0, 1]` the
    /// nearest that are; an index that is no face's gives [`Self::start`].
    pub fn start_on(&self, face: u16, [u, v]: [f32; 2]) -> BodyWitness {
        let mut state = self.start();
        if let Some(on) = self.faces.get(usize::from(face)) {
            state.feature = Feature::Face(face);
            state.witness = Witness::at(&on.patch, u, v);
            state.is_located = true;
        }
        state
    }

    /// One tick: a switch to a neighbouring feature, or one controller step on the active one; at most one evaluation of a patch, and
    /// half of one of second order for the search. Bounded, and without a panic; a probe that is not finite changes nothing.
    ///
    /// The distance to the probe never rises by more than rounding, at a switch neither. Outside, the witness point ends at a point that no
    /// neighbouring feature improves: on a convex body with the probe in front of it that is the closest one, otherwise the rolling audit
    /// finds it. While the body is touched there is no audit: the witness point is the god-object (theory §11), which hands over across
    /// common edges only.
    #[inline(always)]
    pub fn step(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period: f32) -> BodyStep {
        let mut step = BodyStep::NOTHING;
        let position = probe.position;
        let jump = JUMP * self.size;
        // False for a probe that is not finite.
        let follows = (position - state.probe).length_squared() <= jump * jump;
        let is_known = follows && state.is_located && self.is_sure(state);
        if !is_known && !self.search(state, position, follows, &mut step) {
            return step;
        }
        state.probe = position;
        match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return step };
                if state.witness.mode == BoundaryMode::Interior || !self.leave_face(index, state, position, &mut step) {
                    let done = controller.step(&face.patch, &mut state.witness, probe, period);
                    step.outcome = done.outcome;
                    step.evaluations += 1;
                }
            }
            Feature::Edge(index) => self.tick_on_edge(index, state, position, &mut step),
            Feature::Vertex(index) => self.leave_vertex(index, state, position, &mut step),
        }
        match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return step };
                // At a pole there is none: the last one stands.
                state.normal = state.witness.normal(&face.patch).unwrap_or(state.normal);
                state.gap = (position - state.witness.surface.point).dot(state.normal);
                step.too_deep = -state.gap * face.patch.shape().curvature.greatest > 1.0;
                state.meet(state.contact.next(state.gap, BoundaryMode::Interior));
            }
            Feature::Edge(index) => {
                let kind = self.edges.get(usize::from(index)).map_or(EdgeKind::Mixed, |edge| edge.kind);
                state.point_away(position, kind);
            }
            Feature::Vertex(index) => {
                let is_open = self.vertices.get(usize::from(index)).is_some_and(|vertex| vertex.is_open);
                state.point_away(position, if is_open { EdgeKind::Open } else { EdgeKind::Mixed });
            }
        }
        step
    }

    /// Whether there is nothing to audit: the body is touched, or it is convex and the probe in front of the witness point, so that no other
    /// point is nearer. From behind, the far side of a convex body holds a witness point as well; there tracker and audit take turns.
    #[inline]
    fn is_sure(&self, state: &mut BodyWitness) -> bool {
        match state.contact {
            Contact::Touching => true,
            Contact::InFront => self.is_convex,
            Contact::Behind => {
                state.rests = !state.rests;
                state.rests
            }
        }
    }

    /// One step along an edge; undone if the distance would rise.
    #[inline]
    pub(super) fn slide(&self, index: u16, along: &Along, state: &mut BodyWitness, probe: Vec3) -> Outcome {
        let Some(edge) = self.edges.get(usize::from(index)) else { return Outcome::AtRest };
        let t = state.witness.parameters[0];
        let next = along.advanced(&edge.curve, t);
        if next == t {
            return Outcome::AtRest;
        }
        let reached = edge.curve.evaluate(next);
        let before = along.difference.length_squared();
        if !self.is_no_rise((reached.point - probe).length_squared(), before, reached.point, probe) {
            return Outcome::Undone;
        }
        state.rest_on_edge(index, next, &reached);
        Outcome::Moved
    }

    /// Whether a squared distance is not above another by more than rounding.
    #[inline]
    pub(super) fn is_no_rise(&self, now: f32, before: f32, point: Vec3, probe: Vec3) -> bool {
        if now <= before {
            return true;
        }
        let coordinates = (point.abs() + probe.abs()).max_element() + self.size;
        now - before <= ROUNDING * coordinates * sqrt(before)
    }
}

impl BodyWitness {
    /// On an edge or a vertex: normal and gap from the witness point towards the probe outside, the other way inside. Where the edge does
    /// not say which side the probe is on it is where it was: nothing goes through the surface without a face.
    #[inline(never)]
    fn point_away(&mut self, probe: Vec3, kind: EdgeKind) {
        let away = probe - self.witness.surface.point;
        let outward = match kind {
            EdgeKind::Convex | EdgeKind::Open => true,
            EdgeKind::Reflex => false,
            EdgeKind::Smooth | EdgeKind::Mixed => self.gap >= 0.0,
        };
        let sign = if outward { 1.0 } else { -1.0 };
        let squared = away.length_squared();
        self.gap = 0.0;
        if squared > f32::MIN_POSITIVE {
            let inverse = inverse_sqrt(squared);
            self.normal = away * (sign * inverse);
            self.gap = sign * squared * inverse;
        }
        // Over the rim of an open body there is neither front nor back.
        self.meet(match kind {
            EdgeKind::Open => Contact::Behind,
            _ => self.contact.next(self.gap, BoundaryMode::Interior),
        });
    }

    /// Nothing is met with a witness point that may be on the far side.
    #[inline]
    fn meet(&mut self, contact: Contact) {
        self.contact = if self.is_audited { contact } else { Contact::Behind };
    }

    #[inline]
    pub(super) fn rest_on_edge(&mut self, index: u16, t: f32, at: &CurvePoint) {
        self.feature = Feature::Edge(index);
        self.witness.parameters = [t, 0.0];
        self.witness.surface.point = at.point;
        self.witness.surface.tangent_u = at.tangent;
        self.witness.surface.tangent_v = Vec3::ZERO;
        self.witness.mode = if t <= 0.0 || t >= 1.0 { BoundaryMode::Corner } else { BoundaryMode::LowerV };
        self.witness.is_free = false;
        self.witness.halvings = 0;
    }
}
