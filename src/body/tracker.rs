//! The tracker that joins both levels: the Voronoi switch, or one controller step on the active feature (theory §9).

use super::curve::CurvePoint;
use super::edge_step::EdgeStep;
use super::feature::{EdgeFace, Face, Feature};
use super::search::Search;
use super::table::Body;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::patch::SplinePatch;
use crate::track::{Aim, BoundaryMode, Contact, Controller, Outcome, Probe, Witness};

/// A probe that moves farther than this between two ticks, in sizes of the body, has jumped: it is located anew, once
/// it rests or slows down.
const JUMP: f32 = 0.125;
/// A rise of the squared distance below this many units of the coordinates, times the distance, is rounding: a point of
/// a border is computed from the patch and from the edge's own curve.
const ROUNDING: f32 = 64.0 * f32::EPSILON;
/// So far beyond its reach, in sizes of the body, a witness point is where nothing explains it: a hundred times what a
/// sum of rounded paths loses in a second.
const UNEXPLAINED: f32 = 1.0e-3;

/// The tracker's whole state: at most 256 bytes for a body of any size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWitness {
    /// The feature that owns the closest point, as far as is known.
    pub feature: Feature,
    /// The witness point. On an edge `parameters[0]` is the edge's parameter, `tangent_u` its tangent and `half_uu`
    /// half its second derivative.
    pub witness: Witness,
    /// Unit vector out of the body at the witness point; zero before the first tick on a face.
    pub normal: Vec3,
    /// Signed gap along it, metres; negative inside the body.
    pub gap: f32,
    /// Whether the body is touched. Behind it until the witness point is located.
    pub contact: Contact,
    /// Whether the witness point has been located. Until then there is no gap and no force.
    pub is_located: bool,
    /// Whether a search has ended since the witness point was set down: until then it may be on the far side of the
    /// body.
    pub(super) is_audited: bool,
    /// Behind the surface: whether the tracker has its turn, or the audit.
    pub(super) is_trackers_turn: bool,
    /// On an edge: whether the last tick has asked all of its faces, and none took the probe.
    pub(super) no_face_took_probe: bool,
    /// The search for a global start, or the rolling audit, once begun.
    pub(super) search: Option<Search>,
    /// The probe of the last tick; infinite before the first.
    pub(super) probe: Vec3,
    /// While the body is touched, no less than the probe can be away from a witness point that follows it, metres: as
    /// far as it was when contact began, and as it has moved since.
    pub(crate) reach: f32,
}

/// What a tick found out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyStep {
    /// What became of the step.
    pub outcome: Outcome,
    /// Whether the active feature changed.
    pub switched: bool,
    /// Whether the tick went to the search, and none of it was left for a step.
    pub searched: bool,
    /// Evaluations of patches spent, second-order ones included.
    pub evaluations: u8,
    /// Whether the body is touched with a witness point farther from the probe than the probe has moved since contact
    /// began.
    pub unexplained: bool,
}

const _: () = assert!(size_of::<BodyWitness>() <= 256);

impl BodyStep {
    /// Nothing done.
    pub(super) const NOTHING: Self =
        Self { outcome: Outcome::AtRest, switched: false, searched: false, evaluations: 0, unexplained: false };

    /// Whether it has entered a face over an edge, which is work enough for a tick: what lies beyond that face's own
    /// borders is for the next one.
    #[inline]
    pub(super) fn hands_over(&self) -> bool {
        self.switched && self.outcome == Outcome::AtRest
    }
}

impl Body<'_> {
    /// The state before the first tick: nothing is known.
    pub fn start(&self) -> BodyWitness {
        BodyWitness {
            feature: Feature::Face(0),
            // There is a face, but the compiler may not know.
            witness: Witness::at(self.faces.first().map_or(&SplinePatch::VACANT, |face| &face.patch), 0.5, 0.5),
            normal: Vec3::ZERO,
            gap: 0.0,
            contact: Contact::Behind,
            is_located: false,
            is_audited: false,
            is_trackers_turn: false,
            no_face_took_probe: false,
            search: None,
            probe: Vec3::INFINITY,
            reach: 0.0,
        }
    }

    /// The state with the witness point set down on a face, wherever the probe may be. Of parameters that are not in
    /// `[0, 1]` the nearest that are; an index that is no face's gives [`Self::start`].
    pub fn start_on(&self, face: u16, [u, v]: [f32; 2]) -> BodyWitness {
        let mut state = self.start();
        if let Some(on) = self.faces.get(usize::from(face)) {
            state.feature = Feature::Face(face);
            state.witness = Witness::at(&on.patch, u, v);
            state.is_located = true;
        }
        state
    }

    /// One tick of the loop: [`Self::track`], then [`Self::update_contact`].
    #[inline(always)]
    pub fn step(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period: f32) -> BodyStep {
        let moved = (probe.position - state.probe).length_squared();
        // What is no probe, or has jumped, has not moved there.
        if state.contact == Contact::Touching && moved <= self.jump_squared() {
            state.reach += sqrt_from_above(moved);
        }
        let mut step = self.track(controller, state, probe, period);
        if !step.searched {
            self.update_contact(state, probe.position, &step);
        }
        step.unexplained = state.contact == Contact::Touching && -state.gap > state.reach + UNEXPLAINED * self.size;
        step
    }

    /// The closest point: a switch to a neighbouring feature, or one controller step on the active one; at most one
    /// evaluation of a patch, and half of one for the search, or one where it ends. Bounded, and without a panic; a
    /// probe that is not finite moves nothing.
    ///
    /// The distance to the probe never rises by more than rounding, at a switch neither. Outside, the witness point
    /// ends at a point that no neighbouring feature improves: on a convex body with the probe in front of it that is
    /// the closest one, otherwise the rolling audit finds it. While the body is touched there is no audit: the witness
    /// point is the god-object (theory §11), which hands over across common edges only.
    ///
    /// Contact decides, so [`Self::update_contact`] belongs after each tick that was not `searched`. Without it the probe counts
    /// as behind the surface: on a convex body the audit has every second tick.
    #[inline(always)]
    pub fn track(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period: f32) -> BodyStep {
        let mut step = BodyStep::NOTHING;
        let is_curved = controller.is_second_order();
        let follows = self.follows(state, probe.position);
        let has_turn = follows && self.has_turn(state);
        if !has_turn && !self.search(state, probe.position, follows, &mut step) {
            step.searched = true;
            return step;
        }
        state.probe = probe.position;
        let mut from = EdgeFace::NONE.face;
        match state.feature {
            Feature::Face(index) => {
                from = index;
                let stays = state.witness.is_free || state.witness.mode == BoundaryMode::Interior;
                if (stays || !self.leave_face(index, state, &mut step))
                    && let Some(face) = self.faces.get(usize::from(index))
                {
                    if is_curved {
                        self.step_curved(face, state, probe.position, &mut step);
                    } else {
                        step.outcome = controller.step(&face.patch, &mut state.witness, probe, period).outcome;
                        step.evaluations += 1;
                    }
                    return step;
                }
            }
            Feature::Vertex(index) => self.leave_vertex(index, state, &mut step),
            Feature::Edge(_) => {}
        }
        // Also one that has just been come to.
        if let Feature::Edge(index) = state.feature {
            self.tick_on_edge(index, from, is_curved, state, &mut step);
        }
        step
    }

    /// One step of second order on a face. Where it ends at a smooth edge that the probe has passed, it ends on the
    /// face beyond.
    #[inline(always)]
    fn step_curved(&self, face: &Face, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let aim = match Aim::in_full(&face.patch, &state.witness, probe) {
            Ok(aim) => aim,
            Err(_) if self.has_poles && self.step_near_pole(face, state, step) => return,
            Err(most) => Aim::in_part(most, &face.patch, &state.witness, probe),
        };
        if aim.beyond != BoundaryMode::Interior
            && self.has_smooth_edges
            && self.step_over_smooth_edge(face, &aim, state, step)
        {
            return;
        }
        state.witness.mode = aim.beyond;
        if !aim.has_slope() {
            return;
        }
        let [u, v] = aim.landing.parameters;
        let reached = face.patch.evaluate_curved(u, v);
        step.evaluations += 1;
        step.outcome = aim.settle(&reached, &mut state.witness, probe, self.size);
    }

    /// Whether the probe is near that of the last tick. Not if it is not finite.
    #[inline]
    fn follows(&self, state: &BodyWitness, probe: Vec3) -> bool {
        (probe - state.probe).length_squared() <= self.jump_squared()
    }

    #[inline]
    pub(super) fn jump_squared(&self) -> f32 {
        let jump = JUMP * self.size;
        jump * jump
    }

    /// Whether the tick is the tracker's alone: there is nothing to audit, or, behind a convex body's surface, it is
    /// its turn. From behind, the far side holds a witness point as well; there tracker and audit take turns.
    #[inline]
    fn has_turn(&self, state: &mut BodyWitness) -> bool {
        match state.contact {
            contact if contact >= self.sure_from => true,
            Contact::Behind if self.is_convex() => {
                state.is_trackers_turn = !state.is_trackers_turn;
                state.is_trackers_turn && state.is_located
            }
            _ => false,
        }
    }

    /// One step along an edge; rejected if the distance would rise.
    #[inline]
    pub(super) fn step_along_edge(
        &self,
        index: u16,
        along: &EdgeStep,
        is_curved: bool,
        state: &mut BodyWitness,
    ) -> Outcome {
        let Some(edge) = self.edges.get(usize::from(index)) else { return Outcome::AtRest };
        let (t, probe) = (state.witness.parameters[0], state.probe);
        let minimiser = if is_curved { along.minimiser(edge, state.witness.second.half_uu, t) } else { None };
        let next = match minimiser {
            Some(next) => next,
            None => along.advanced(&edge.curve, t),
        };
        if next == t {
            return Outcome::AtRest;
        }
        let reached = edge.curve.evaluate(next);
        let before = along.difference.length_squared();
        if !self.is_no_rise((reached.point - probe).length_squared(), before, reached.point, probe) {
            return Outcome::Rejected;
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
    /// Where the closest point is has to be searched for again; until then nothing is met.
    pub(crate) fn forget(&mut self) {
        (self.is_located, self.is_audited, self.search) = (false, false, None);
        self.contact = Contact::Behind;
    }

    #[inline]
    pub(super) fn rest_on_edge(&mut self, index: u16, t: f32, at: &CurvePoint) {
        self.feature = Feature::Edge(index);
        self.witness.parameters = [t, 0.0];
        self.witness.surface.point = at.point;
        self.witness.surface.tangent_u = at.tangent;
        self.witness.surface.tangent_v = Vec3::ZERO;
        self.witness.second.half_uu = at.half_second;
        self.witness.mode = if t <= 0.0 || t >= 1.0 { BoundaryMode::Corner } else { BoundaryMode::LowerV };
        self.witness.is_free = false;
        self.witness.halvings = 0;
    }
}
