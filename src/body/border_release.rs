//! Release of contact over a border: a probe behind a face may be in front of the next face beyond a sharp edge.
//! Contact ends in the tick that reaches the edge, without a force pulse.

use super::deformed::Cross;
use super::feature::{Edge, EdgeKind, Face, Side};
use super::table::Body;
use super::tracker::BodyWitness;
use crate::field::{Displaced, Displacement};
use crate::math::{Vec3, vec3};
use crate::patch::{Patch as _, SecondDerivativeBounds};
use crate::track::BoundaryMode;

/// Distance from a border, in parameters, below which the neighbour is asked: the witness point may still be on its
/// way to the border that the probe has passed.
const AT_BORDER: f32 = 1.0 / 512.0;

/// Whether a parameter is farther than that from both ends. One comparison of bits, which rise with a positive number.
#[inline(always)]
fn is_apart(x: f32) -> bool {
    const LEAST: u32 = AT_BORDER.to_bits();
    x.to_bits().wrapping_sub(LEAST) < (1.0 - AT_BORDER).to_bits() - LEAST
}

/// The end of its range that a parameter is near to, 0 or 1, again by the bits.
#[inline(always)]
const fn is_upper(x: f32) -> usize {
    (x.to_bits().cast_signed() > 0.5_f32.to_bits().cast_signed()) as usize
}

/// Boundary mode of a witness point on each side.
const SIDES: [BoundaryMode; 4] =
    [BoundaryMode::LowerU, BoundaryMode::UpperU, BoundaryMode::LowerV, BoundaryMode::UpperV];

/// Distance from the end of an edge, in parameters, below which the vertex is asked.
const AT_END: f32 = 1.0 / 16.0;

/// Curvature, 1/m, below which a face counts as hollow: smaller values are the rounding of a plane's bound.
pub(super) const HOLLOW: f32 = 1.0e-6;

/// Ratio of the squared weights of a rational patch along a border: 2 on a quarter of a circle, with a margin of 2.
const WEIGHTS: f32 = 4.0;

impl<D: Displacement> Body<'_, D> {
    /// Ends contact if the probe is in front of the neighbour beyond the nearest border: the probe has then left the
    /// body over an edge or a vertex, though it is behind this face. Returns whether contact ended.
    #[inline(always)]
    pub(super) fn releases_at_border(&self, face: &Face, state: &mut BodyWitness, away: Vec3) -> bool {
        let [u, v] = state.witness.parameters;
        let Vec3 { x, y, z } = away;
        if is_apart(u) {
            !is_apart(v) && self.releases_at_side(face, 2 + is_upper(v), state, x, y, z)
        } else if is_apart(v) {
            self.releases_at_side(face, is_upper(u), state, x, y, z)
        } else {
            self.releases_at_corner(face, state, x, y, z)
        }
    }

    /// The same near a corner: by the planes between three convex edges, otherwise over either side.
    #[inline(never)]
    fn releases_at_corner(&self, face: &Face, state: &mut BodyWitness, x: f32, y: f32, z: f32) -> bool {
        let (probe, [u, v]) = (state.probe, state.witness.parameters);
        let sides = [is_upper(u), 2 + is_upper(v)];
        let vertex = match face.sides.get(sides[0]) {
            Some(Side::Pole { vertex }) => Some(*vertex),
            Some(Side::Edge { edge, reversed, .. }) => {
                self.edges.get(usize::from(*edge)).map(|edge| edge.ends[is_upper(v) ^ usize::from(*reversed)])
            }
            None => None,
        };
        let vertex = vertex.and_then(|vertex| self.vertices.get(usize::from(vertex)));
        match vertex.and_then(|vertex| self.is_in_front_at(vertex, probe - self.place(vertex))) {
            Some(is_over) => {
                if is_over {
                    self.update_contact_at_border(state, Some(true));
                }
                is_over
            }
            None => sides.into_iter().any(|number| self.releases_at_side(face, number, state, x, y, z)),
        }
    }

    /// The offset of the probe as scalars, so that the tick that does not ask keeps it in registers.
    #[inline(never)]
    fn releases_at_side(&self, face: &Face, number: usize, state: &mut BodyWitness, x: f32, y: f32, z: f32) -> bool {
        let is_over = self.is_in_front_of_neighbour(face, number, state, vec3(x, y, z));
        if is_over {
            self.update_contact_at_border(state, Some(true));
            // The neighbour is nearer: the tracker looks for it only from the border.
            if self.kind_of_side(face, number) == Some(EdgeKind::Convex) {
                (state.witness.mode, state.witness.is_free) = (SIDES[number & 3], false);
            }
        }
        is_over
    }

    /// Whether the probe is in front of the neighbour beyond one side. Over a convex edge the normal `t × m` of the
    /// neighbour decides: this face, and with it the witness point, is behind the neighbour by its distance from the
    /// border.
    ///
    /// Over a smooth edge the same surface continues. But if the neighbour is a sliver that ends at a vertex, the next
    /// feature starts there.
    #[inline(always)]
    fn is_in_front_of_neighbour(&self, face: &Face, number: usize, state: &BodyWitness, away: Vec3) -> bool {
        let witness = &state.witness;
        let (index, is_reversed) = match face.sides.get(number) {
            Some(Side::Edge { edge, reversed, .. }) => (*edge, *reversed),
            Some(Side::Pole { vertex }) => {
                let Some(vertex) = self.vertices.get(usize::from(*vertex)) else { return false };
                return self.is_outside_at(vertex, state.probe - self.place(vertex)) == Some(true);
            }
            None => return false,
        };
        let Some(edge) = self.edges.get(usize::from(index)) else { return false };
        let (surface, [u, v]) = (&witness.surface, witness.parameters);
        let (along, tangent, across, from_lower) = if number < 2 {
            (v, &surface.tangent_v, &surface.tangent_u, u)
        } else {
            (u, &surface.tangent_u, &surface.tangent_v, v)
        };
        let is_lower = number & 1 == 0;
        let t = || if is_reversed { 1.0 - along } else { along };
        match edge.kind {
            EdgeKind::Convex => {}
            EdgeKind::Smooth => {
                return is_lower == (away.dot(*across) < 0.0) && self.is_past_end(edge, t(), state.probe);
            }
            EdgeKind::Reflex | EdgeKind::Mixed | EdgeKind::Open => return false,
        }
        let of = edge.neighbour_of_side(state.feature, number);
        let Some(beyond) = self.faces.get(usize::from(of.face)) else { return false };
        // Derivative of the neighbour across the side, of any sign and length; for a plane, its inverse.
        let mut is_plane = true;
        let cross = match beyond.sides.get(usize::from(of.side)) {
            Some(Side::Edge { separator, .. }) => match self.cross(edge, separator, t()) {
                Cross::Plane { across, .. } => across,
                Cross::Ruled(cross) => {
                    is_plane = false;
                    cross
                }
            },
            _ => return false,
        };
        let normal = tangent.cross(cross);
        // At a lower border `across` points into this face, at an upper one out of it; the height is taken at the
        // border.
        let (rise, to_border) = (normal.dot(*across), if is_lower { from_lower } else { from_lower - 1.0 });
        let height = normal.dot(away) + to_border * rise;
        let is_in_front = if is_lower { height * rise < 0.0 } else { height * rise > 0.0 };
        is_in_front && {
            let length = normal.length_squared();
            let most = bulge(self.patch(beyond), of.side < 2, &Rim { tangent: *tangent, cross, is_plane, along }, away);
            height * height > most * most * length
        }
    }

    /// Whether the probe is in front of the faces that meet at the nearest end of a smooth edge. `t` is near that end.
    #[inline(never)]
    fn is_past_end(&self, edge: &Edge, t: f32, probe: Vec3) -> bool {
        let (end, from_end) = if t > 0.5 { (1, 1.0 - t) } else { (0, t) };
        let Some(vertex) = self.vertices.get(usize::from(edge.ends[end])) else { return false };
        from_end <= AT_END && self.is_in_front_at(vertex, probe - self.place(vertex)) == Some(true)
    }
}

/// The border of a face: its tangent, the derivative of the face across it (metres per unit; for a plane's separator,
/// the inverse), and the parameter along the border.
pub(super) struct Rim {
    pub tangent: Vec3,
    pub cross: Vec3,
    pub is_plane: bool,
    pub along: f32,
}

/// Upper bound of how far a hollow face comes in front of its tangent plane at a point of its border, metres, at the
/// offset `away`. 0 if the face is not hollow, and at a pole, where the curvature has no bound.
///
/// Within a radius of curvature `1/κ` the face stays below `κ` times the squared offset. To second order, the bounds
/// of the second derivatives limit it too, for the change of parameters that leads there. Beyond the end of the border
/// another face decides.
#[inline(always)]
pub(super) fn bulge<D: Displacement>(patch: Displaced<'_, D>, is_across_u: bool, rim: &Rim, away: Vec3) -> f32 {
    let shape = patch.shape();
    let least = shape.curvature.min;
    if !(least < -HOLLOW && least > f32::NEG_INFINITY) {
        return 0.0;
    }
    let by_curvature = -least * away.length_squared();
    let Rim { tangent, cross, is_plane, along } = rim;
    let cross = if *is_plane { *cross * (1.0 / cross.length_squared()) } else { *cross };
    let (stretch, skew, reach) = (tangent.length_squared(), tangent.dot(cross), cross.length_squared());
    let (forward, out) = (away.dot(*tangent), away.dot(cross));
    let inverse = 1.0 / (stretch * reach - skew * skew);
    let is_past_end = if forward > 0.0 { *along >= 1.0 } else { *along <= 0.0 };
    // The derivative of a rational patch is known up to the square of its weights.
    let unit = if patch.is_rational() { WEIGHTS * inverse } else { inverse };
    let across = (out * stretch - forward * skew) * unit;
    let beside = if is_past_end { 0.0 } else { (forward * reach - out * skew) * inverse };
    let SecondDerivativeBounds { uu, uv, vv } = shape.second_derivatives;
    let (bend_across, bend_along) = if is_across_u { (uu, vv) } else { (vv, uu) };
    let by_derivatives =
        0.5 * (bend_across * across * across + bend_along * beside * beside) + uv * (across * beside).abs();
    if by_derivatives < by_curvature { by_derivatives } else { by_curvature }
}
