//! Inside or outside a closed body, by the faces that meet at an edge or a vertex.

use super::border_release::{HOLLOW, Rim, bulge};
use super::deformed::Cross;
use super::feature::{Edge, EdgeFace, EdgeKind, Face, Side, Spoke, Vertex};
use super::table::Body;
use super::tracker::BodyWitness;
use crate::field::Displacement;
use crate::math::Vec3;
use crate::patch::Patch as _;
use crate::tally;

/// Minimum height over the tangent plane, relative to the distance, at which a probe is outside where smooth edges and
/// hollow faces meet: a body comes that far in front of it at a fifth of its minimum hollow radius.
const STEEP: f32 = 0.1;
/// The same without hollow faces: the rounding of coordinates for a probe at a distance of 10⁻⁵ sizes.
const LEVEL: f32 = 0.01;

impl<D: Displacement> Body<'_, D> {
    /// Whether a probe is well above the surface on both sides of a smooth edge, by the tangent plane at the witness
    /// point.
    #[inline(never)]
    pub(super) fn is_above_smooth(&self, edge: &Edge, state: &BodyWitness) -> bool {
        let Some((height, squared)) = self.height_over(edge, &edge.faces[0], state) else { return false };
        let hollowest = edge
            .faces
            .iter()
            .filter_map(|of| self.faces.get(usize::from(of.face)))
            .fold(0.0, |least, face| self.hollower(least, face));
        is_steep(height, squared, hollowest)
    }

    /// Whether a probe is below both faces of an edge, nearer to their normals than to their tangent planes. In front of
    /// no edge is it: the normals would have to be more than 270° apart. Of a smooth edge one normal is enough.
    #[inline(never)]
    pub(super) fn is_below(&self, edge: &Edge, state: &BodyWitness) -> bool {
        let is_below = |of: &EdgeFace| {
            let height = self.height_over(edge, of, state);
            height.is_some_and(|(height, squared)| height < 0.0 && height * height > 0.5 * squared)
        };
        let [first, second] = &edge.faces;
        is_below(first) && (edge.kind == EdgeKind::Smooth || is_below(second))
    }

    /// `(n·d, |n|²|d|²)` for a probe at the offset `d` from the witness point on an edge, with the outward normal
    /// `n = t × m` of one of its faces, not of length 1: `t` along the edge, `m` out of the face over it.
    fn height_over(&self, edge: &Edge, of: &EdgeFace, state: &BodyWitness) -> Option<(f32, f32)> {
        let face = self.faces.get(usize::from(of.face))?;
        let Some(Side::Edge { separator, reversed, .. }) = face.sides.get(usize::from(of.side)) else { return None };
        let across = match self.cross(edge, separator, state.witness.parameters[0]) {
            Cross::Plane { across, .. } | Cross::Ruled(across) => across,
        };
        let (tangent, away) = (state.witness.surface.tangent_u, state.probe - state.witness.surface.point);
        let normal = tangent.cross(across);
        // `f_u × f_v` is `t × m` at the lower border of `u` and the upper one of `v`, along the parameter.
        let is_turned = matches!(of.side, 1 | 2) != *reversed;
        let outward = if is_turned { -face.patch.orientation() } else { face.patch.orientation() };
        Some((outward * normal.dot(away), normal.length_squared() * away.length_squared()))
    }

    /// Whether a probe closest to a vertex is outside a closed body; `None` if the vertex does not decide. If no edge
    /// leads nearer, `outward` decides. Well above a smooth vertex, and in front of three convex edges, the probe is
    /// outside; behind these a face decides.
    pub(super) fn is_outside_at(&self, vertex: &Vertex, towards: Vec3) -> Option<bool> {
        let height = towards.dot(self.outward(vertex));
        let spokes = self.spokes_of(vertex);
        if height != 0.0 && counted(spokes).all(|spoke| towards.dot(self.spoke_direction(vertex, spoke)) <= 0.0) {
            return Some(height > 0.0);
        }
        // Smooth edges alone have no planes between them.
        if height > 0.0 && counted(spokes).all(|spoke| self.is_of_kind(spoke, EdgeKind::Smooth)) {
            return is_steep(height, towards.length_squared(), self.hollowest_at(vertex)).then_some(true);
        }
        self.is_in_front_at(vertex, towards).filter(|is_in_front| *is_in_front)
    }

    /// For a vertex of three convex edges (and any smooth ones): whether the probe is in front of one of the planes
    /// between them, by more than a hollow face may be.
    #[inline(never)]
    pub(super) fn is_in_front_at(&self, vertex: &Vertex, towards: Vec3) -> Option<bool> {
        let spokes = self.spokes_of(vertex);
        let (mut sharp, mut count) = ([spokes.first()?; 3], 0);
        for spoke in counted(spokes) {
            match self.edges.get(usize::from(spoke.edge))?.kind {
                EdgeKind::Convex => {
                    *sharp.get_mut(count)? = spoke;
                    count += 1;
                }
                EdgeKind::Smooth => {}
                EdgeKind::Reflex | EdgeKind::Mixed | EdgeKind::Open => return None,
            }
        }
        if count < sharp.len() {
            return None;
        }
        // `t = αa + βb + γc` has `α (a × b)·c = t·(b × c)`, and so on: behind all three none is below 0.
        let [a, b, c] = sharp.map(|spoke| (spoke, self.spoke_direction(vertex, spoke)));
        let volume = a.1.cross(b.1).dot(c.1);
        Some([[a, b], [b, c], [c, a]].into_iter().any(|[(from, along), (to, beside)]| {
            let normal = along.cross(beside);
            let height = normal.dot(towards);
            let is_in_front = height * volume < 0.0;
            is_in_front
                && (self.is_convex() || {
                    let most = self
                        .bulge_between(from, to, towards)
                        .unwrap_or_else(|| self.hollowest_at(vertex) * towards.length_squared());
                    height * height > most * most * normal.length_squared()
                })
        }))
    }

    /// Upper bound of how far the face between two edges of a vertex comes in front of its tangent plane there,
    /// metres; `None` if there is more than one face between them.
    #[inline(never)]
    fn bulge_between(&self, from: &Spoke, to: &Spoke, towards: Vec3) -> Option<f32> {
        let [first, second] = [self.edges.get(usize::from(from.edge))?, self.edges.get(usize::from(to.edge))?];
        let is_common = |of: &&EdgeFace| second.faces.iter().any(|other| other.face == of.face);
        let of = first.faces.iter().find(is_common)?;
        let face = self.faces.get(usize::from(of.face))?;
        let [along, beside] = [from, to].map(|spoke| if spoke.at_upper_end { 1.0 } else { 0.0 });
        let (tangent, cross) = (self.on_edge(first, along).tangent, self.on_edge(second, beside).tangent);
        Some(bulge(self.patch(face), of.side < 2, &Rim { tangent, cross, is_plane: false, along }, towards))
    }

    /// Minimum curvature of the faces around a vertex, 1/m, if one is hollow; otherwise 0. Poles do not count.
    #[inline(never)]
    fn hollowest_at(&self, vertex: &Vertex) -> f32 {
        let spokes = counted(self.spokes_of(vertex));
        let faces = spokes.filter_map(|spoke| self.edges.get(usize::from(spoke.edge))).flat_map(|edge| edge.faces);
        faces.filter_map(|of| self.faces.get(usize::from(of.face))).fold(0.0, |least, face| self.hollower(least, face))
    }

    /// The lower of a curvature and a face's minimum. A face without a bound, at a pole, does not count.
    fn hollower(&self, hollowest: f32, face: &Face) -> f32 {
        let least = self.patch(face).shape().curvature.min;
        if least < hollowest && least > f32::NEG_INFINITY { least } else { hollowest }
    }

    fn is_of_kind(&self, spoke: &Spoke, kind: EdgeKind) -> bool {
        self.edges.get(usize::from(spoke.edge)).is_some_and(|edge| edge.kind == kind)
    }

    pub(super) fn spokes_of(&self, vertex: &Vertex) -> &[Spoke] {
        let first = usize::from(vertex.first_spoke);
        self.spokes.get(first..first + usize::from(vertex.spokes)).unwrap_or(&[])
    }
}

/// The spokes, each counted where it is looked at.
#[inline(always)]
pub(super) fn counted(spokes: &[Spoke]) -> impl Iterator<Item = &Spoke> {
    spokes.iter().inspect(|_| tally::spoke())
}

/// Whether a height over a tangent plane is more than a body may have there, for a squared distance and the minimum
/// curvature of the faces, 1/m.
fn is_steep(height: f32, squared: f32, hollowest: f32) -> bool {
    let least = if hollowest < -HOLLOW { STEEP } else { LEVEL };
    height > 0.0 && height * height > least * least * squared
}
