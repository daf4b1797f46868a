//! The features of a body, from its patches: faces, edges, vertices, poles, open borders.
//!
//! Neighbours are found by their borders alone: two borders that are the same parametrised curve, within [`TOLERANCE`]
//! of the body's size, are one edge (`match_borders`). Borders that match in part only (`partial`), three faces on an edge
//! and neighbours that disagree about outside are errors.

pub mod border;
mod edges;
mod vertices;

use crate::Axis;
pub use crate::error::SeamFault;
use crate::jet::Jet;
use crate::patch::NurbsPatch;
pub use crate::patch::TOLERANCE;
pub use border::Border;
use edges::Matched;
pub use edges::{BorderRole, Sense, TopologyEdge};
use glam::DVec3;
use palpate::body::EdgeKind;
use vertices::Cluster;
pub use vertices::{TopologySpoke, TopologyVertex};

/// A volume below this, in cubes of the size, is the rounding of the integral.
const NO_VOLUME: f64 = 1e-9;

/// The features of a body and how they hang together.
#[derive(Clone, Debug)]
pub struct Topology {
    /// Role of each patch's borders `u = 0`, `u = 1`, `v = 0`, `v = 1`.
    pub roles: Vec<[BorderRole; 4]>,
    /// The edges, in the order of their owners.
    pub edges: Vec<TopologyEdge>,
    /// The vertices.
    pub vertices: Vec<TopologyVertex>,
    /// The largest side of the bounding box, metres.
    pub size: f64,
}

impl Topology {
    /// Finds the features; `label` is what messages call a patch.
    ///
    /// # Errors
    /// The first pair of borders that is wrong.
    pub fn new(patches: &[NurbsPatch], label: &dyn Fn(usize) -> String) -> Result<Self, SeamFault> {
        let (low, high) = bounding_box(patches);
        let size = (high - low).max_element();
        let tolerance = TOLERANCE * size;
        let matched = edges::match_borders(patches, tolerance, label)?;
        edges::check_orientation(&matched, label)?;
        let topology = Self::of_matched(patches, &matched, size, tolerance);
        if topology.is_closed() {
            let volume = volume(patches);
            if volume.abs() <= NO_VOLUME * size * size * size {
                return Err(SeamFault::NoVolume);
            }
            if volume < 0.0 {
                return Err(SeamFault::InsideOut { volume });
            }
        }
        Ok(topology)
    }

    fn of_matched(patches: &[NurbsPatch], matched: &Matched<'_>, size: f64, tolerance: f64) -> Self {
        let mut cluster = Cluster::default();
        // Every role is set below: a border is a pole or on one edge.
        let mut roles = vec![[BorderRole::Pole { vertex: usize::MAX }; 4]; patches.len()];
        let mut edges = Vec::with_capacity(matched.pairs.len());
        for (owner, partner) in &matched.pairs {
            let candidate = &matched.candidates[*owner];
            let partner = partner.map(|(index, sense)| (matched.candidates[index].border, sense));
            let edge = edges.len();
            roles[candidate.border.patch][candidate.border.side] = BorderRole::Edge { edge, sense: Sense::Same };
            if let Some((other, sense)) = partner {
                roles[other.patch][other.side] = BorderRole::Edge { edge, sense };
            }
            edges.push(TopologyEdge {
                owner: candidate.border,
                partner,
                ends: candidate.ends.map(|end| cluster.place(end, tolerance)),
                kind: edges::kind_of(patches, candidate.border, partner),
            });
        }
        for pole in &matched.poles {
            let vertex = cluster.place(pole.ends[0], tolerance);
            roles[pole.border.patch][pole.border.side] = BorderRole::Pole { vertex };
        }
        let vertices = vertices::with_spokes(cluster.points, &roles, &edges, patches);
        Self { roles, edges, vertices, size }
    }

    /// Whether every edge has two faces.
    pub fn is_closed(&self) -> bool {
        self.edges.iter().all(|edge| edge.partner.is_some())
    }

    /// The piece that each face belongs to: faces that hang together by edges have one number.
    pub fn pieces(&self) -> Vec<usize> {
        let mut piece: Vec<usize> = (0..self.roles.len()).collect();
        for edge in &self.edges {
            let Some((other, _)) = edge.partner else { continue };
            let (from, to) = (piece[edge.owner.patch], piece[other.patch]);
            piece.iter_mut().filter(|of| **of == from).for_each(|of| *of = to);
        }
        piece
    }

    /// Into how many pieces the faces fall.
    pub fn components(&self) -> usize {
        let mut pieces = self.pieces();
        pieces.sort_unstable();
        pieces.dedup();
        pieces.len()
    }

    /// Euler's characteristic `V − E + F`: 2 of a closed body without holes; a pole is a vertex and no edge.
    pub const fn euler_characteristic(&self) -> isize {
        self.vertices.len() as isize - self.edges.len() as isize + self.roles.len() as isize
    }

    /// How many edges are of a kind.
    pub fn count(&self, kind: EdgeKind) -> usize {
        self.edges.iter().filter(|edge| edge.kind == kind).count()
    }
}

/// The corners of the bounding box of a grid of points, 8 to a span, on all patches, metres.
pub fn bounding_box(patches: &[NurbsPatch]) -> (DVec3, DVec3) {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for patch in patches {
        patch.for_each_sample(8, |_, surface| {
            low = low.min(surface.point);
            high = high.max(surface.point);
            true
        });
    }
    (low, high)
}

// The volume inside a closed body, by the divergence theorem.

/// Gauss's points and weights on `[0, 1]`, exact up to degree 9.
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_5],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_2],
    [0.5, 0.284_444_444_444_444_4],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_2],
    [0.953_089_922_969_332, 0.118_463_442_528_094_5],
];

/// `∮ P · N dA / 3`, m³. Of polynomial patches up to degree 3 exact up to rounding; only its sign and its being 0 are
/// asked for.
fn volume(patches: &[NurbsPatch]) -> f64 {
    patches.iter().map(flux).sum::<f64>() / 3.0
}

/// `∫ P · N dA` of one patch.
fn flux(patch: &NurbsPatch) -> f64 {
    let nodes = |axis| {
        let on_span = |pair: &[f64]| {
            let (start, width) = (pair[0], pair[1] - pair[0]);
            GAUSS.map(|[at, weight]| [start + width * at, width * weight])
        };
        patch.borders(axis).windows(2).flat_map(on_span).collect::<Vec<_>>()
    };
    let along_v = nodes(Axis::V);
    let at = |u: f64, v: f64| {
        let surface = Jet::of(patch, u, v);
        surface.point.dot(surface.tangent_u.cross(surface.tangent_v))
    };
    let column = |u: f64| along_v.iter().map(|[v, weight]| weight * at(u, *v)).sum::<f64>();
    let total: f64 = nodes(Axis::U).into_iter().map(|[u, weight]| weight * column(u)).sum();
    if patch.flip { -total } else { total }
}
