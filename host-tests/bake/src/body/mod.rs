//! The tables of a body, on the host: [`palpate::body::Body`] with the numbers owned.

mod border;
mod bytes;
mod curve;

use crate::convexity::{Convexity, convexity};
use crate::error::ModelError;
use crate::locator::{
    self, BakedLocator, LocatorError, LocatorOptions, LocatorReport, PackedLists, Seams, StoredSurface, extent,
};
use crate::model::Model;
use crate::patch::NurbsPatch;
use crate::split::{Piece, Provenance};
use crate::topology::{Border, BorderRole, SeamFault, Sense, Topology, bounding_box};
use crate::{Axis, BakedPatch, PatchFault, parallel, spline};
use border::BorderSpans;
pub use bytes::{BodyBytes, room};
pub use curve::{BakedCurve, BakedSeparator};
use glam::DVec3;
use palpate::body::{
    Body, BodyError, BodyTables, Candidate, Edge, EdgeFace, EdgeKind, Face, GRID, Locator, MAX_FACES, Side, Spoke,
    Vertex,
};
use palpate::math::Vec3;
use palpate::patch::TableError;
use thiserror::Error;

/// A body's tables.
#[derive(Clone, Debug)]
pub struct BakedBody {
    /// The faces.
    pub faces: Vec<BakedFace>,
    /// The edges.
    pub edges: Vec<BakedEdge>,
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// The spokes of all vertices, in their order.
    pub spokes: Vec<Spoke>,
    /// The locator.
    pub locator: LocatorTable,
    /// The largest side of the bounding box, metres.
    pub size: f32,
    /// See [`Self::new`].
    pub is_convex: bool,
    /// The features in double precision.
    pub topology: Topology,
}

/// A face: a piece of a patch of the model.
#[derive(Clone, Debug)]
pub struct BakedFace {
    /// The surface.
    pub patch: BakedPatch,
    /// Its sides `u = 0`, `u = 1`, `v = 0`, `v = 1`.
    pub sides: [BakedSide; 4],
    /// The surface in double precision.
    pub surface: NurbsPatch,
    /// Which part of the model it is.
    pub source: Provenance,
}

/// The neighbour along a border.
#[derive(Clone, Debug, PartialEq)]
pub enum BakedSide {
    /// An edge.
    Edge {
        /// Its index.
        edge: u16,
        /// Whether it runs against the face's parameter.
        reversed: bool,
        /// Where the face's region ends.
        separator: BakedSeparator,
    },
    /// One point.
    Pole {
        /// The vertex.
        vertex: u16,
    },
}

/// An edge.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedEdge {
    /// The curve.
    pub curve: BakedCurve,
    /// `sup ‖c'''‖`, and the largest jump of `c''`.
    pub third_derivative: [f32; 2],
    /// The faces on it.
    pub faces: [EdgeFace; 2],
    /// The vertices at its ends.
    pub ends: [u16; 2],
    /// How the faces meet.
    pub kind: EdgeKind,
}

/// The library's refusal of baked tables: a bug of the baker.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum TableFault {
    /// In a patch.
    #[error("face {face}: {error}")]
    Patch {
        /// Which.
        face: usize,
        /// The refusal.
        error: TableError,
    },
    /// In the body.
    #[error(transparent)]
    Body(#[from] BodyError),
}

impl BakedBody {
    /// Bakes a model, in pieces where it must be ([`super::split::prepared`]); `file` is its name in messages.
    ///
    /// The body counts as convex if it is closed and of one piece, if every face is convex (proved, or proved up to
    /// rounding where it is straight: see [`super::survey`]), and if every edge is [`EdgeKind::Convex`] or
    /// [`EdgeKind::Smooth`]. Then it is locally convex everywhere, and a closed surface that is so bounds a convex body
    /// (van Heijenoort, *On locally convex manifolds*, 1952). The convexity of the faces is proved; the edges' kinds
    /// are sampled, and there is no proof for poles: a body with poles is never called convex, because the curvature
    /// has no bound there.
    ///
    /// # Errors
    /// A fault of the model's patches, or between them.
    pub fn new(model: &Model, file: &str) -> Result<Self, ModelError> {
        Self::of_pieces(super::split::prepared(model, file)?, model, file)
    }

    /// Options that suit the locator of this body: short lists if it is convex, a far reach if it is one patch.
    pub fn locator_options(&self) -> LocatorOptions {
        let is_one_patch = self.faces.iter().all(|face| face.source.patch == 0);
        match (self.is_convex, is_one_patch) {
            (true, _) => LocatorOptions::convex(),
            (_, true) => LocatorOptions::one_patch(),
            _ => LocatorOptions::default(),
        }
    }

    /// Two corners of the bounding box of a grid of points on each face, metres, in the frame of the tables.
    pub fn extent(&self) -> [DVec3; 2] {
        extent(&self.faces.iter().map(|face| StoredSurface::new(&face.patch)).collect::<Vec<_>>())
    }

    /// How far any of some points, metres, is beyond the bounding box along any axis, in sizes; 0 if none is.
    pub fn sizes_beyond(&self, points: &[DVec3]) -> f64 {
        let [low, high] = self.extent();
        let beyond = |point: &DVec3| (low - *point).max(*point - high).max_element() / (high - low).max_element();
        points.iter().map(beyond).fold(0.0, f64::max)
    }

    /// The same body with a locator that names for each cell of space what can own the closest point. `progress` is
    /// told how much of the space is done, and how much there is.
    ///
    /// # Errors
    /// Tables that would not fit their indices.
    pub fn located(
        self,
        options: &LocatorOptions,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(Self, LocatorReport), LocatorError> {
        let (locator, report) = LocatorTable::of_faces(&self.faces, f64::from(self.size), options, None, progress)?;
        Ok((Self { locator, ..self }, report))
    }

    /// As [`Self::located`], but only for some probes, metres, for which the lists are the same; those of cells that
    /// hold none of them are good for nothing.
    ///
    /// # Errors
    /// Tables that would not fit their indices.
    pub fn located_for(
        self,
        probes: &[DVec3],
        options: &LocatorOptions,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<Self, LocatorError> {
        let (locator, _) = LocatorTable::of_faces(&self.faces, f64::from(self.size), options, Some(probes), progress)?;
        Ok(Self { locator, ..self })
    }

    /// Bakes the pieces that a model was split into.
    ///
    /// # Errors
    /// A fault of the pieces, or between them.
    pub fn of_pieces(pieces: Vec<Piece>, model: &Model, file: &str) -> Result<Self, ModelError> {
        let seam = |fault| ModelError::Seam { file: file.to_owned(), fault };
        if pieces.len() > MAX_FACES {
            return Err(seam(SeamFault::TooMany { count: pieces.len(), limit: MAX_FACES }));
        }
        let label = |index: usize| super::split::label(pieces[index].source, model);
        let patches: Vec<_> = pieces.iter().map(|piece| piece.patch.clone()).collect();
        let topology = Topology::new(&patches, &label).map_err(seam)?;
        let patch_fault = |index: usize| {
            let patch = label(index);
            move |fault| ModelError::Patch { file: file.to_owned(), patch, fault }
        };
        let bake = |index: usize, patch: &NurbsPatch| BakedPatch::new(patch).map_err(patch_fault(index));
        let baked = parallel::map(&patches, bake).into_iter().collect::<Result<Vec<_>, _>>()?;
        let is_convex = is_convex(&topology, &patches, &baked);
        let spans: Vec<_> = patches
            .iter()
            .enumerate()
            .map(|(index, patch)| {
                spline::extract(patch)
                    .map_err(|spline::UnevenSpan([u, v])| PatchFault::Uneven { u, v })
                    .map_err(patch_fault(index))
            })
            .collect::<Result<_, _>>()?;
        let side = |border: Border| -> Result<BakedSide, PatchFault> {
            let (edge, sense) = match topology.roles[border.patch][border.side] {
                BorderRole::Pole { vertex } => return Ok(BakedSide::Pole { vertex: vertex as u16 }),
                BorderRole::Edge { edge, sense } => (edge, sense),
            };
            let patch = &patches[border.patch];
            let spans = BorderSpans::new(&spans[border.patch], patch.degree, border).in_sense(sense);
            // The sides of this face that meet the border at its own 0 and 1.
            let first = if border.side < 2 { 2 } else { 0 };
            let mut poles =
                [first, first + 1].map(|side| matches!(topology.roles[border.patch][side], BorderRole::Pole { .. }));
            if sense == Sense::Reversed {
                poles.reverse();
            }
            let separator = BakedSeparator::new(patch, border, &spans, poles)?;
            Ok(BakedSide::Edge { edge: edge as u16, reversed: sense == Sense::Reversed, separator })
        };
        let mut faces = Vec::with_capacity(pieces.len());
        for (index, (piece, patch)) in pieces.iter().zip(baked).enumerate() {
            let sides = [0, 1, 2, 3].map(|side_index| side(Border { patch: index, side: side_index }));
            let [a, b, c, d] = sides;
            let sides = (|| Ok([a?, b?, c?, d?]))().map_err(patch_fault(index))?;
            faces.push(BakedFace { patch, sides, surface: piece.patch.clone(), source: piece.source });
        }
        let edges = topology
            .edges
            .iter()
            .map(|edge| {
                let spans = BorderSpans::new(&spans[edge.owner.patch], patches[edge.owner.patch].degree, edge.owner);
                let face = |border: Border| EdgeFace { face: border.patch as u16, side: border.side as u8 };
                let curve = BakedCurve::of_edge(&spans).map_err(patch_fault(edge.owner.patch))?;
                let third_derivative = curve.third_derivative().map_err(patch_fault(edge.owner.patch))?;
                Ok(BakedEdge {
                    curve,
                    third_derivative,
                    faces: [face(edge.owner), edge.partner.map_or(EdgeFace::NONE, |(border, _)| face(border))],
                    ends: edge.ends.map(|vertex| vertex as u16),
                    kind: edge.kind,
                })
            })
            .collect::<Result<_, ModelError>>()?;
        let (vertices, spokes) = vertices(&topology);
        let (low, high) = bounding_box(&patches);
        let locator = LocatorTable::of_everything(faces.len(), low.to_array(), high.to_array());
        Ok(Self { faces, edges, vertices, spokes, locator, size: topology.size as f32, is_convex, topology })
    }

    /// The span borders of all patches and curves, equal ones once, in the order in which they come.
    pub fn distinct_breaks(&self) -> Vec<Vec<f32>> {
        let of_patches = self.faces.iter().flat_map(|face| face.patch.breaks.iter());
        let separators = self.faces.iter().flat_map(|face| &face.sides).filter_map(|side| match side {
            BakedSide::Edge { separator: BakedSeparator::Ruled(curve), .. } => Some(&curve.breaks),
            _ => None,
        });
        let mut distinct: Vec<Vec<f32>> = Vec::new();
        for breaks in of_patches.chain(separators).chain(self.edges.iter().map(|edge| &edge.curve.breaks)) {
            if !distinct.contains(breaks) {
                distinct.push(breaks.clone());
            }
        }
        distinct
    }

    /// The name of each face in messages and comments.
    pub fn labels(&self, model: &Model) -> Vec<String> {
        self.faces.iter().map(|face| super::split::label(face.source, model)).collect()
    }

    /// The body as the firmware has it, with the same bits. Its numbers stay allocated permanently: for a host that
    /// bakes a few models in its life.
    ///
    /// # Errors
    /// The library's refusal of the tables: never for baked ones.
    pub fn to_body(&self) -> Result<Body<'static>, TableFault> {
        let mut faces = Vec::with_capacity(self.faces.len());
        for (index, face) in self.faces.iter().enumerate() {
            let patch = face.patch.to_patch().map_err(|error| TableFault::Patch { face: index, error })?;
            faces.push(Face { patch, sides: face.sides.each_ref().map(BakedSide::to_side) });
        }
        let edge = |edge: &BakedEdge| Edge {
            curve: edge.curve.to_curve(),
            third_derivative: edge.third_derivative[0],
            jump: edge.third_derivative[1],
            faces: edge.faces,
            ends: edge.ends,
            kind: edge.kind,
        };
        let edges: Vec<_> = self.edges.iter().map(edge).collect();
        let tables = BodyTables {
            faces: faces.leak(),
            edges: edges.leak(),
            vertices: self.vertices.clone().leak(),
            spokes: self.spokes.clone().leak(),
            locator: self.locator.to_locator(),
            size_m: self.size,
            is_convex: self.is_convex,
            crc: None,
        };
        Ok(tables.try_checked()?)
    }
}

impl BakedSide {
    /// The side as the firmware has it.
    fn to_side(&self) -> Side<'static> {
        match self {
            Self::Edge { edge, reversed, separator } => {
                Side::Edge { edge: *edge, reversed: *reversed, separator: separator.to_separator() }
            }
            Self::Pole { vertex } => Side::Pole { vertex: *vertex },
        }
    }
}

/// Vertices and spokes as the target has them.
fn vertices(topology: &Topology) -> (Vec<Vertex>, Vec<Spoke>) {
    let mut spokes = Vec::new();
    let mut vertices = Vec::with_capacity(topology.vertices.len());
    for vertex in &topology.vertices {
        let first_spoke = spokes.len() as u16;
        spokes.extend(vertex.spokes.iter().map(|spoke| Spoke {
            direction: spoke.direction.as_vec3(),
            edge: spoke.edge as u16,
            at_upper_end: spoke.at_upper_end,
        }));
        let is_open = vertex.spokes.iter().any(|spoke| topology.edges[spoke.edge].partner.is_none());
        let count = vertex.spokes.len() as u16;
        let outward = if is_open { DVec3::ZERO } else { vertex.outward }.as_vec3();
        vertices.push(Vertex { point: vertex.point.as_vec3(), outward, first_spoke, spokes: count, is_open });
    }
    (vertices, spokes)
}

// Whether a body is convex, as far as its features say.

/// See [`crate::body::BakedBody::new`] for what it takes, and what of it is proved.
fn is_convex(topology: &Topology, patches: &[NurbsPatch], baked: &[BakedPatch]) -> bool {
    let edges = topology.edges.iter().all(|edge| matches!(edge.kind, EdgeKind::Convex | EdgeKind::Smooth));
    let face = |(patch, baked): (&NurbsPatch, &BakedPatch)| {
        // A plane is straight all over, whatever its parameters do at a pole.
        is_plane(patch) || matches!(convexity(patch, baked), Convexity::Proved | Convexity::UpToRounding(_))
    };
    edges && topology.is_closed() && topology.components() == 1 && patches.iter().zip(baked).all(face)
}

/// Of the size: nine digits of a model file leave no more.
const FLAT: f64 = 1e-8;

/// Whether all control points lie in one plane, and with them, as means of them, all points.
fn is_plane(patch: &NurbsPatch) -> bool {
    let first = patch.points[0];
    let far = |a: &&DVec3, b: &&DVec3| a.distance(first).total_cmp(&b.distance(first));
    let Some(second) = patch.points.iter().max_by(far) else { return false };
    let along = (*second - first).normalize_or_zero();
    let across = |point: &DVec3| along.cross(*point - first);
    let Some(normal) = patch.points.iter().map(across).max_by(|a, b| a.length().total_cmp(&b.length())) else {
        return false;
    };
    let normal = normal.normalize_or_zero();
    patch.points.iter().all(|point| (*point - first).dot(normal).abs() <= FLAT * patch.size())
}

// The locator that needs no proof: every face is a candidate everywhere.

/// [`palpate::body::Locator`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub struct LocatorTable {
    /// The lower corner of the root cube, metres.
    pub corner: Vec3,
    /// The root cube's side, metres.
    pub side: f32,
    /// Inner nodes.
    pub nodes: Vec<[u16; 8]>,
    /// The lists of candidates, each as [`Candidate::pack`] makes it.
    pub entries: Vec<u32>,
}

impl LocatorTable {
    /// One node whose cells all list every face as a whole: complete for any probe, without a claim of convexity. The
    /// cube holds the body with half its size to spare on every side.
    pub fn of_everything(faces: usize, low: [f64; 3], high: [f64; 3]) -> Self {
        let size = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
        let corner = Vec3::from_array([0, 1, 2].map(|axis| (0.5 * (low[axis] + high[axis]) - size) as f32));
        let all = [GRID as u8; 2];
        let entry = |face: usize| Candidate {
            face: face as u16,
            lower: [0; 2],
            upper: all,
            convex: false,
            more: face + 1 < faces,
        };
        let entries = (0..faces).map(|face| entry(face).pack()).collect();
        Self { corner, side: (2.0 * size) as f32, nodes: vec![[1; 8]], entries }
    }

    /// The locator of these faces, proved cell by cell as far as it goes; see [`locator`].
    fn of_faces(
        faces: &[BakedFace],
        size: f64,
        options: &LocatorOptions,
        wanted: Option<&[DVec3]>,
        progress: &(dyn Fn(usize, usize) + Sync),
    ) -> Result<(Self, LocatorReport), LocatorError> {
        let patches: Vec<BakedPatch> = faces.iter().map(|face| face.patch.clone()).collect();
        let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
        let seams = Seams::find(&surfaces, options.seam * size);
        let creases: Vec<_> =
            faces.iter().map(|face| [Axis::U, Axis::V].map(|axis| face.surface.creases(axis))).collect();
        let baked = locator::bake(&patches, seams, &creases, options, wanted, progress)?;
        let BakedLocator { corner, side, nodes, entries, report } = baked;
        Ok((Self { corner, side, nodes, entries }, report))
    }

    /// The locator as the firmware has it; its numbers stay allocated for good.
    pub fn to_locator(&self) -> Locator<'static> {
        Locator {
            corner: self.corner,
            side: self.side,
            nodes: self.nodes.clone().leak(),
            lists: PackedLists::of(&self.entries).to_lists(),
        }
    }
}
