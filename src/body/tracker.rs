//! The tracker of a body: in each tick Voronoi switches and controller steps on the active feature (theory §9).

use super::audit::Seeking;
use super::curve::CurvePoint;
use super::edge_step::EdgeStep;
use super::face_entry::MIN_FALL;
use super::feature::{Edge, EdgeFace, Face, Feature};
use super::table::Body;
use crate::field::Displacement;
use crate::math::{Vec3, sqrt, sqrt_from_above};
use crate::patch::Patch as _;
use crate::track::{Aim, BoundaryMode, Contact, Controller, Outcome, Probe, Witness};

/// Motion of a probe between two ticks, relative to the body's size, above which it has jumped: it is located again
/// once it rests or slows down.
const JUMP: f32 = 0.125;
/// A rise of the squared distance below this, times the coordinates and the distance, is rounding: a point of a border
/// is computed from the patch and from the edge's own curve.
const ROUNDING: f32 = 64.0 * f32::EPSILON;
/// Excess over the reach, relative to the body's size, above which the witness point is unexplained: a hundred times
/// the rounding loss of a sum of paths in a second.
const UNEXPLAINED: f32 = 1.0e-3;

/// State of the tracker: at most 256 bytes for a body of any size.
///
/// ```
/// use palpate::body::{Aligned, Body, BodyBuffer, BodyWitness, Edge, Face};
/// use palpate::math::vec3;
/// use palpate::track::{Contact, Controller, Probe};
///
/// # static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")));
/// # let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// # let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// // A probe that goes through the face x = 0 of a box, at 0.25 mm a tick.
/// let mut witness: BodyWitness = body.start();
/// for tick in 0..60 {
///     let probe = Probe::at(vec3(-0.01 + 0.000_25 * tick as f32, 0.02, 0.01));
///     body.step(&Controller::SecondOrder, &mut witness, probe, 0.001);
/// }
/// assert_eq!(witness.contact, Contact::Touching);
/// assert!((witness.gap + 0.004_75).abs() < 1e-6); // 4.75 mm inside
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyWitness {
    /// The feature that owns the witness point.
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
    /// Whether a search has ended since the witness point was placed: until then it may be on the far side of the
    /// body.
    pub(super) is_audited: bool,
    /// Behind the surface: whether it is the tracker's turn, not the audit's.
    pub(super) is_trackers_turn: bool,
    /// Whether a full step without a certificate was rejected: the next one is the certified part of it.
    pub(super) takes_part: bool,
    /// On an edge: whether the last tick asked all of its faces, and none took the probe.
    pub(super) no_face_took_probe: bool,
    /// Ticks of the audit's pass that it has left to the tracker.
    pub(super) deferred: u8,
    /// The search for a global start, or the audit.
    pub(super) seeking: Option<Seeking>,
    /// The probe of the last tick; infinite before the first.
    pub(super) probe: Vec3,
    /// While the body is touched: upper bound of the distance from the probe to a witness point that follows it,
    /// metres: the distance when contact started, plus the motion since.
    pub(crate) reach: f32,
}

/// Result of a tick of the tracker.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BodyStep {
    /// Outcome of the last step; moved as well if it is at rest after a switch.
    pub outcome: Outcome,
    /// Whether the active feature changed.
    pub switched: bool,
    /// Whether the search used the tick, without a step of the tracker.
    pub searched: bool,
    /// Evaluations of patches spent, second-order ones included.
    pub evaluations: u8,
    /// Whether the body is touched with a witness point farther from the probe than the probe has moved since contact
    /// started.
    pub unexplained: bool,
    /// How far the step went.
    pub(super) length: StepLength,
}

/// How far a step goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(super) enum StepLength {
    /// All the way.
    Full,
    /// As far as the certificate holds.
    Cut,
    /// Beside a pole, where the evaluation decides.
    NearPole,
}

const _: () = assert!(size_of::<BodyWitness>() <= 256);

impl BodyStep {
    /// A tick that did nothing.
    pub(super) const NOTHING: Self = Self {
        outcome: Outcome::AtRest,
        switched: false,
        searched: false,
        evaluations: 0,
        unexplained: false,
        length: StepLength::Full,
    };

    /// Whether the last step has entered a face over an edge. That is work enough for a tick: the borders of the new
    /// face are for the next one.
    #[inline]
    pub(super) fn hands_over(&self) -> bool {
        self.switched && self.outcome == Outcome::AtRest
    }
}

impl<D: Displacement> Body<'_, D> {
    /// The state before the first tick: the closest point is not known.
    pub fn start(&self) -> BodyWitness {
        BodyWitness {
            feature: Feature::Face(0),
            // There is a face, but the compiler does not know that.
            witness: Witness::at(&self.patch(self.faces.first().unwrap_or(&Face::VACANT)), 0.5, 0.5),
            normal: Vec3::ZERO,
            gap: 0.0,
            contact: Contact::Behind,
            is_located: false,
            is_audited: false,
            is_trackers_turn: false,
            takes_part: false,
            no_face_took_probe: false,
            deferred: 0,
            seeking: None,
            probe: Vec3::INFINITY,
            reach: 0.0,
        }
    }

    /// The state with the witness point on a face. Parameters outside `[0, 1]` become the nearest inside; an index
    /// without a face gives [`Self::start`].
    pub fn start_on(&self, face: u16, [u, v]: [f32; 2]) -> BodyWitness {
        let mut state = self.start();
        if let Some(on) = self.faces.get(usize::from(face)) {
            state.feature = Feature::Face(face);
            state.witness = Witness::at(&self.patch(on), u, v);
            state.is_located = true;
        }
        state
    }

    /// One tick of the loop: [`Self::track`], then [`Self::update_contact`]. `period_s` is the servo period, seconds.
    #[inline(always)]
    pub fn step(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period_s: f32) -> BodyStep {
        let moved = (probe.position - state.probe).length_squared();
        // A jump, or a probe that is not finite, is no motion.
        if state.contact == Contact::Touching && moved <= self.jump_squared() {
            state.reach += sqrt_from_above(moved);
        }
        let mut step = self.track(controller, state, probe, period_s);
        if !step.searched {
            self.update_contact(state, probe.position, &step);
        }
        step.unexplained = state.contact == Contact::Touching && -state.gap > state.reach + UNEXPLAINED * self.size;
        step
    }

    /// Moves the witness point towards the closest point, by the steps of the [`Effort`](super::Effort): each a switch
    /// to a neighbouring feature, or one controller step on the active one; then the audit. Bounded, and without a
    /// panic; a probe that is not finite moves nothing. `period_s` is the servo period, seconds.
    ///
    /// The distance to the probe never rises by more than rounding, at a switch neither. Outside, the witness point
    /// ends at a point that no neighbouring feature improves: on a convex body with the probe in front of it that is
    /// the closest one, otherwise the audit finds it. While the body is touched there is no audit: the witness
    /// point is the god-object (theory §11), which hands over across common edges only.
    ///
    /// Contact decides, so [`Self::update_contact`] belongs after each tick that was not `searched`. Without it the
    /// probe counts as behind the surface: on a convex body the audit has every second tick.
    #[inline(always)]
    pub fn track(&self, controller: &Controller, state: &mut BodyWitness, probe: Probe, period_s: f32) -> BodyStep {
        let mut step = BodyStep::NOTHING;
        let follows = self.follows(state, probe.position);
        let has_turn = follows && self.has_turn(state);
        let audits = !has_turn && follows && state.is_audited && !self.is_convex();
        if !has_turn && !audits && !self.search(state, probe.position, follows, &mut step) {
            step.searched = true;
            return step;
        }
        state.probe = probe.position;
        self.step_once(controller, state, probe, period_s, &mut step);
        if self.effort.steps > 1 && controller.is_second_order() && state.goes_on(&step) {
            self.step_on(state, &mut step);
        }
        if audits {
            self.audit(state, !state.goes_on(&step), &mut step);
        }
        step
    }

    /// The steps of a tick after its first.
    #[cold]
    #[inline(never)]
    fn step_on(&self, state: &mut BodyWitness, step: &mut BodyStep) {
        let (mut left, mut switched) = (self.effort.steps, step.switched);
        // Contact needs the answer of an edge's faces: one that the last step has reached is asked as well.
        while left > u8::from(!matches!(state.feature, Feature::Edge(_))) && state.goes_on(step) {
            left -= 1;
            (step.switched, step.outcome, step.length) = (false, Outcome::AtRest, StepLength::Full);
            self.step_once(&Controller::SecondOrder, state, Probe::at(state.probe), 0.0, step);
            switched |= step.switched;
        }
        if switched && !step.switched && step.outcome == Outcome::AtRest {
            step.outcome = Outcome::Moved;
        }
        step.switched = switched;
    }

    /// One step of the tracker: a switch to a neighbouring feature, or one controller step.
    #[inline(always)]
    fn step_once(
        &self,
        controller: &Controller,
        state: &mut BodyWitness,
        probe: Probe,
        period_s: f32,
        step: &mut BodyStep,
    ) {
        let is_curved = controller.is_second_order();
        let mut from = EdgeFace::NONE.face;
        match state.feature {
            Feature::Face(index) => {
                from = index;
                let stays = state.witness.is_free || state.witness.mode == BoundaryMode::Interior;
                if (stays || !self.leave_face(index, state, step))
                    && let Some(face) = self.faces.get(usize::from(index))
                {
                    if is_curved {
                        self.step_curved(face, state, probe.position, step);
                    } else {
                        step.outcome = controller.step(&self.patch(face), &mut state.witness, probe, period_s).outcome;
                        step.evaluations += 1;
                    }
                    return;
                }
            }
            Feature::Vertex(index) => self.leave_vertex(index, state, step),
            Feature::Edge(_) => {}
        }
        // Also an edge that was reached in this tick.
        if let Feature::Edge(index) = state.feature {
            self.tick_on_edge(index, from, is_curved, state, step);
        }
    }

    /// One second-order step on a face. A step that ends at a smooth edge ends on the neighbour.
    #[inline(always)]
    fn step_curved(&self, face: &Face, state: &mut BodyWitness, probe: Vec3, step: &mut BodyStep) {
        let aim = match Aim::in_full(&self.patch(face), &state.witness, probe) {
            Ok(aim) => aim,
            Err(_) if self.has_poles && self.step_near_pole(face, state, step) => {
                return;
            }
            Err(most) => {
                let aim = Aim::in_part(most, &self.patch(face), &state.witness, probe);
                step.length = if aim.gain < 1.0 { StepLength::Cut } else { StepLength::Full };
                if let Some(full) = most
                    && step.length == StepLength::Cut
                    && self.patch(face).is_rational()
                    && !core::mem::take(&mut state.takes_part)
                {
                    return self.try_in_full(face, &full, state, step);
                }
                aim
            }
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
        let reached = self.patch(face).evaluate_curved(u, v);
        step.evaluations += 1;
        step.outcome = aim.settle(&reached, &mut state.witness, probe, self.size);
    }

    /// A full step without a certificate, on a rational face: bounds of a quotient's derivatives over all of it are far
    /// above those on the way. Kept if the distance falls enough (theory §12), otherwise the next step is certified.
    #[inline(never)]
    fn try_in_full(&self, face: &Face, full: &Aim, state: &mut BodyWitness, step: &mut BodyStep) {
        let aim = full.landing_at(full.landing.parameters, MIN_FALL * full.slope);
        step.length = StepLength::Full;
        if aim.beyond != BoundaryMode::Interior
            && self.has_smooth_edges
            && self.step_over_smooth_edge(face, &aim, state, step)
        {
            return;
        }
        let reached = self.patch(face).evaluate_apart(aim.landing.parameters);
        step.evaluations += 1;
        step.outcome = aim.settle(&reached, &mut state.witness, state.probe, self.size);
        state.takes_part = step.outcome == Outcome::Rejected;
        if state.takes_part {
            state.witness.halvings = 0;
        } else {
            state.witness.mode = aim.beyond;
        }
    }

    /// Whether the probe is near that of the last tick; false if it is not finite.
    #[inline]
    fn follows(&self, state: &BodyWitness, probe: Vec3) -> bool {
        (probe - state.probe).length_squared() <= self.jump_squared()
    }

    #[inline]
    pub(super) fn jump_squared(&self) -> f32 {
        let jump = JUMP * self.size;
        jump * jump
    }

    /// Whether the tick belongs to the tracker alone: no audit is needed, or, behind a convex body's surface, it is
    /// the tracker's turn. From behind, the far side holds a witness point as well; there tracker and audit take
    /// turns.
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
        let bounds = self.edge_bounds(edge);
        let half_second = state.witness.second.half_uu;
        let minimiser = if is_curved { along.minimiser(&edge.curve, bounds, half_second, t) } else { Err(None) };
        let next = match minimiser {
            Ok(next) => next,
            Err(Some(next)) if edge.curve.coefficients.tag() != 0 && !core::mem::take(&mut state.takes_part) => {
                return self.try_along_edge(edge, along, next, state);
            }
            Err(_) => along.advanced(bounds[0], t),
        };
        if next == t {
            return Outcome::AtRest;
        }
        let reached = self.on_edge(edge, next);
        if !self.is_no_rise((reached.point - probe).length_squared(), along.squared, reached.point, probe) {
            return Outcome::Rejected;
        }
        state.move_on_edge(next, &reached);
        Outcome::Moved
    }

    /// An uncertified second-order step along a rational edge, on the terms of one on a face (theory §12). A rejected one
    /// is followed by a certified one.
    #[inline(never)]
    fn try_along_edge(&self, edge: &Edge, along: &EdgeStep, next: f32, state: &mut BodyWitness) -> Outcome {
        let (reached, probe) = (self.on_edge(edge, next), state.probe);
        let fall = MIN_FALL * along.gradient * (state.witness.parameters[0] - next);
        let before = along.squared - fall;
        if self.is_no_rise((reached.point - probe).length_squared(), before, reached.point, probe) {
            state.move_on_edge(next, &reached);
            return Outcome::Moved;
        }
        state.takes_part = true;
        Outcome::Rejected
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
    /// Starts the search again; until it ends there is no contact.
    pub(crate) fn forget(&mut self) {
        (self.is_located, self.is_audited, self.seeking) = (false, false, None);
        self.contact = Contact::Behind;
    }

    /// Whether another step would bring the witness point nearer.
    #[inline]
    fn goes_on(&self, step: &BodyStep) -> bool {
        let moves = match self.feature {
            Feature::Face(_) => {
                step.length == StepLength::Cut || !(self.witness.is_free || self.witness.mode == BoundaryMode::Interior)
            }
            // An end of an edge was reached.
            _ => step.outcome == Outcome::Moved && self.witness.mode == BoundaryMode::Corner,
        };
        step.switched || step.outcome == Outcome::Rejected || moves
    }

    #[inline]
    pub(super) fn rest_on_edge(&mut self, index: u16, t: f32, at: &CurvePoint) {
        self.feature = Feature::Edge(index);
        self.witness.parameters[1] = 0.0;
        self.witness.surface.tangent_v = Vec3::ZERO;
        self.witness.is_free = false;
        self.move_on_edge(t, at);
    }

    /// The same of a witness point that is on the edge already.
    #[inline]
    fn move_on_edge(&mut self, t: f32, at: &CurvePoint) {
        self.witness.parameters[0] = t;
        self.witness.surface.point = at.point;
        self.witness.surface.tangent_u = at.tangent;
        self.witness.second.half_uu = at.half_second;
        self.witness.mode = if t <= 0.0 || t >= 1.0 { BoundaryMode::Corner } else { BoundaryMode::LowerV };
        self.witness.halvings = 0;
    }
}
