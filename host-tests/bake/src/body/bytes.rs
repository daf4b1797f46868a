//! Size of a body's tables in flash, by kind.

use super::{BakedBody, BakedSeparator, BakedSide};
use crate::locator::PackedLists;

/// Sizes of the records on a 32-bit target, in bytes: a face with its patch and sides, an edge, a vertex, a spoke, and
/// the body itself.
const FACE: usize = 228;
const EDGE: usize = 52;
const VERTEX: usize = 32;
const SPOKE: usize = 16;
const BODY: usize = 92;

/// Bytes of RAM on a 32-bit target that a body from a file needs for its faces and edges.
pub const fn room(body: &BakedBody) -> usize {
    body.faces.len() * FACE + body.edges.len() * EDGE
}

/// Bytes by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BodyBytes {
    /// Coefficients of the patches.
    pub coefficients: usize,
    /// Span borders of patches, curves and separators; equal ones are stored once.
    pub borders: usize,
    /// Coefficients of the edges' curves.
    pub curves: usize,
    /// Coefficients of the separators.
    pub separators: usize,
    /// Records of faces, edges, vertices and spokes.
    pub records: usize,
    /// Nodes of the locator.
    pub nodes: usize,
    /// Its lists.
    pub lists: usize,
}

impl BodyBytes {
    /// Those of a body.
    pub fn of(body: &BakedBody) -> Self {
        let separators = body.faces.iter().flat_map(|face| &face.sides).map(|side| match side {
            BakedSide::Edge { separator: BakedSeparator::Ruled(curve), .. } => curve.coefficients.bytes(),
            _ => 0,
        });
        Self {
            coefficients: body.faces.iter().map(|face| face.patch.coefficients.bytes()).sum(),
            borders: body.distinct_breaks().iter().map(|breaks| size_of_val(breaks.as_slice())).sum(),
            curves: body.edges.iter().map(|edge| edge.curve.coefficients.bytes()).sum(),
            separators: separators.sum(),
            records: body.faces.len() * FACE
                + body.edges.len() * EDGE
                + body.vertices.len() * VERTEX
                + body.spokes.len() * SPOKE
                + BODY,
            nodes: size_of_val(body.locator.nodes.as_slice()),
            lists: PackedLists::of(&body.locator.entries).bytes(),
        }
    }

    /// With their names.
    pub const fn by_kind(&self) -> [(&'static str, usize); 7] {
        [
            ("coefficients", self.coefficients),
            ("borders", self.borders),
            ("curves", self.curves),
            ("separators", self.separators),
            ("records", self.records),
            ("locator nodes", self.nodes),
            ("locator lists", self.lists),
        ]
    }

    /// Their sum.
    pub fn total(&self) -> usize {
        self.by_kind().iter().map(|(_, bytes)| bytes).sum()
    }
}
