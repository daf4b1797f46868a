//! Entry of a face over one of its sides: not at the border, but at the predicted closest point, so that the handover
//! costs no extra tick.
//!
//! The one evaluation of the tick is at that point, and decides whether it is nearer by the margin that theory §12
//! asks of every step. If not, the step is rejected, and the next one enters at the border, where the distance is
//! unchanged.

use super::edge_step::{BorderSide, EdgeStep, MIN_STRETCH};
use super::feature::{Edge, EdgeFace, EdgeKind, Face, Feature, Side};
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::field::{Displaced, Displacement};
use crate::math::Vec3;
use crate::patch::Patch as _;
use crate::track::{Aim, BoundaryMode, Outcome, mode_at};

/// Minimum fall of `½ ‖ΔR‖²` for a step without a certificate, relative to its prediction.
pub(super) const MIN_FALL: f32 = 1.0 / 16.0;

/// A point of an edge with its offset from the probe.
#[derive(Clone, Copy)]
pub(super) struct EdgePoint {
    /// The start of a step along the edge.
    pub along: EdgeStep,
    /// The edge's tangent, metres per unit of its parameter.
    pub tangent: Vec3,
    /// The edge's parameter.
    pub t: f32,
}

/// The point at which a face is entered.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    /// Index of the face.
    pub face: u16,
    /// `(u, v)` on it.
    pub parameters: [f32; 2],
    /// Minimum fall of `‖ΔR‖²`, m².
    pub fall: f32,
}

/// The face beyond a border, at a point of it.
#[derive(Clone, Copy)]
pub(super) struct Neighbour<'a, D> {
    patch: Displaced<'a, D>,
    of: EdgeFace,
    /// 1 if the side runs against the edge. A word: a byte here is copied together with the words behind it, one by one.
    is_reversed: u32,
    inward: BorderSide,
}

impl<D: Displacement> Neighbour<'_, D> {
    /// The entry of the face. `hessian` is the second derivative of `½ ‖ΔR‖²` along the edge, m²; `known` is the
    /// curvature to use if the face has no bound, 1/m.
    #[inline(always)]
    pub(super) fn entry(
        &self,
        border: &EdgePoint,
        hessian: f32,
        is_curved: bool,
        state: &BodyWitness,
        known: f32,
    ) -> Entry {
        let Self { patch, of, is_reversed, inward } = self;
        let ([inside, t], fall) = if is_curved && state.witness.halvings == 0 {
            entry_landing(*patch, inward, &border.along, [border.t, hessian], [state.gap, known])
        } else {
            ([0.0, border.t], 0.0)
        };
        Entry { face: of.face, parameters: on_side(of.side, *is_reversed != 0, inside, t), fall }
    }
}

impl<D: Displacement> Body<'_, D> {
    /// A face of an edge, relative to a point of that edge: if its region holds the probe, or `anyway`.
    #[inline(always)]
    pub(super) fn neighbour(
        &self,
        edge: &Edge,
        of: EdgeFace,
        border: &EdgePoint,
        probe: Vec3,
        anyway: bool,
    ) -> Option<Neighbour<'_, D>> {
        let face = self.faces.get(usize::from(of.face))?;
        let Some(Side::Edge { separator, reversed, .. }) = face.sides.get(usize::from(of.side)) else { return None };
        let cross = self.cross(edge, separator, border.t);
        let product = border.along.product(&cross, border.tangent, probe);
        if product < 0.0 && !anyway {
            return None;
        }
        let inward = border.along.inward(&cross, border.tangent, product);
        Some(Neighbour { patch: self.patch(face), of, is_reversed: u32::from(*reversed), inward })
    }

    /// A face of an edge, and the parameters there of a point of the edge.
    #[inline(never)]
    pub(crate) fn position_on_face(&self, of: EdgeFace, t: f32) -> Option<(u16, [f32; 2])> {
        match self.faces.get(usize::from(of.face))?.sides.get(usize::from(of.side))? {
            Side::Edge { reversed, .. } => Some((of.face, on_side(of.side, *reversed, 0.0, t))),
            Side::Pole { .. } => None,
        }
    }

    /// Moves the witness point to the entry of a face, if that is near enough. One evaluation.
    #[inline(never)]
    pub(super) fn enter_face(&self, entry: &Entry, is_curved: bool, state: &mut BodyWitness, step: &mut BodyStep) {
        let Some(face) = self.faces.get(usize::from(entry.face)) else { return };
        step.evaluations += 1;
        if is_curved {
            let reached = self.patch(face).evaluate_apart(entry.parameters);
            let before = (state.witness.surface.point - state.probe).length_squared();
            let is_nearer = (reached.surface.point - state.probe).length_squared() <= before - entry.fall;
            // At the border the distance is unchanged.
            if entry.fall > 0.0 && !is_nearer {
                state.witness.halvings = 1;
                step.outcome = Outcome::Rejected;
                return;
            }
            state.witness.rest_at(entry.parameters, &reached);
        } else {
            state.witness.set_down(&self.patch(face), entry.parameters, false);
        }
        (state.feature, step.switched) = (Feature::Face(entry.face), true);
    }

    /// A second-order step that ends at a smooth edge, taken on the neighbour. A rejected step leaves the witness
    /// point on its own face: over a seam with a gap the distance may rise. Returns whether the side is a smooth edge.
    #[inline(never)]
    pub(super) fn step_over_smooth_edge(
        &self,
        face: &Face,
        aim: &Aim,
        state: &mut BodyWitness,
        step: &mut BodyStep,
    ) -> bool {
        let Some((entry, side)) = self.entry_over_smooth_edge(face, aim, state) else { return false };
        let Some(other) = self.faces.get(usize::from(entry.face)) else { return false };
        let reached = self.patch(other).evaluate_apart(entry.parameters);
        step.evaluations += 1;
        let probe = state.probe;
        step.outcome =
            aim.landing_at(entry.parameters, entry.fall).settle(&reached, &mut state.witness, probe, self.size);
        state.witness.mode = aim.mode;
        if step.outcome != Outcome::Rejected {
            // A border that cuts the step holds the witness point.
            let [u, v] = entry.parameters;
            let is_cut = |along: f32| along <= 0.0 || along >= 1.0;
            let held = if side < 2 { [false, is_cut(v)] } else { [is_cut(u), false] };
            (state.feature, state.witness.mode, step.switched) =
                (Feature::Face(entry.face), mode_at(entry.parameters, held), true);
        }
        true
    }

    /// Entry of the neighbour for a second-order step that ends at a smooth edge, and the neighbour's side.
    #[inline]
    fn entry_over_smooth_edge(&self, face: &Face, aim: &Aim, state: &BodyWitness) -> Option<(Entry, u8)> {
        let ([u, v], witness) = (aim.landing.parameters, &state.witness);
        let (number, along, is_along_v) = match aim.beyond {
            BoundaryMode::LowerU => (0, v, true),
            BoundaryMode::UpperU => (1, v, true),
            BoundaryMode::LowerV => (2, u, false),
            BoundaryMode::UpperV => (3, u, false),
            BoundaryMode::Corner => {
                let [first, second] = [usize::from(u > 0.5), 2 + usize::from(v > 0.5)];
                let is_first = self.kind_of_side(face, first) == Some(EdgeKind::Smooth);
                if is_first { (first, v, true) } else { (second, u, false) }
            }
            BoundaryMode::Interior => return None,
        };
        let Side::Edge { edge: index, reversed, .. } = face.sides.get(number)? else { return None };
        let edge = self.edges.get(usize::from(*index))?;
        if edge.kind != EdgeKind::Smooth {
            return None;
        }
        let other = edge.neighbour_of_side(state.feature, number);
        let t = if *reversed { 1.0 - along } else { along };
        // The border by the Taylor expansion at the witness point.
        let step = [u - witness.parameters[0], v - witness.parameters[1]];
        let point = witness.surface.point + witness.surface.along(step) + witness.second.bend(step) * 0.5;
        let (surface, second) = (&witness.surface, &witness.second);
        let (tangent, half_second) =
            if is_along_v { (surface.tangent_v, second.half_vv) } else { (surface.tangent_u, second.half_uu) };
        let tangent = if *reversed { -tangent } else { tangent };
        let border = EdgePoint { along: EdgeStep::new(point, tangent, state.probe), tangent, t };
        let beyond = self.neighbour(edge, other, &border, state.probe, true)?;
        let hessian = border.along.hessian(half_second);
        let entry = beyond.entry(&border, hessian, true, state, bend(self.patch(face), state.gap));
        Some((entry, other.side))
    }
}

/// Predicted closest point of a face, from its border, for a probe with a gap: the parameter across, that of the edge,
/// and the minimum fall of `‖ΔR‖²`, m².
///
/// Across the border this is the Gauss–Newton step, shortened by curvature: with the normal curvature `κ` the probe's
/// offset `ρ` spans the angle `ρ / (1 + κ gap)`, by the maximum `κ` in front, by the minimum behind. Without a bound,
/// the curvature `known` of the face before is the estimate; without that, the entry is at the border.
#[inline(never)]
fn entry_landing<D: Displacement>(
    patch: Displaced<'_, D>,
    inward: &BorderSide,
    along: &EdgeStep,
    [t, hessian]: [f32; 2],
    [gap, known]: [f32; 2],
) -> ([f32; 2], f32) {
    let bound = bend(patch, gap);
    let stretch = 1.0 + if bound.is_finite() { bound } else { known } * gap;
    let stretch = if stretch > MIN_STRETCH { stretch } else { f32::INFINITY };
    let (landing, slope) = inward.landing(along, hessian, t, stretch);
    (landing, 2.0 * MIN_FALL * slope)
}

/// Bound of the normal curvature that shortens steps on this side of the surface, 1/m.
#[inline]
fn bend<D: Displacement>(patch: Displaced<'_, D>, gap: f32) -> f32 {
    let curvature = &patch.shape().curvature;
    if gap > 0.0 { curvature.max } else { curvature.min }
}

/// The parameters of a face at the distance `inside` from one of its sides, at the edge's parameter `t`.
#[inline]
fn on_side(number: u8, is_reversed: bool, inside: f32, t: f32) -> [f32; 2] {
    let along = if is_reversed { 1.0 - t } else { t };
    match number {
        0 => [inside, along],
        1 => [1.0 - inside, along],
        2 => [along, inside],
        _ => [along, 1.0 - inside],
    }
}
