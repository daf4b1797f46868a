//! Contact at the closest point: normal, signed gap, and whether the body is touched.

use super::feature::{EdgeKind, Face, Feature};
use super::pole::Pole;
use super::table::Body;
use super::tracker::{BodyStep, BodyWitness};
use crate::field::Displacement;
use crate::math::{Vec3, inverse_sqrt, sqrt_from_above};
use crate::patch::Patch as _;
use crate::track::{BoundaryMode, Contact, is_inside};

/// Minimum part of the squared offset along the normal at which a probe counts as right below a point of a border: 30°
/// off, it cannot be in front of a neighbour that bends away, unless it is deeper than six radii of the bend.
const BELOW: f32 = 0.75;

impl<D: Displacement> Body<'_, D> {
    /// Updates normal, signed gap and contact for the probe and the step of the last [`Self::track`]. Changes nothing
    /// until the witness point is located, and for a probe that is not finite.
    #[inline(always)]
    pub fn update_contact(&self, state: &mut BodyWitness, probe: Vec3, step: &BodyStep) {
        if !state.is_located {
            return;
        }
        match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return };
                let at_pole = if self.has_poles { self.normal_at_pole(face, state, probe) } else { None };
                match at_pole.or_else(|| state.witness.normal(&face.patch)) {
                    Some(normal) => self.update_contact_on_face(face, state, probe, normal, step),
                    None => self.keep_normal_on_face(face, state, probe, step),
                }
            }
            Feature::Edge(index) => {
                let Some(edge) = self.edges.get(usize::from(index)) else { return };
                // On the axis of a cone the probe is in the planes of all its edges, and no face takes it in: of smooth
                // edges, or of ones that a fit has left with kinks.
                let is_sunk = || state.no_face_took_probe && self.is_below(edge, state);
                let is_outward = match edge.kind {
                    EdgeKind::Open => None,
                    EdgeKind::Convex => {
                        Some((state.no_face_took_probe || state.gap >= 0.0) && !(self.has_poles && is_sunk()))
                    }
                    EdgeKind::Reflex => Some(false),
                    EdgeKind::Smooth if state.gap >= 0.0 => Some(!is_sunk()),
                    EdgeKind::Smooth => Some(self.is_above_smooth(edge, state)),
                    EdgeKind::Mixed => Some(state.gap >= 0.0 && !(self.has_poles && is_sunk())),
                };
                self.update_contact_at_border(state, is_outward);
            }
            Feature::Vertex(index) => {
                let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
                let towards = probe - self.place(vertex);
                // Before the first face there is no side to stay on.
                let known = || if state.normal == Vec3::ZERO { towards.dot(self.outward(vertex)) } else { state.gap };
                let is_outward = || self.is_outside_at(vertex, towards).unwrap_or_else(|| known() >= 0.0);
                let is_outward = (!vertex.is_open).then(is_outward);
                self.update_contact_at_border(state, is_outward);
            }
        }
    }

    /// The contact on a face, where this is the normal.
    #[inline(always)]
    fn update_contact_on_face(&self, face: &Face, state: &mut BodyWitness, probe: Vec3, normal: Vec3, step: &BodyStep) {
        let away = probe - state.witness.surface.point;
        let gap = away.dot(normal);
        // In front contact does not start: the usual case, without the questions of the other. Nor is a gap that is no
        // number behind.
        let is_behind = gap < 0.0;
        if !is_behind {
            if gap < f32::INFINITY {
                (state.normal, state.gap) = (normal, gap);
                state.contact = if state.is_audited { Contact::InFront } else { Contact::Behind };
            }
            return;
        }
        let contact = state.contact;
        match contact {
            // At a border the probe does not enter at the witness point, unless it is right below it: the neighbour
            // decides in the next tick.
            Contact::InFront if !is_inside(state.witness.parameters) && gap * gap < BELOW * away.length_squared() => {
                return;
            }
            Contact::InFront | Contact::Touching
                if !step.hands_over() && self.releases_at_border(face, state, away) =>
            {
                return;
            }
            _ => {}
        }
        if gap.is_finite() {
            (state.normal, state.gap) = (normal, gap);
            match contact {
                Contact::Behind => {}
                Contact::InFront => self.set_contact(state, away, Contact::Touching),
                Contact::Touching if state.is_audited => {}
                Contact::Touching => state.contact = Contact::Behind,
            }
        }
    }

    /// The same where there is no normal: the last one stays. Apart, so that other ticks do not load it to choose.
    #[cold]
    #[inline(never)]
    fn keep_normal_on_face(&self, face: &Face, state: &mut BodyWitness, probe: Vec3, step: &BodyStep) {
        self.update_contact_on_face(face, state, probe, state.normal, step);
    }

    /// Whether the probe is deeper inside than the minimum radius of curvature of the face that holds the witness
    /// point: the closest point is no longer unique, and no proof covers the tracker (theory §11).
    pub fn is_too_deep(&self, state: &BodyWitness) -> bool {
        let Feature::Face(index) = state.feature else { return false };
        let curvature = |face: &super::feature::Face| self.patch(face).shape().curvature.max;
        self.faces.get(usize::from(index)).is_some_and(|face| -state.gap * curvature(face) > 1.0)
    }

    /// On an edge or a vertex the normal is the direction from the witness point to the probe outside, the opposite
    /// inside. `is_outward` is the side of the probe; `None` over the rim of an open body, which has neither front nor
    /// back.
    ///
    /// If the edge cannot decide, the probe stays on its side: only a face lets it through the surface. A convex edge
    /// reports "outside" once neither of its faces takes the probe: inside, where they meet at less than 180°, each
    /// direction from the edge is within 90° of one of them, and that face takes it. So contact continues while the
    /// witness point crosses the edge, and does not start there.
    #[inline(never)]
    pub(super) fn update_contact_at_border(&self, state: &mut BodyWitness, is_outward: Option<bool>) {
        let away = state.probe - state.witness.surface.point;
        let sign = if is_outward == Some(false) { -1.0 } else { 1.0 };
        let squared = away.length_squared();
        if !squared.is_finite() {
            return;
        }
        state.gap = 0.0;
        if squared > f32::MIN_POSITIVE {
            let inverse = inverse_sqrt(squared);
            state.normal = away * (sign * inverse);
            state.gap = sign * squared * inverse;
        }
        let contact = match is_outward {
            None => Contact::Behind,
            Some(_) => state.contact.next(state.gap, BoundaryMode::Interior),
        };
        self.set_contact(state, away, contact);
    }

    /// The normal at a pole, where the tangent around it is rounding: that of its vertex. The last normal may be from
    /// across the face, because a step may end at a pole from anywhere.
    ///
    /// Beside a tip or above a pit the vertex's normal says "inside" to the wrong probes: where the cone of the
    /// meridians says otherwise, its normal counts.
    #[inline(never)]
    fn normal_at_pole(&self, face: &Face, state: &BodyWitness, probe: Vec3) -> Option<Vec3> {
        let vertex = self.vertices.get(usize::from(self.pole_at(face, state.witness.parameters)?))?;
        let (outward, towards) = (self.outward(vertex), probe - self.place(vertex));
        if outward == Vec3::ZERO {
            return None;
        }
        let cone = self.normal_of_cone(face, state, outward, towards);
        let is_other = |normal: &Vec3| (towards.dot(*normal) < 0.0) != (towards.dot(outward) < 0.0);
        cone.filter(is_other).or(Some(outward))
    }

    /// The normal of the cone of revolution whose axis is a pole's normal, with the slope of the meridian at the witness
    /// point, in the plane of a probe; `towards` leads from the pole to it. `None` on the axis, which is in every plane.
    fn normal_of_cone(&self, face: &Face, state: &BodyWitness, outward: Vec3, towards: Vec3) -> Option<Vec3> {
        let pole = Pole::nearest(face.poles(), state.witness.parameters, &face.patch, self.size)?;
        let meridian = pole.meridian(&state.witness.surface);
        let rise = meridian.dot(outward);
        let [run, beside] = [meridian - outward * rise, towards - outward * towards.dot(outward)];
        let [squared, across] = [meridian, beside].map(Vec3::length_squared);
        if squared.min(across) <= f32::MIN_POSITIVE {
            return None;
        }
        let slope = beside * (rise * inverse_sqrt(across));
        Some((outward * sqrt_from_above(run.length_squared()) - slope) * inverse_sqrt(squared))
    }

    /// Sets the contact. Without an audit the witness point may be on the far side: no contact. A witness point that
    /// the probe has left behind does not start contact: it is located again.
    #[inline]
    fn set_contact(&self, state: &mut BodyWitness, away: Vec3, contact: Contact) {
        let begins = contact == Contact::Touching && state.contact == Contact::InFront;
        if begins && away.length_squared() > self.jump_squared() {
            state.forget();
        } else {
            if begins {
                state.reach = sqrt_from_above(away.length_squared());
            }
            state.contact = if state.is_audited { contact } else { Contact::Behind };
        }
    }
}
