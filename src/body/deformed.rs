//! The tables of a body as its displacement deforms them: at no cost for a rigid one.

use super::curve::CurvePoint;
use super::feature::{Edge, Face, Separator, Spoke, Vertex};
use super::table::Body;
use crate::field::{Displaced, Displacement};
use crate::math::{Vec3, inverse_sqrt};
use crate::patch::Patch as _;

/// The end of a face's Voronoi region at a point of an edge.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cross {
    /// As of [`Separator::Plane`].
    Plane { across: Vec3, offset: f32 },
    /// The face's derivative across the border, out of the face.
    Ruled(Vec3),
}

impl<D: Displacement> Body<'_, D> {
    #[inline(always)]
    pub(super) fn patch<'b>(&self, face: &'b Face<'b>) -> Displaced<'b, D> {
        Displaced { rest: &face.patch, by: self.by }
    }

    /// Where the locator is asked for a probe: to a thousandth of the size, which is less than a cell.
    #[inline(always)]
    pub(super) fn at_rest(&self, probe: Vec3) -> Vec3 {
        self.by.undo(probe, 1.0e-3 * self.size)
    }

    /// The separator of a face at the parameter `t` of an edge. A plane does not stay one.
    #[inline(always)]
    pub(super) fn cross(&self, edge: &Edge, separator: &Separator, t: f32) -> Cross {
        if !self.by.is_rest() {
            return Cross::Ruled(self.displaced_cross(edge, separator, t));
        }
        match separator {
            Separator::Plane { across, offset } => Cross::Plane { across: *across, offset: *offset },
            Separator::Ruled(cross) => Cross::Ruled(cross.point(t)),
        }
    }

    /// `DΦ` takes the derivative across the border to that of the displaced face; a part along the edge stays along it.
    #[inline(never)]
    fn displaced_cross(&self, edge: &Edge, separator: &Separator, t: f32) -> Vec3 {
        let cross = match separator {
            Separator::Plane { across, .. } => *across * (1.0 / across.length_squared()),
            Separator::Ruled(cross) => cross.point(t),
        };
        self.by.direction(edge.curve.point(t), cross)
    }

    #[inline(always)]
    pub(super) fn on_edge(&self, edge: &Edge, t: f32) -> CurvePoint {
        if self.by.is_rest() {
            return edge.curve.evaluate(t);
        }
        let mut at = edge.curve.evaluate(t);
        self.by.displace_curve(&mut at.point, &mut at.tangent, &mut at.half_second);
        at
    }

    /// Bounds of an edge: `‖c''‖`, `‖c'''‖`, the jumps of `c''`. A border of a face is a curve of its parameter.
    #[inline(always)]
    pub(super) fn edge_bounds(&self, edge: &Edge) -> [f32; 3] {
        let rest = [edge.curve.second_derivative, edge.third_derivative, edge.jump];
        self.by.curve_bounds(rest, || {
            let face = self.faces.get(usize::from(edge.faces[0].face));
            face.map_or(f32::INFINITY, |face| face.patch.shape().max_stretch)
        })
    }

    #[inline(always)]
    pub(super) fn place(&self, vertex: &Vertex) -> Vec3 {
        self.by.point(vertex.point)
    }

    /// [`Vertex::outward`].
    #[inline(always)]
    pub(super) fn outward(&self, vertex: &Vertex) -> Vec3 {
        if self.by.is_rest() { vertex.outward } else { unit(self.by.normal(vertex.point, vertex.outward)) }
    }

    /// [`Spoke::direction`], from its vertex.
    #[inline(always)]
    pub(super) fn spoke_direction(&self, vertex: &Vertex, spoke: &Spoke) -> Vec3 {
        if self.by.is_rest() { spoke.direction } else { unit(self.by.direction(vertex.point, spoke.direction)) }
    }
}

/// A vector of the length 1; zero stays zero.
fn unit(vector: Vec3) -> Vec3 {
    let squared = vector.length_squared();
    if squared > f32::MIN_POSITIVE { vector * inverse_sqrt(squared) } else { Vec3::ZERO }
}
