//! Out over a border: what a face has behind may be in front of the face beyond a sharp edge, and the tick that comes
//! to the edge is not to be felt.

use super::feature::{EdgeKind, Face, Separator, Side};
use super::table::Body;
use super::tracker::BodyWitness;
use crate::math::Vec3;
use crate::patch::{Patch as _, SecondDerivativeBounds, SplinePatch};
use crate::track::BoundaryMode;

/// So near a border, in parameters, a witness point lies on it: it may still be on its way there.
const AT_BORDER: f32 = 1.0e-4;

/// Whether a parameter is farther than that from both ends: one comparison of bits, which rise with a positive number.
#[inline(always)]
fn is_apart(x: f32) -> bool {
    const LEAST: u32 = AT_BORDER.to_bits();
    x.to_bits().wrapping_sub(LEAST) < (1.0 - AT_BORDER).to_bits() - LEAST
}

/// A face whose bound says that it is hollower than this, 1/m, is; below it is the rounding of a plane's bound.
const HOLLOW: f32 = 1.0e-6;

/// What a rational patch's weights, squared, may differ by along a border: they do by 2 on a quarter of a circle.
const WEIGHTS: f32 = 4.0;

impl Body<'_> {
    /// Ends contact where the probe is in front of what is beyond the border that the witness point lies on: then it
    /// has left the body over an edge or a vertex, though this face has it behind. Whether it has.
    #[inline(always)]
    pub(super) fn leaves_over_border(&self, face: &Face, state: &mut BodyWitness) -> bool {
        match state.witness.mode {
            BoundaryMode::LowerU => self.leaves_over_side(face, 0, state),
            BoundaryMode::UpperU => self.leaves_over_side(face, 1, state),
            BoundaryMode::LowerV => self.leaves_over_side(face, 2, state),
            BoundaryMode::UpperV => self.leaves_over_side(face, 3, state),
            BoundaryMode::Corner => self.leaves_over_corner(face, state),
            BoundaryMode::Interior => {
                let [u, v] = state.witness.parameters;
                !(is_apart(u) && is_apart(v)) && self.leaves_over_any(face, state)
            }
        }
    }

    /// The same over any of the borders that the witness point lies on, though none holds it.
    #[inline(never)]
    fn leaves_over_any(&self, face: &Face, state: &mut BodyWitness) -> bool {
        let [u, v] = state.witness.parameters;
        let ways = [u, 1.0 - u, v, 1.0 - v];
        (0..4).any(|number| ways[number] <= AT_BORDER && self.leaves_over_side(face, number, state))
    }

    /// The same at a corner: by the planes between three convex edges, else over either side.
    #[inline(never)]
    fn leaves_over_corner(&self, face: &Face, state: &mut BodyWitness) -> bool {
        let (probe, [u, v]) = (state.probe, state.witness.parameters);
        let sides = [usize::from(u > 0.5), 2 + usize::from(v > 0.5)];
        let vertex = match face.sides.get(sides[0]) {
            Some(Side::Pole { vertex }) => Some(*vertex),
            Some(Side::Edge { edge, reversed, .. }) => {
                self.edges.get(usize::from(*edge)).map(|edge| edge.ends[usize::from((v > 0.5) != *reversed)])
            }
            None => None,
        };
        let vertex = vertex.and_then(|vertex| self.vertices.get(usize::from(vertex)));
        match vertex.and_then(|vertex| self.is_in_front_at(vertex, probe - vertex.point)) {
            Some(false) => false,
            Some(true) => {
                self.meet_border(state, probe, Some(true));
                true
            }
            None => sides.into_iter().any(|number| self.leaves_over_side(face, number, state)),
        }
    }

    #[inline(never)]
    fn leaves_over_side(&self, face: &Face, number: usize, state: &mut BodyWitness) -> bool {
        let is_over = self.is_over_side(face, number, state);
        if is_over {
            let probe = state.probe;
            self.meet_border(state, probe, Some(true));
        }
        is_over
    }

    /// Whether the probe is in front of what is beyond one side. Over a convex edge by the normal `t × m` of the face
    /// beyond: this face lies behind that one.
    #[inline(always)]
    fn is_over_side(&self, face: &Face, number: usize, state: &BodyWitness) -> bool {
        let witness = &state.witness;
        let away = state.probe - witness.surface.point;
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
        let of = Self::beyond_side(edge, state.feature, number);
        let Some(beyond) = self.faces.get(usize::from(of.face)) else { return false };
        let (surface, [u, v]) = (&witness.surface, witness.parameters);
        let (along, tangent, across) = if number < 2 {
            (v, surface.tangent_v, surface.tangent_u)
        } else {
            (u, surface.tangent_u, surface.tangent_v)
        };
        // A derivative of the face beyond across the side, of any sign and length; of a plane its inverse.
        let mut is_plane = true;
        let cross = match beyond.sides.get(usize::from(of.side)) {
            Some(Side::Edge { separator: Separator::Plane { across, .. }, .. }) => *across,
            Some(Side::Edge { separator: Separator::Ruled(cross), .. }) => {
                is_plane = false;
                cross.point(if is_reversed { 1.0 - along } else { along })
            }
            _ => return false,
        };
        let normal = tangent.cross(cross);
        let height = normal.dot(away);
        // `across` points into this face at a lower border, out of it at an upper one.
        let product = height * normal.dot(across);
        let is_in_front = if number & 1 == 0 { product < 0.0 } else { product > 0.0 };
        is_in_front && {
            let length = normal.length_squared();
            let cross = if is_plane { cross * (1.0 / cross.length_squared()) } else { cross };
            let most = bulge(&beyond.patch, of.side < 2, &Rim { tangent, cross, along }, away);
            height * height > most * most * length
        }
    }
}

/// Where a face meets a border: the border's tangent and the derivative of the face across it, metres per unit, and the
/// parameter along the border.
struct Rim {
    tangent: Vec3,
    cross: Vec3,
    along: f32,
}

/// How far a face that is hollow may come in front of its tangent plane at a point of its border, metres, where a
/// way from there leads: 0 of one that is not, and at a pole, where nothing is known.
///
/// Within a radius of curvature `1/κ` it comes no farther than `κ` times the way squared. Nor, to second order, than
/// the bounds of the second derivatives let it for the change of parameters that leads there. Past the border's end it
/// is for another face to say.
#[inline(always)]
fn bulge(patch: &SplinePatch, is_across_u: bool, rim: &Rim, away: Vec3) -> f32 {
    let shape = patch.shape();
    let least = shape.curvature.min;
    if !(least < -HOLLOW && least > f32::NEG_INFINITY) {
        return 0.0;
    }
    let by_curvature = -least * away.length_squared();
    let Rim { tangent, cross, along } = rim;
    let (stretch, skew, reach) = (tangent.length_squared(), tangent.dot(*cross), cross.length_squared());
    let (forward, out) = (away.dot(*tangent), away.dot(*cross));
    let inverse = 1.0 / (stretch * reach - skew * skew);
    let is_past_end = if forward > 0.0 { *along >= 1.0 } else { *along <= 0.0 };
    // Of a rational patch the derivative is known but for the square of its weights.
    let unit = if patch.is_rational() { WEIGHTS * inverse } else { inverse };
    let across = (out * stretch - forward * skew) * unit;
    let beside = if is_past_end { 0.0 } else { (forward * reach - out * skew) * inverse };
    let SecondDerivativeBounds { uu, uv, vv } = shape.second_derivatives;
    let (bend_across, bend_along) = if is_across_u { (uu, vv) } else { (vv, uu) };
    let by_derivatives =
        0.5 * (bend_across * across * across + bend_along * beside * beside) + uv * (across * beside).abs();
    if by_derivatives < by_curvature { by_derivatives } else { by_curvature }
}
