//! A body as tables in flash, checked when it is built.

use super::feature::{Edge, EdgeFace, EdgeKind, Face, Separator, Side, Spoke, Vertex};
use super::locator::{Candidate, LEAF, Locator, MAX_FACES};
use crate::math::Vec3;
use crate::track::Contact;
use core::num::NonZeroU32;
use thiserror::Error;

/// A body of several patches: features, the surfaces that separate their Voronoi regions, and a locator.
#[derive(Clone, Copy, Debug)]
pub struct Body<'a> {
    pub(super) faces: &'a [Face<'a>],
    pub(super) edges: &'a [Edge<'a>],
    pub(super) vertices: &'a [Vertex],
    pub(super) spokes: &'a [Spoke],
    pub(super) locator: Locator<'a>,
    pub(super) size: f32,
    /// The contact from which there is nothing to audit: the body is touched, or it is convex and the probe in front of
    /// the witness point, so that no other point is nearer.
    pub(super) sure_from: Contact,
    /// Whether any face has a pole: where none has, the search does not ask.
    pub(super) has_poles: bool,
    /// Whether any edge is smooth: where none is, a step that ends at the border of a face does not ask.
    pub(super) has_smooth_edges: bool,
    pub(super) baked_crc: Option<NonZeroU32>,
}

/// Why a body's tables are refused. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BodyError {
    /// There is no face, or more than [`MAX_FACES`].
    #[error("a body has 1 to 1024 faces")]
    Faces,
    /// A side names an edge or a vertex that is not there, or its separator is not finite or of the wrong length.
    #[error("side {side} of face {face} names no edge or vertex of the body, or its separator is malformed")]
    Side {
        /// The face.
        face: u16,
        /// Which side.
        side: u8,
    },
    /// An edge's curve is malformed or one of its bounds negative, or it names a face or vertex that is not there, or
    /// one of its faces does not refer back to it.
    #[error("edge {edge} has a malformed curve or does not fit its faces and vertices")]
    Edge {
        /// The edge.
        edge: u16,
    },
    /// A vertex is not finite, or its spokes are not there.
    #[error("vertex {vertex} is not finite or names spokes that are not there")]
    Vertex {
        /// The vertex.
        vertex: u16,
    },
    /// A spoke names no edge, or its direction is not finite.
    #[error("spoke {spoke} names no edge of the body or is not finite")]
    Spoke {
        /// Its index.
        spoke: u16,
    },
    /// The root cube is not finite, or there is no node.
    #[error("the locator's cube must be finite and have a root")]
    LocatorCube,
    /// A node names a node before itself or past the end, or an entry past the end.
    #[error("locator node {node} names a child that is not there")]
    LocatorNode {
        /// The node.
        node: u16,
    },
    /// An entry names no face, its rectangle is empty, or a list runs past the end.
    #[error("locator entry {entry} names no face, has no rectangle or no end")]
    LocatorEntry {
        /// The entry.
        entry: u16,
    },
    /// The size is not positive and finite.
    #[error("the size must be positive and finite")]
    Size,
}

impl<'a> Body<'a> {
    /// Checks the tables and takes them. `is_convex` says that no closest point but the global one exists for a probe
    /// outside (theory §8); `size` is the largest side of the bounding box, metres.
    ///
    /// # Errors
    /// The first thing wrong.
    pub const fn try_new(
        faces: &'a [Face<'a>],
        edges: &'a [Edge<'a>],
        vertices: &'a [Vertex],
        spokes: &'a [Spoke],
        locator: Locator<'a>,
        size: f32,
        is_convex: bool,
    ) -> Result<Self, BodyError> {
        if faces.is_empty() || faces.len() > MAX_FACES {
            return Err(BodyError::Faces);
        }
        if !(size > 0.0 && size < f32::INFINITY) {
            return Err(BodyError::Size);
        }
        let sure_from = if is_convex { Contact::InFront } else { Contact::Touching };
        let mut has_poles = false;
        let mut index = 0;
        while index < faces.len() {
            has_poles |= faces[index].poles() != 0;
            index += 1;
        }
        let mut has_smooth_edges = false;
        index = 0;
        while index < edges.len() {
            has_smooth_edges |= matches!(edges[index].kind, EdgeKind::Smooth);
            index += 1;
        }
        let body = Self {
            faces,
            edges,
            vertices,
            spokes,
            locator,
            size,
            sure_from,
            has_poles,
            has_smooth_edges,
            baked_crc: None,
        };
        if let Err(error) = body.check_features() {
            return Err(error);
        }
        match body.check_locator() {
            Ok(()) => Ok(body),
            Err(error) => Err(error),
        }
    }

    /// [`Self::try_new`] for a `static`: a bad table does not compile.
    ///
    /// # Panics
    /// At compile time, naming the kind of table.
    pub const fn from_tables(
        faces: &'a [Face<'a>],
        edges: &'a [Edge<'a>],
        vertices: &'a [Vertex],
        spokes: &'a [Spoke],
        locator: Locator<'a>,
        size: f32,
        is_convex: bool,
    ) -> Self {
        match Self::try_new(faces, edges, vertices, spokes, locator, size, is_convex) {
            Ok(body) => body,
            Err(BodyError::Faces) => panic!("faces"),
            Err(BodyError::Side { .. }) => panic!("side"),
            Err(BodyError::Edge { .. }) => panic!("edge"),
            Err(BodyError::Vertex { .. }) => panic!("vertex"),
            Err(BodyError::Spoke { .. }) => panic!("spoke"),
            Err(BodyError::LocatorCube) => panic!("locator: cube"),
            Err(BodyError::LocatorNode { .. }) => panic!("locator: node"),
            Err(BodyError::LocatorEntry { .. }) => panic!("locator: entry"),
            Err(BodyError::Size) => panic!("size"),
        }
    }

    /// The same tables with the CRC that their words had when they were baked: the loop compares them with it, see
    /// [`crate::servo::Safety::checks_tables`]. (A CRC of 0, one in 2³², is none.)
    #[must_use]
    pub const fn with_crc(self, baked: u32) -> Self {
        Self { baked_crc: NonZeroU32::new(baked), ..self }
    }

    /// The CRC that the tables carry.
    pub const fn baked_crc(&self) -> Option<u32> {
        match self.baked_crc {
            Some(baked) => Some(baked.get()),
            None => None,
        }
    }

    /// The faces.
    pub const fn faces(&self) -> &'a [Face<'a>] {
        self.faces
    }

    /// The edges.
    pub const fn edges(&self) -> &'a [Edge<'a>] {
        self.edges
    }

    /// The vertices.
    pub const fn vertices(&self) -> &'a [Vertex] {
        self.vertices
    }

    /// The spokes of all vertices.
    pub const fn spokes(&self) -> &'a [Spoke] {
        self.spokes
    }

    /// The locator.
    pub const fn locator(&self) -> &Locator<'a> {
        &self.locator
    }

    /// The largest side of the bounding box, metres.
    pub const fn size(&self) -> f32 {
        self.size
    }

    /// Whether a probe outside has no nearest point but the closest one.
    pub const fn is_convex(&self) -> bool {
        matches!(self.sure_from, Contact::InFront)
    }

    const fn check_features(&self) -> Result<(), BodyError> {
        let mut face = 0;
        while face < self.faces.len() {
            let mut side = 0;
            while side < 4 {
                let fits = match &self.faces[face].sides[side] {
                    Side::Pole { vertex } => (*vertex as usize) < self.vertices.len(),
                    Side::Edge { edge, separator, .. } => {
                        let known = (*edge as usize) < self.edges.len();
                        known && self.names_back(*edge, face, side) && separator.is_valid()
                    }
                };
                if !fits {
                    return Err(BodyError::Side { face: face as u16, side: side as u8 });
                }
                side += 1;
            }
            face += 1;
        }
        let mut index = 0;
        while index < self.edges.len() {
            let edge = &self.edges[index];
            let ends = (edge.ends[0] as usize) < self.vertices.len() && (edge.ends[1] as usize) < self.vertices.len();
            let faces =
                self.is_side(edge.faces[0], index) && (is_none(edge.faces[1]) || self.is_side(edge.faces[1], index));
            let bounded = edge.third_derivative >= 0.0 && edge.jump >= 0.0;
            if !(edge.curve.is_valid() && bounded && ends && faces) {
                return Err(BodyError::Edge { edge: index as u16 });
            }
            index += 1;
        }
        let mut index = 0;
        while index < self.vertices.len() {
            let Vertex { point, outward, first_spoke, spokes, .. } = self.vertices[index];
            if !(is_finite(point) && is_finite(outward) && first_spoke as usize + spokes as usize <= self.spokes.len())
            {
                return Err(BodyError::Vertex { vertex: index as u16 });
            }
            index += 1;
        }
        let mut index = 0;
        while index < self.spokes.len() {
            let spoke = &self.spokes[index];
            if !(is_finite(spoke.direction) && (spoke.edge as usize) < self.edges.len()) {
                return Err(BodyError::Spoke { spoke: index as u16 });
            }
            index += 1;
        }
        Ok(())
    }

    /// Whether an edge names a side of a face.
    const fn names_back(&self, edge: u16, face: usize, side: usize) -> bool {
        let [first, second] = self.edges[edge as usize].faces;
        (first.face as usize == face && first.side as usize == side)
            || (second.face as usize == face && second.side as usize == side)
    }

    /// Whether what an edge names is a side that names the edge.
    const fn is_side(&self, of: EdgeFace, index: usize) -> bool {
        if of.face as usize >= self.faces.len() || of.side >= 4 {
            return false;
        }
        matches!(self.faces[of.face as usize].sides[of.side as usize], Side::Edge { edge, .. } if edge as usize == index)
    }

    const fn check_locator(&self) -> Result<(), BodyError> {
        let Locator { corner, side, nodes, entries } = self.locator;
        if !(is_finite(corner) && side > 0.0 && side < f32::INFINITY) || nodes.is_empty() || entries.is_empty() {
            return Err(BodyError::LocatorCube);
        }
        let mut node = 0;
        while node < nodes.len() {
            let mut child = 0;
            while child < 8 {
                let code = nodes[node][child];
                let target = (code & !LEAF) as usize;
                // Children come after their parents, so that a descent ends.
                let fits =
                    if code & LEAF != 0 { target < entries.len() } else { target > node && target < nodes.len() };
                if !fits {
                    return Err(BodyError::LocatorNode { node: node as u16 });
                }
                child += 1;
            }
            node += 1;
        }
        let mut index = 0;
        while index < entries.len() {
            let Candidate { face, lower, upper, more, .. } = Candidate::unpack(entries[index]);
            let rectangle = lower[0] <= upper[0] && lower[1] <= upper[1];
            if !(rectangle && (face as usize) < self.faces.len() && (!more || index + 1 < entries.len())) {
                return Err(BodyError::LocatorEntry { entry: index as u16 });
            }
            index += 1;
        }
        Ok(())
    }
}

impl Separator<'_> {
    const fn is_valid(&self) -> bool {
        match self {
            Self::Plane { across, offset } => is_finite(*across) && offset.is_finite(),
            Self::Ruled(curve) => curve.is_valid(),
        }
    }
}

const fn is_none(of: EdgeFace) -> bool {
    of.face == EdgeFace::NONE.face
}

const fn is_finite(vector: Vec3) -> bool {
    vector.x.is_finite() && vector.y.is_finite() && vector.z.is_finite()
}
