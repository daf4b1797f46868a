//! What the loop asks of the closest point once it is known: normal, signed gap, and whether the body is touched.

use super::feature::{EdgeKind, Feature, Vertex};
use super::switch::BOTH;
use super::table::Body;
use super::tracker::BodyWitness;
use crate::math::{Vec3, inverse_sqrt, sqrt_from_above};
use crate::patch::Patch as _;
use crate::track::{BoundaryMode, Contact};

impl Body {
    /// Normal, signed gap and contact at the witness point, for the probe with which [`Self::track`] has just been
    /// called. Until the witness point is located, and for a probe that is not finite, nothing changes.
    #[inline(always)]
    pub fn meet(&self, state: &mut BodyWitness, probe: Vec3) {
        if !state.is_located {
            return;
        }
        match state.feature {
            Feature::Face(index) => {
                let Some(face) = self.faces.get(usize::from(index)) else { return };
                // At a pole there is none: the last one stands.
                let normal = state.witness.normal(&face.patch).unwrap_or(state.normal);
                let away = probe - state.witness.surface.point;
                let gap = away.dot(normal);
                // Held at a border the witness point is not where the probe goes in: what is beyond it will say.
                let is_held = state.witness.mode != BoundaryMode::Interior;
                let begins_there = gap < 0.0 && is_held && state.contact == Contact::InFront;
                if gap.is_finite() && !begins_there {
                    (state.normal, state.gap) = (normal, gap);
                    self.touch(state, away, state.contact.next(gap, BoundaryMode::Interior));
                }
            }
            Feature::Edge(index) => {
                let kind = self.edges.get(usize::from(index)).map_or(EdgeKind::Mixed, |edge| edge.kind);
                self.meet_border(state, probe, kind, None);
            }
            Feature::Vertex(index) => {
                let Some(vertex) = self.vertices.get(usize::from(index)) else { return };
                let is_outside = self.is_outside_at(vertex, probe - vertex.point);
                self.meet_border(
                    state,
                    probe,
                    if vertex.is_open { EdgeKind::Open } else { EdgeKind::Mixed },
                    is_outside,
                );
            }
        }
    }

    /// Whether the probe is deeper inside than the least radius of curvature of the face that holds the witness point:
    /// the closest point is no longer unique, and the witness point is not proved to follow (theory §11).
    pub fn is_too_deep(&self, state: &BodyWitness) -> bool {
        let Feature::Face(index) = state.feature else { return false };
        let curvature = |face: &super::feature::Face| face.patch.shape().curvature.max;
        self.faces.get(usize::from(index)).is_some_and(|face| -state.gap * curvature(face) > 1.0)
    }

    /// On an edge or a vertex: normal and gap from the witness point towards the probe outside, the other way inside.
    /// Where the edge does not say which side the probe is on it is where it was: nothing goes through the surface
    /// without a face. A convex edge says "outside" once neither of its faces has taken the probe: inside, where they
    /// meet at less than 180°, each direction from the edge is within 90° of one of them, and that one takes it. So
    /// contact holds where the witness point crosses the edge, and does not begin there. `is_outside` is what a vertex
    /// says.
    #[inline(never)]
    fn meet_border(&self, state: &mut BodyWitness, probe: Vec3, kind: EdgeKind, is_outside: Option<bool>) {
        let away = probe - state.witness.surface.point;
        let outward = match kind {
            EdgeKind::Open => true,
            EdgeKind::Convex => state.declined == BOTH || state.gap >= 0.0,
            EdgeKind::Reflex => false,
            EdgeKind::Smooth | EdgeKind::Mixed => is_outside.unwrap_or(state.gap >= 0.0),
        };
        let sign = if outward { 1.0 } else { -1.0 };
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
        // Over the rim of an open body there is neither front nor back.
        let contact = match kind {
            EdgeKind::Open => Contact::Behind,
            _ => state.contact.next(state.gap, BoundaryMode::Interior),
        };
        self.touch(state, away, contact);
    }

    /// On which side of a closed body a probe is that a vertex holds, if it does: no edge leads nearer from there.
    /// `None` if not, or if the vertex does not say.
    fn is_outside_at(&self, vertex: &Vertex, towards: Vec3) -> Option<bool> {
        let height = towards.dot(vertex.outward);
        let first = usize::from(vertex.first_spoke);
        let spokes = self.spokes.get(first..first + usize::from(vertex.spokes)).unwrap_or(&[]);
        let holds = spokes.iter().all(|spoke| towards.dot(spoke.direction) <= 0.0);
        if holds && height != 0.0 { Some(height > 0.0) } else { None }
    }

    /// Nothing is met with a witness point that may be on the far side, and no contact begins with one that the probe
    /// has left behind: that one is located anew.
    #[inline]
    fn touch(&self, state: &mut BodyWitness, away: Vec3, contact: Contact) {
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
