//! Out over a border: what a face has behind may be in front of the face beyond a sharp edge, and the tick that comes
//! to the edge is not to be felt.

use super::feature::{EdgeKind, Face, Separator, Side};
use super::table::Body;
use super::tracker::BodyWitness;
use crate::math::Vec3;
use crate::patch::{Patch as _, SplinePatch};
use crate::track::{BoundaryMode, Witness};

/// A face whose bound says that it is hollower than this, 1/m, is; below it is the rounding of a plane's bound.
const HOLLOW: f32 = 1.0e-6;

impl Body {
    /// Ends contact where the probe is in front of what is beyond the border that the witness point lies on: then it
    /// has left the body over an edge or a vertex, though this face has it behind. Whether it has.
    #[inline(always)]
    pub(super) fn leaves_over_border(&self, face: &Face, state: &mut BodyWitness) -> bool {
        match state.witness.mode {
            BoundaryMode::LowerU => self.leaves_over_side(face, 0, state),
            BoundaryMode::UpperU => self.leaves_over_side(face, 1, state),
            BoundaryMode::LowerV => self.leaves_over_side(face, 2, state),
            BoundaryMode::UpperV => self.leaves_over_side(face, 3, state),
            BoundaryMode::Corner | BoundaryMode::Interior => self.has_poles && self.leaves_over_any(face, state),
        }
    }

    /// The same over any of the borders that the witness point lies on: beside a pole a step may end at one that does
    /// not hold it.
    #[inline(never)]
    fn leaves_over_any(&self, face: &Face, state: &mut BodyWitness) -> bool {
        let [u, v] = state.witness.parameters;
        let ways = [u, 1.0 - u, v, 1.0 - v];
        (0..4).any(|number| ways[number] <= 0.0 && self.leaves_over_side(face, number, state))
    }

    #[inline(never)]
    fn leaves_over_side(&self, face: &Face, number: usize, state: &mut BodyWitness) -> bool {
        let is_over = self.is_over_side(face, number, &state.witness, state.probe);
        if is_over {
            let probe = state.probe;
            self.meet_border(state, probe, Some(true));
        }
        is_over
    }

    /// Whether the probe is in front of what is beyond one side. Over a convex edge by the normal `t × m` of the face
    /// beyond: this face lies behind that one.
    #[inline(always)]
    fn is_over_side(&self, face: &Face, number: usize, witness: &Witness, probe: Vec3) -> bool {
        let away = probe - witness.surface.point;
        let (index, is_reversed) = match face.sides.get(number) {
            Some(Side::Edge { edge, reversed, .. }) => (*edge, *reversed),
            Some(Side::Pole { vertex }) => {
                let vertex = self.vertices.get(usize::from(*vertex));
                return vertex.is_some_and(|vertex| self.is_outside_at(vertex, away) == Some(true));
            }
            None => return false,
        };
        let Some(edge) = self.edges.get(usize::from(index)) else { return false };
        if edge.kind != EdgeKind::Convex {
            return false;
        }
        let of = self.beyond_side(edge, face, number);
        let Some(beyond) = self.faces.get(usize::from(of.face)) else { return false };
        let (surface, [u, v]) = (&witness.surface, witness.parameters);
        let (along, tangent, across) = if number < 2 {
            (v, surface.tangent_v, surface.tangent_u)
        } else {
            (u, surface.tangent_u, surface.tangent_v)
        };
        // A derivative of the face beyond across the side, of any sign and length.
        let cross = match beyond.sides.get(usize::from(of.side)) {
            Some(Side::Edge { separator: Separator::Plane { across, .. }, .. }) => *across,
            Some(Side::Edge { separator: Separator::Ruled(cross), .. }) => {
                cross.point(if is_reversed { 1.0 - along } else { along })
            }
            _ => return false,
        };
        let inward = if number & 1 == 0 { across } else { -across };
        let normal = tangent.cross(cross);
        let height = normal.dot(away);
        height * normal.dot(inward) < 0.0 && !may_be_below(&beyond.patch, height, normal, away)
    }
}

/// Whether a face that is hollow may come as far in front of its tangent plane as the probe is: within a radius of
/// curvature `1/κ` it comes no farther than `κ` times the square of the way. At a pole nothing is known of `κ`, and the
/// plane is asked.
#[inline(always)]
fn may_be_below(patch: &SplinePatch, height: f32, normal: Vec3, away: Vec3) -> bool {
    let least = patch.shape().curvature.min;
    least < -HOLLOW && least > f32::NEG_INFINITY && {
        let bulge = least * away.length_squared();
        height * height <= bulge * bulge * normal.length_squared()
    }
}
