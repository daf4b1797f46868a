//! A body as tables in flash, checked when it is built.

use super::feature::{Edge, EdgeFace, EdgeKind, Face, Separator, Side, Spoke, Vertex};
use super::locator::{Candidate, Locator, MAX_FACES, MAX_LIST};
use super::tick_bound::{Effort, MAX_SPOKES};
use crate::field::Rigid;
use crate::math::Vec3;
use crate::track::Contact;
use core::fmt;
use core::num::NonZeroU32;

/// A body of several patches: features, the surfaces that separate their Voronoi regions, and a locator.
///
/// Made of [`BodyTables`] that a host has baked, or from a file:
///
/// ```
/// use palpate::body::{Aligned, Body, BodyBuffer, Edge, Face};
/// use palpate::math::vec3;
///
/// # macro_rules! include_bytes { ($_: literal) => { std::include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/boards/bodies/capped_box.palp")) } }
/// static FILE: &Aligned<[u8]> = &Aligned(*include_bytes!("capped_box.palp"));
/// let (mut faces, mut edges) = ([Face::VACANT; 6], [Edge::VACANT; 12]);
/// let body = Body::from_bytes(&FILE.0, BodyBuffer { faces: &mut faces, edges: &mut edges })?;
/// assert!(body.is_convex());
/// assert!(body.locate(vec3(-0.01, 0.02, 0.01)).distance() <= 0.01);
/// # Ok::<(), palpate::body::FileError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Body<'a, D = Rigid> {
    pub(super) faces: &'a [Face<'a>],
    pub(super) edges: &'a [Edge<'a>],
    pub(super) vertices: &'a [Vertex],
    pub(super) spokes: &'a [Spoke],
    pub(super) locator: Locator<'a>,
    pub(super) size: f32,
    /// The contact from which no audit is needed: the body is touched, or it is convex and the probe in front of the
    /// witness point, so that no other point is nearer.
    pub(super) sure_from: Contact,
    /// Whether any face has a pole; otherwise the search skips the test.
    pub(super) has_poles: bool,
    /// Whether any edge is smooth; otherwise a step that ends at the border of a face skips the test.
    pub(super) has_smooth_edges: bool,
    pub(super) baked_crc: Option<NonZeroU32>,
    /// The work of a tick.
    pub(super) effort: Effort,
    /// By which the tables are deformed: a rigid body has none.
    pub(super) by: D,
}

/// The tables of a body, before their checks: [`BodyTables::checked`] makes the [`Body`].
///
/// `cargo palpate bake` and `palpate_bake::Bake` write them from a model; [`Body::from_bytes`] reads them from a file.
/// [`Body`] has an example.
#[derive(Clone, Copy, Debug)]
pub struct BodyTables<'a> {
    /// The faces, 1 to [`MAX_FACES`].
    pub faces: &'a [Face<'a>],
    /// The border curves of the faces.
    pub edges: &'a [Edge<'a>],
    /// The points where edges meet.
    pub vertices: &'a [Vertex],
    /// The ends of edges at all vertices.
    pub spokes: &'a [Spoke],
    /// The octree for the global start.
    pub locator: Locator<'a>,
    /// Largest side of the bounding box, metres.
    pub size_m: f32,
    /// Whether a probe outside has no local minimum of the distance but the closest point (theory §8).
    pub is_convex: bool,
    /// CRC-32 of all words of the tables ([`Body::table_crc`]) if a host has computed it: the check compares it.
    pub crc: Option<u32>,
}

/// Error in the tables of a body. In a `static` it is a compile error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BodyError {
    /// There is no face, or more than [`MAX_FACES`].
    Faces,
    /// A side names an edge or a vertex that does not exist, or its separator is not finite or of the wrong length.
    Side {
        /// Index of the face.
        face: u16,
        /// Which of its sides.
        side: u8,
    },
    /// An edge's curve is malformed or one of its bounds negative, or it names a face or vertex that does not exist, or
    /// one of its faces does not refer back to it.
    Edge {
        /// Index of the edge.
        edge: u16,
    },
    /// A vertex is not finite, or its spokes do not follow those of the vertex before it.
    Vertex {
        /// Index of the vertex.
        vertex: u16,
    },
    /// A vertex has more than [`MAX_SPOKES`].
    Spokes {
        /// Index of the vertex.
        vertex: u16,
        /// Number of its spokes.
        spokes: u16,
    },
    /// The number of spokes is not twice that of the edges.
    SpokeCount,
    /// A spoke's edge does not end at its vertex, or its direction is not finite.
    Spoke {
        /// Index of the spoke.
        spoke: u16,
    },
    /// The root cube is not finite, or there is no node.
    LocatorCube,
    /// A node names a node before itself or past the end, or an entry past the end.
    LocatorNode {
        /// Index of the node.
        node: u16,
    },
    /// An entry names no face, its rectangle is empty, or a list runs past the end.
    LocatorEntry {
        /// Index of the entry.
        entry: u16,
    },
    /// A list has more than [`MAX_LIST`] entries.
    LocatorList {
        /// Index of the entry that is too many.
        entry: u16,
    },
    /// The size is not positive and finite.
    Size,
    /// The CRC-32 of the words is not the given one: a number has changed since the tables were baked.
    Crc,
}

impl BodyError {
    /// The message without indices: the field, and its requirement.
    pub const fn message(self) -> &'static str {
        match self {
            Self::Faces => "faces: a body has 1 to 1024",
            Self::Side { .. } => "sides: a side names no edge or vertex of the body, or its separator is malformed",
            Self::Edge { .. } => "edges: an edge has a malformed curve or does not fit its faces and vertices",
            Self::Vertex { .. } => "vertices: a vertex is not finite, or its spokes do not follow those before",
            Self::Spokes { .. } => "vertices: more than 64 edges end at a vertex; merge faces that meet there",
            Self::SpokeCount => "spokes: their number is not twice that of the edges",
            Self::Spoke { .. } => "spokes: a spoke's edge does not end at its vertex, or it is not finite",
            Self::LocatorCube => "locator: the cube must be finite and have a root",
            Self::LocatorNode { .. } => "locator: a node names a child that does not exist",
            Self::LocatorEntry { .. } => "locator: an entry names no face, has no rectangle or no end",
            Self::LocatorList { .. } => "locator: a list has more than 1024 entries; the audit would not reach its end",
            Self::Size => "size_m: must be positive and finite",
            Self::Crc => "crc: the tables' numbers are not those that were baked",
        }
    }
}

impl fmt::Display for BodyError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.message())?;
        match self {
            Self::Side { face, side } => write!(formatter, " (face {face}, side {side})"),
            Self::Edge { edge: index }
            | Self::Vertex { vertex: index }
            | Self::Spoke { spoke: index }
            | Self::LocatorNode { node: index }
            | Self::LocatorEntry { entry: index }
            | Self::LocatorList { entry: index } => write!(formatter, " (number {index})"),
            Self::Spokes { vertex, spokes } => write!(formatter, " (vertex {vertex} has {spokes})"),
            Self::Faces | Self::SpokeCount | Self::LocatorCube | Self::Size | Self::Crc => Ok(()),
        }
    }
}

impl core::error::Error for BodyError {}

impl<'a> BodyTables<'a> {
    /// The body, with its CRC, for a `static`.
    ///
    /// # Panics
    /// At compile time, with [`BodyError::message`].
    pub const fn checked(self) -> Body<'a> {
        match self.try_checked() {
            Ok(body) => body,
            Err(error) => panic!("{}", error.message()),
        }
    }

    /// Checks the tables, and their CRC if one is given. The body carries the CRC of its words: the servo loop compares
    /// flash with it (see [`crate::servo::Safety::checks_tables`]).
    ///
    /// # Errors
    /// The first error in the tables.
    pub const fn try_checked(self) -> Result<Body<'a>, BodyError> {
        let body = match self.try_checked_without_crc() {
            Ok(body) => body,
            Err(error) => return Err(error),
        };
        let found = body.table_crc();
        match self.crc {
            Some(baked) if baked != found => Err(BodyError::Crc),
            _ => Ok(body.with_crc(found)),
        }
    }

    /// [`Self::try_checked`] that leaves the CRC to the caller.
    pub(super) const fn try_checked_without_crc(self) -> Result<Body<'a>, BodyError> {
        let Self { faces, edges, vertices, spokes, locator, size_m, is_convex, crc: _ } = self;
        if faces.is_empty() || faces.len() > MAX_FACES {
            return Err(BodyError::Faces);
        }
        if !(size_m > 0.0 && size_m < f32::INFINITY) {
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
        let body = Body {
            faces,
            edges,
            vertices,
            spokes,
            locator,
            size: size_m,
            sure_from,
            has_poles,
            has_smooth_edges,
            baked_crc: None,
            effort: Effort::BENCH,
            by: Rigid,
        };
        if let Err(error) = body.check_features() {
            return Err(error);
        }
        match body.check_locator() {
            Ok(()) => Ok(body),
            Err(error) => Err(error),
        }
    }
}

impl<'a, const KINDS: u32> Body<'a, Rigid<KINDS>> {
    /// The same body with another baked CRC, which the servo loop compares with flash (see
    /// [`crate::servo::Safety::checks_tables`]); [`BodyTables::checked`] sets it. 0 is no CRC: one body in 2³² is not
    /// checked.
    #[must_use]
    pub const fn with_crc(self, baked: u32) -> Self {
        Self { baked_crc: NonZeroU32::new(baked), ..self }
    }

    /// The same body with another effort in each tick.
    #[must_use]
    pub const fn with_effort(self, effort: Effort) -> Self {
        let steps = if effort.steps > 0 { effort.steps } else { 1 };
        let candidates = if effort.candidates > 0 { effort.candidates } else { 1 };
        Self { effort: Effort { steps, candidates }, ..self }
    }

    /// The effort in each tick.
    pub const fn effort(&self) -> Effort {
        self.effort
    }

    /// The kinds of its patches ([`crate::patch::Kinds::MASK`]).
    pub const fn kinds(&self) -> u32 {
        let (mut kinds, mut index) = (0, 0);
        while index < self.faces.len() {
            kinds |= self.faces[index].patch.kind();
            index += 1;
        }
        kinds
    }

    /// The same body as one of these kinds of patches only: an image then holds no code for others.
    ///
    /// # Panics
    /// At compile time, if a patch is of another kind.
    #[must_use]
    pub const fn of_kinds<const OF: u32>(self) -> Body<'a, Rigid<OF>> {
        assert!(self.kinds() & !OF == 0, "kinds: a face is of another kind; take `kinds()` of this body");
        self.displaced_by(Rigid, self.sure_from)
    }

    /// The same tables with a displacement, and with where an audit is needed under it.
    #[inline(always)]
    pub(super) const fn displaced_by<D: Copy>(&self, by: D, sure_from: Contact) -> Body<'a, D> {
        let Self { faces, edges, vertices, spokes, locator, size, has_poles, has_smooth_edges, .. } = *self;
        let (baked_crc, effort) = (self.baked_crc, self.effort);
        Body {
            faces,
            edges,
            vertices,
            spokes,
            locator,
            size,
            sure_from,
            has_poles,
            has_smooth_edges,
            baked_crc,
            effort,
            by,
        }
    }

    /// The CRC-32 that the tables had when they were baked.
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
        let (mut index, mut number) = (0, 0);
        while index < self.vertices.len() {
            let Vertex { point, outward, first_spoke, spokes, .. } = self.vertices[index];
            if spokes as usize > MAX_SPOKES {
                return Err(BodyError::Spokes { vertex: index as u16, spokes });
            }
            let end = number + spokes as usize;
            if !(is_finite(point) && is_finite(outward) && first_spoke as usize == number && end <= self.spokes.len()) {
                return Err(BodyError::Vertex { vertex: index as u16 });
            }
            while number < end {
                let Spoke { direction, edge, at_upper_end } = self.spokes[number];
                let is_its = (edge as usize) < self.edges.len()
                    && self.edges[edge as usize].ends[at_upper_end as usize] as usize == index;
                if !(is_finite(direction) && is_its) {
                    return Err(BodyError::Spoke { spoke: number as u16 });
                }
                number += 1;
            }
            index += 1;
        }
        if number != self.spokes.len() || number != 2 * self.edges.len() {
            return Err(BodyError::SpokeCount);
        }
        Ok(())
    }

    /// Whether an edge names a side of a face.
    const fn names_back(&self, edge: u16, face: usize, side: usize) -> bool {
        let [first, second] = self.edges[edge as usize].faces;
        (first.face as usize == face && first.side as usize == side)
            || (second.face as usize == face && second.side as usize == side)
    }

    /// Whether an edge's entry is a side that refers back to the edge.
    const fn is_side(&self, of: EdgeFace, index: usize) -> bool {
        if of.face as usize >= self.faces.len() || of.side >= 4 {
            return false;
        }
        matches!(self.faces[of.face as usize].sides[of.side as usize], Side::Edge { edge, .. } if edge as usize == index)
    }

    const fn check_locator(&self) -> Result<(), BodyError> {
        let Locator { corner, side, nodes, lists } = self.locator;
        let entries = lists.entries as usize;
        if !(is_finite(corner) && side > 0.0 && side < f32::INFINITY) || nodes.is_empty() || entries == 0 {
            return Err(BodyError::LocatorCube);
        }
        let mut node = 0;
        while node < nodes.len() {
            let mut child = 0;
            while child < 8 {
                let target = nodes[node][child] as usize;
                // Children come after their parents, so that a descent ends.
                if target <= node || target >= nodes.len() + entries {
                    return Err(BodyError::LocatorNode { node: node as u16 });
                }
                child += 1;
            }
            node += 1;
        }
        if !lists.has_readable_entries() {
            return Err(BodyError::LocatorEntry { entry: 0 });
        }
        let (mut index, mut list) = (0, 0);
        while index < entries {
            let wrong = BodyError::LocatorEntry { entry: index as u16 };
            let Some(Candidate { face, lower, upper, more, .. }) = lists.candidate(index) else { return Err(wrong) };
            let rectangle = lower[0] <= upper[0] && lower[1] <= upper[1];
            if !(rectangle && (face as usize) < self.faces.len() && (!more || index + 1 < entries)) {
                return Err(wrong);
            }
            list = if more { list + 1 } else { 0 };
            if list >= MAX_LIST {
                return Err(BodyError::LocatorList { entry: index as u16 });
            }
            index += 1;
        }
        Ok(())
    }
}

impl<D> Body<'_, D> {
    /// Whether a probe outside has no local minimum of the distance but the closest point.
    pub const fn is_convex(&self) -> bool {
        matches!(self.sure_from, Contact::InFront)
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
