//! Faces, edges and vertices, and the surfaces that separate their Voronoi regions.

use super::curve::SplineCurve;
use crate::math::Vec3;
use crate::patch::{Coefficients, SplinePatch};
use bytemuck::CheckedBitPattern;

/// A feature of a body: the owner of the closest point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Feature {
    /// The interior of a patch, by index.
    Face(u16),
    /// The interior of a border curve.
    Edge(u16),
    /// A point where edges meet, or a pole.
    Vertex(u16),
}

/// A patch with its four sides.
#[derive(Clone, Copy, Debug)]
pub struct Face<'a> {
    /// The surface.
    pub patch: SplinePatch<'a>,
    /// The borders `u = 0`, `u = 1`, `v = 0`, `v = 1`, in this order.
    pub sides: [Side<'a>; 4],
}

impl Face<'_> {
    /// Content of an unused slot: a square of 1 m with poles for sides.
    pub const VACANT: Self = Self { patch: SplinePatch::VACANT, sides: [Side::Pole { vertex: 0 }; 4] };
}

/// The feature along one border of a face.
#[derive(Clone, Copy, Debug)]
pub enum Side<'a> {
    /// An edge.
    Edge {
        /// Its index.
        edge: u16,
        /// Whether the edge runs against the face's own parameter along this border.
        reversed: bool,
        /// Where the face's Voronoi region ends.
        separator: Separator<'a>,
    },
    /// The border is one point.
    Pole {
        /// The vertex.
        vertex: u16,
    },
}

/// The surface that ends a face's Voronoi region along one of its edges: the ruled surface `c(t) + s N(t)` of edge
/// curve and face normal (theory §9).
///
/// With `m` the face's outward conormal (in its tangent plane, normal to the edge), a probe `Q` has left the face iff
/// `(Q − c(t*)) · m(t*) > 0` at the parameter `t*` of the edge closest to `Q`.
#[derive(Clone, Copy, Debug)]
pub enum Separator<'a> {
    /// A plane: the edge is straight and the face's normal constant along it. Left iff `across · Q > offset`.
    Plane {
        /// Normal to the plane, out of the face's region: the change of the face's parameter across the border in a
        /// metre, at the middle of the edge.
        across: Vec3,
        /// `across · P` for a point `P` of the plane.
        offset: f32,
    },
    /// The face's derivative across the border, out of the face, in the edge's parameter: `±f_u` or `±f_v` times any
    /// positive function that is 1 at the middle of the edge. The conormal is its part normal to the edge. Exact: a
    /// polynomial of the patch's own numbers.
    Ruled(SplineCurve<'a>),
}

/// How the faces of an edge stand to each other, seen from outside the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum EdgeKind {
    /// A ridge all along: only probes outside have their closest point on it.
    Convex = 0,
    /// The normals agree all along: it owns no probe, and the faces hand over directly.
    Smooth = 1,
    /// A valley all along: only probes inside are held by it.
    Reflex = 2,
    /// It changes along the way.
    Mixed = 3,
    /// The border of an open body: one face only.
    Open = 4,
}

/// A border curve.
#[derive(Clone, Copy, Debug)]
pub struct Edge<'a> {
    /// The curve, never one point.
    pub curve: SplineCurve<'a>,
    /// `sup ‖c'''‖`, metres per unit of parameter cubed: for the second-order step along the edge. Infinite without a
    /// proof.
    pub third_derivative: f32,
    /// The largest jump of `c''` across a knot, metres per unit of parameter squared. Infinite at a crease.
    pub jump: f32,
    /// The faces on it: two (possibly the same face twice), or one and [`EdgeFace::NONE`] for an open border.
    pub faces: [EdgeFace; 2],
    /// The vertices at `t = 0` and `t = 1`.
    pub ends: [u16; 2],
    /// How the faces meet.
    pub kind: EdgeKind,
}

impl Edge<'_> {
    /// The neighbour beyond a side of the face that holds the witness point. Both sides of the edge may be the same
    /// face.
    #[inline(always)]
    pub(crate) fn neighbour_of_side(&self, from: Feature, number: usize) -> EdgeFace {
        let [first, second] = self.faces;
        let is_first = from == Feature::Face(first.face) && usize::from(first.side) == number;
        if is_first { second } else { first }
    }

    /// Content of an unused slot: a point, without faces.
    pub const VACANT: Self = Self {
        curve: SplineCurve {
            degree: 0,
            breaks: &[0.0, 1.0],
            coefficients: Coefficients::Polynomial(&[[0.0; 3]]),
            second_derivative: 0.0,
        },
        third_derivative: 0.0,
        jump: 0.0,
        faces: [EdgeFace::NONE; 2],
        ends: [0; 2],
        kind: EdgeKind::Open,
    };
}

/// One face of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct EdgeFace {
    /// Index of the face.
    pub face: u16,
    /// Which of its sides the edge is.
    pub side: u8,
}

impl EdgeFace {
    /// No face: beyond an open border.
    pub const NONE: Self = Self { face: u16::MAX, side: 0 };
}

/// A point where edges meet. Its layout in a file is that in memory.
#[derive(Clone, Copy, Debug, CheckedBitPattern)]
#[repr(C)]
pub struct Vertex {
    /// Where, metres.
    pub point: Vec3,
    /// Unit vector along the sum of the faces' normals, each times the angle that it fills here: a probe that is
    /// closest to the vertex is outside a closed body if it is on this side. Zero if that does not decide, and on an
    /// open border.
    pub outward: Vec3,
    /// Its spokes: `first_spoke .. first_spoke + spokes` of the body's list.
    pub first_spoke: u16,
    /// Number of edges that end here.
    pub spokes: u16,
    /// Whether it is on the border of an open body.
    pub is_open: bool,
}

/// One end of an edge, at its vertex. Its layout in a file is that in memory.
#[derive(Clone, Copy, Debug, CheckedBitPattern)]
#[repr(C)]
pub struct Spoke {
    /// Unit tangent of the edge, away from the vertex.
    pub direction: Vec3,
    /// The edge.
    pub edge: u16,
    /// Whether it is the end `t = 1`.
    pub at_upper_end: bool,
}
