//! The faces of a body as the locator's search sees them.

use super::osculating::Osculating;
use super::piece::{Part, Piece, Probes, Span};
use super::stored::{BorderCorner, BorderSide, Sample, Samples, Seams, StoredSurface, at_corner};
use crate::BakedPatch;
use crate::bernstein::Tracked;
use crate::bounds::local_range;
use glam::DVec3;
use palpate::body::{Candidate, GRID};
use palpate::math::Vec3;
use palpate::patch::SplinePatch;
use std::cell::Cell;
use std::ops::Range;

/// All faces.
pub(crate) struct Faces {
    pub surfaces: Vec<StoredSurface>,
    /// The same as the firmware has them.
    pub tables: Vec<SplinePatch<'static>>,
    /// The spans of each face.
    pub spans: Vec<Vec<Piece>>,
    pub seams: Seams,
    /// 1 where the outward normal is `f_u × f_v`, −1 where it is turned round.
    pub turns: Vec<f64>,
    samples: Samples,
}

/// A part of the body that may hold the closest point.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Region<'a> {
    /// The inside of a face.
    Inside(&'a Piece),
    /// Some of an edge: a side of its owner's piece.
    Side {
        /// The owner's piece.
        piece: &'a Piece,
        /// The side.
        side: u8,
        /// Index of the seam.
        edge: u32,
    },
    /// A vertex, by index of the seam.
    Vertex(u32),
}

impl Faces {
    /// `None` if a weight is not proved positive, or the library refuses a table. `reach` is the maximum coordinate of
    /// a probe, in absolute value.
    pub(crate) fn new(patches: &[BakedPatch], seams: Seams, creases: &[[Vec<f64>; 2]], reach: f64) -> Option<Self> {
        let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
        let tables = patches.iter().map(|patch| patch.to_patch().ok()).collect::<Option<_>>()?;
        let spans = (patches.iter().zip(creases).enumerate())
            .map(|(face, (patch, creases))| spans(face, patch, seams.poles[face], creases, reach))
            .collect::<Option<Vec<_>>>()?;
        let samples = Samples::new(&surfaces);
        let turns = patches
            .iter()
            .map(|patch| if patch.orientation == palpate::patch::Orientation::Outward { 1.0 } else { -1.0 })
            .collect();
        Some(Self { surfaces, tables, spans, seams, turns, samples })
    }

    /// The whole body.
    pub(crate) fn regions(&self) -> Vec<Region<'_>> {
        let mut regions: Vec<_> = self.spans.iter().flatten().map(Region::Inside).collect();
        for (edge, members) in self.seams.edges.iter().enumerate() {
            let owner = members[0];
            let pieces = self.spans[usize::from(owner.face)].iter();
            regions.extend(pieces.filter(|piece| piece.on_border[usize::from(owner.side)]).map(|piece| Region::Side {
                piece,
                side: owner.side,
                edge: edge as u32,
            }));
        }
        regions.extend((0..self.seams.vertices.len() as u32).map(Region::Vertex));
        regions
    }

    /// [`palpate::body::Face::poles`] of a face.
    pub(super) fn poles(&self, face: usize) -> u8 {
        self.seams.poles[face].iter().rev().fold(0, |bits, is_pole| bits << 1 | u8::from(*is_pole))
    }

    /// The span at a corner of a face.
    pub(super) fn corner_span(&self, face: u16, corner: u8) -> Option<&Piece> {
        let sides = [corner & 1, 2 + (corner >> 1)];
        self.spans[usize::from(face)].iter().find(|piece| sides.iter().all(|side| piece.on_border[usize::from(*side)]))
    }

    /// The smallest piece of a face, not below `level`, whose side holds all of an interval of the face's side.
    pub(super) fn along_side(&self, face: u16, side: u8, [low, high]: [f64; 2], level: u8) -> Option<&Piece> {
        let axis = if side < 2 { 1 } else { 0 };
        let fits =
            |piece: &&Piece| piece.on_border[usize::from(side)] && piece.low[axis] <= low && high <= piece.high[axis];
        let mut piece = self.spans[usize::from(face)].iter().find(fits)?;
        while piece.level < level {
            let Some(smaller) = piece.quarters().and_then(|quarters| quarters.iter().find(fits)) else { break };
            piece = smaller;
        }
        Some(piece)
    }

    /// A point of the body near the closest one: a local minimum of the distance on its face.
    pub(super) fn reference(&self, query: DVec3) -> Option<Reference> {
        let Sample { face, parameters, .. } = *self.samples.nearest(query)?;
        let minimum = self.surfaces[usize::from(face)].descend(query, parameters, [[0.0; 2], [1.0; 2]]);
        Some(Reference { face, parameters: minimum.parameters, point: minimum.point, distance: minimum.distance })
    }
}

/// A point of the body that the closest one must beat.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub face: u16,
    pub parameters: [f64; 2],
    pub point: DVec3,
    pub distance: f64,
}

fn spans(face: usize, patch: &BakedPatch, poles: [bool; 4], creases: &[Vec<f64>; 2], reach: f64) -> Option<Vec<Piece>> {
    let degree = patch.degree.map(usize::from);
    let counts = [patch.breaks[0].len() - 1, patch.breaks[1].len() - 1];
    let mut pieces = Vec::with_capacity(counts[0] * counts[1]);
    for span in 0..counts[0] * counts[1] {
        let index = [span / counts[1], span % counts[1]];
        let border = |axis: usize, high: usize| patch.breaks[axis][index[axis] + high];
        let ranges = [0, 1].map(|axis| local_range(border(axis, 0), border(axis, 1)));
        let on_border = [index[0] == 0, index[0] + 1 == counts[0], index[1] == 0, index[1] + 1 == counts[1]];
        let mut homogeneous = Tracked::of_span(degree, &patch.coefficients.homogeneous_span(degree, span), ranges);
        let on_pole: [bool; 4] = std::array::from_fn(|side| on_border[side] && poles[side]);
        for (side, _) in on_pole.iter().enumerate().filter(|(_, on_pole)| **on_pole) {
            collapse(&mut homogeneous, side);
        }
        let is_crease = |axis: usize, high: usize| {
            let at = f64::from(border(axis, high));
            creases[axis].iter().any(|crease| (crease - at).abs() < 1e-6)
        };
        pieces.push(Piece::of_span(&Span {
            face: face as u16,
            low: [0, 1].map(|axis| border(axis, 0).into()),
            high: [0, 1].map(|axis| border(axis, 1).into()),
            on_border,
            on_pole,
            on_crease: [is_crease(0, 0), is_crease(0, 1), is_crease(1, 0), is_crease(1, 1)],
            homogeneous: &homogeneous,
            widths: ranges.map(|[low, high]| high - low),
            reach,
        })?);
    }
    Some(pieces)
}

/// Makes a side that is a point up to rounding one point exactly: the first of its line.
fn collapse(homogeneous: &mut [Tracked; 4], side: usize) {
    let [p, q] = homogeneous[0].polynomial.degree;
    let columns = q + 1;
    let line: Vec<usize> = match side {
        0 => (0..=q).collect(),
        1 => (0..=q).map(|j| p * columns + j).collect(),
        2 => (0..=p).map(|i| i * columns).collect(),
        _ => (0..=p).map(|i| i * columns + q).collect(),
    };
    let weights: Vec<f64> = line.iter().map(|index| homogeneous[3].polynomial.coefficients[*index][0]).collect();
    for component in &mut homogeneous[..3] {
        let coefficients = &mut component.polynomial.coefficients;
        let value = coefficients[line[0]][0] / weights[0];
        for (index, weight) in line.iter().zip(&weights) {
            coefficients[*index][0] = value * weight;
        }
    }
}

/// Where a region lies and what it is made of, for the distance.
impl<'a> Region<'a> {
    pub(super) fn face(&self, faces: &Faces) -> u16 {
        match self {
            Self::Inside(piece) | Self::Side { piece, .. } => piece.face,
            Self::Vertex(vertex) => faces.seams.vertices[*vertex as usize][0].face,
        }
    }

    /// Its rectangle of parameters on its face; a line or a point for edges and vertices.
    pub(super) fn rectangle(&self, faces: &Faces) -> [[f64; 2]; 2] {
        match *self {
            Self::Inside(piece) => [piece.low, piece.high],
            Self::Side { piece, side, .. } => {
                let (axis, at) = (usize::from(side / 2), f64::from(side % 2));
                let [mut low, mut high] = [piece.low, piece.high];
                (low[axis], high[axis]) = (at, at);
                [low, high]
            }
            Self::Vertex(vertex) => [at_corner(faces.seams.vertices[vertex as usize][0].corner); 2],
        }
    }

    /// The side of its face that it lies on, if no other face meets it there; 4 and more for a vertex between two, by
    /// its corner.
    pub(super) fn open_side(&self, faces: &Faces) -> Option<u8> {
        let edges = &faces.seams.edges;
        match *self {
            Self::Inside(_) => None,
            Self::Side { side, edge, .. } => (edges[edge as usize].len() == 1).then_some(side),
            Self::Vertex(vertex) => {
                let members = &faces.seams.vertices[vertex as usize];
                let is_open = |member: &BorderCorner| {
                    let sides = [member.corner & 1, 2 + (member.corner >> 1)];
                    let ends = |edge: &Vec<BorderSide>| match edge[..] {
                        [only] => only.face == member.face && sides.contains(&only.side),
                        _ => false,
                    };
                    edges.iter().any(ends)
                };
                members.iter().any(is_open).then(|| 4 + members[0].corner)
            }
        }
    }

    /// Pieces of it, or `None` if it cannot be divided.
    pub(super) fn divided(&self) -> Option<Vec<Self>> {
        match *self {
            Self::Inside(piece) => Some(piece.quarters()?.iter().map(Region::Inside).collect()),
            Self::Side { piece, side, edge } => {
                let quarters = piece.quarters()?.iter().filter(|quarter| quarter.on_border[usize::from(side)]);
                Some(quarters.map(|piece| Self::Side { piece, side, edge }).collect())
            }
            Self::Vertex(_) => None,
        }
    }

    pub(super) fn diameter(&self) -> f64 {
        match self {
            Self::Inside(piece) | Self::Side { piece, .. } => piece.diameter,
            Self::Vertex(_) => 0.0,
        }
    }
}

/// The inputs of a test: the probes and points that the closest one must beat.
pub(super) struct Query<'a> {
    pub probes: Probes,
    pub references: &'a [Reference],
    /// How much nearer a point must be for a comparison to count, metres: what the rounding of the tables has parted at
    /// seams.
    pub seam: f64,
    /// No probe is farther from any point, metres.
    pub farthest: f64,
    /// Rectangles of faces on which half the squared distance is known to be convex for all of the probes.
    pub convex: &'a [(u16, Rectangle)],
    /// Whether rectangles of plane faces may be proved in their plane.
    pub in_plane: bool,
}

impl Query<'_> {
    /// Whether no probe has its closest point in a region.
    pub(super) fn excludes(&self, region: &Region<'_>, faces: &Faces) -> bool {
        match *region {
            Region::Inside(piece) => {
                self.is_far(piece, Part::Inside, 0..1)
                    || self.is_sloping(piece)
                    || self.is_far(piece, Part::Inside, 1..9)
            }
            Region::Side { piece, side, edge } => {
                let part = Part::Side(side);
                self.is_far(piece, part, 0..1)
                    || self.is_sloping_along(piece, side)
                    || self.slopes_into(piece, side, SURE)
                    || self.is_far(piece, part, 1..9)
                    || self.leaves_edge(piece, side, edge, faces)
            }
            Region::Vertex(vertex) => self.leaves_vertex(vertex, faces),
        }
    }

    /// Whether every probe is nearer to one of the references than to any point of a part.
    ///
    /// `w² (φ − φ₀)` is affine in the probe: no bound of a distance is lost twice.
    fn is_far(&self, piece: &Piece, part: Part, which: std::ops::Range<usize>) -> bool {
        let references = &self.references[which.start.min(self.references.len())..which.end.min(self.references.len())];
        references.iter().any(|reference| {
            let point = reference.point;
            let half_square = 0.5 * point.length_squared() + self.seam * self.farthest;
            let is_beyond = |[square, x, y, z, weight]: &[f64; 5]| {
                let slope = DVec3::new(*x, *y, *z) - point * *weight;
                let middle = square - half_square * weight - self.probes.centre.dot(slope);
                middle - self.probes.half.dot(slope.abs()) > piece.place.slack
            };
            piece.place.on(part).all(|row| row.iter().all(is_beyond))
        })
    }

    /// Whether the distance falls in the same direction everywhere on the inside of a piece.
    fn is_sloping(&self, piece: &Piece) -> bool {
        (0..2).any(|axis| {
            let across = 2 * axis;
            if piece.on_crease[across] || piece.on_crease[across + 1] {
                return false;
            }
            self.sign(piece, axis, free_of_poles(piece, axis)) != 0
        })
    }

    /// The sign of `φ`'s derivative along an axis, 0 if it is not proved.
    pub(super) fn sign(&self, piece: &Piece, axis: usize, part: Part) -> i8 {
        self.sign_beyond(piece, axis, part, SURE)
    }

    fn sign_beyond(&self, piece: &Piece, axis: usize, part: Part, margin: f64) -> i8 {
        piece.gradient[axis].sign(part, &self.probes, margin * self.farthest)
    }

    fn is_sloping_along(&self, piece: &Piece, side: u8) -> bool {
        let axis = if side < 2 { 1 } else { 0 };
        let crease = piece.on_crease[2 * axis] || piece.on_crease[2 * axis + 1];
        !crease && self.sign(piece, axis, Part::Side(side)) != 0
    }

    /// Whether the distance falls from all of a side into the face.
    fn slopes_into(&self, piece: &Piece, side: u8, margin: f64) -> bool {
        let axis = usize::from(side / 2);
        let ends = [0, 1].map(|end| piece.on_pole[2 * (1 - axis) + end]);
        let inward = if side.is_multiple_of(2) { -1 } else { 1 };
        self.sign_beyond(piece, axis, Part::SideWithout(side, ends), margin) == inward
    }

    /// Whether it falls into one of the other faces of an edge.
    fn leaves_edge(&self, piece: &Piece, side: u8, edge: u32, faces: &Faces) -> bool {
        let axis = if side < 2 { 1 } else { 0 };
        let interval = [piece.low[axis], piece.high[axis]];
        faces.seams.edges[edge as usize][1..].iter().any(|member| {
            let [low, high] = interval;
            let interval = if member.reversed { [1.0 - high, 1.0 - low] } else { interval };
            let other = faces.along_side(member.face, member.side, interval, piece.level);
            other.is_some_and(|other| self.slopes_into(other, member.side, OTHER))
        })
    }

    fn leaves_vertex(&self, vertex: u32, faces: &Faces) -> bool {
        let members = &faces.seams.vertices[vertex as usize];
        let far = |member: &super::stored::BorderCorner| {
            faces
                .corner_span(member.face, member.corner)
                .is_some_and(|piece| self.is_far(piece, Part::Corner(member.corner), 0..9))
        };
        if members.first().is_some_and(far) {
            return true;
        }
        members.iter().enumerate().any(|(index, member)| {
            let Some(piece) = faces.corner_span(member.face, member.corner) else { return false };
            let margin = if index == 0 { SURE } else { OTHER };
            (0..2).any(|axis| {
                let inward = if member.corner >> axis & 1 == 0 { -1 } else { 1 };
                self.sign_beyond(piece, axis, Part::Corner(member.corner), margin) == inward
            })
        })
    }
}

/// A slope counts if it is more than this, relative to the longest vectors it could be the product of: what rounding
/// the table to `f32` can turn a tangent by from one span to the next.
const SURE: f64 = 1e-6;
/// The same between faces, whose borders lie apart by the seam: so that the gain across exceeds it.
const OTHER: f64 = 1e-4;

/// The part of a piece on which a gradient is to be bounded: it vanishes on a pole it runs around.
pub(super) fn free_of_poles(piece: &Piece, axis: usize) -> Part {
    let sides = [2 * (1 - axis), 2 * (1 - axis) + 1];
    match sides.map(|side| piece.on_pole[side]) {
        [true, false] => Part::Without(sides[0] as u8),
        [false, true] => Part::Without(sides[1] as u8),
        _ => Part::Inside,
    }
}

// Rectangles of parameters on the grid of a list's entries.

/// A rectangle on the grid: minimum and maximum step along `u` and `v`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Rectangle {
    pub lower: [u8; 2],
    pub upper: [u8; 2],
}

impl Rectangle {
    /// The smallest one that holds a rectangle of parameters.
    pub(super) fn around([low, high]: [[f64; 2]; 2]) -> Self {
        let grid = f64::from(GRID);
        // A rectangle that ends on the grid, as all borders do, ends there; anything else is rounded outward by more
        // than rounding.
        Self {
            lower: low.map(|x| (x * grid + if x == 1.0 { 0.0 } else { -1e-9 }).floor().max(0.0) as u8),
            upper: high.map(|x| (x * grid + if x == 0.0 { 0.0 } else { 1e-9 }).ceil().min(grid) as u8),
        }
    }

    pub(super) fn hull(&self, other: &Self) -> Self {
        Self {
            lower: [0, 1].map(|axis| self.lower[axis].min(other.lower[axis])),
            upper: [0, 1].map(|axis| self.upper[axis].max(other.upper[axis])),
        }
    }

    /// Whether all of another is in it.
    pub(super) fn holds(&self, other: &Self) -> bool {
        (0..2).all(|axis| self.lower[axis] <= other.lower[axis] && other.upper[axis] <= self.upper[axis])
    }

    pub(crate) fn parameters(&self) -> [[f64; 2]; 2] {
        [self.lower, self.upper].map(|corner| corner.map(|step| f64::from(step) / f64::from(GRID)))
    }
}

// The regions of a cell as places where descents may begin, in a tree of boxes.

/// Starts of a leaf: those that came from one part of a face follow each other.
const TOGETHER: usize = 4;

/// All of them.
pub(super) struct Starts {
    starts: Vec<Start>,
    /// The root first, each before those in it.
    boxes: Vec<TurnedBox>,
    /// The one that was found nearer last: it is likely to be again.
    last: Cell<usize>,
}

/// A region.
pub(super) struct Start {
    /// Its rectangle with a step of the grid around it, so that a descent may leave it for a neighbour's minimum.
    pub candidate: Candidate,
    /// Its rectangle.
    pub rectangle: Rectangle,
    near: Osculating,
}

/// Some of them, which follow each other, in a box, metres.
struct TurnedBox {
    frame: [Vec3; 3],
    /// Along the frame's axes.
    middle: Vec3,
    half: Vec3,
    /// Of a leaf; empty if it holds boxes.
    starts: Range<usize>,
    /// The first box behind those in it.
    next: usize,
}

impl Starts {
    pub(super) fn new<'a>(faces: &Faces, regions: impl Iterator<Item = &'a Region<'a>>) -> Self {
        let starts: Vec<_> = regions.map(|region| Start::new(faces, region)).collect();
        let mut boxes = Vec::new();
        if !starts.is_empty() {
            TurnedBox::add(&mut boxes, &starts, 0..starts.len());
        }
        Self { starts, boxes, last: Cell::new(0) }
    }

    /// One that is nearer to a probe than a distance, metres, if there is any.
    pub(super) fn any_nearer(&self, distance: f32, probe: Vec3) -> Option<&Start> {
        let is_nearer = |start: &Start| start.near.is_within(distance, probe) && start.near.distance(probe) < distance;
        if let Some(last) = self.starts.get(self.last.get()).filter(|start| is_nearer(start)) {
            return Some(last);
        }
        let nearer = self.about(distance, probe).find(|index| is_nearer(&self.starts[*index]));
        self.last.set(nearer.unwrap_or_default());
        nearer.map(|index| &self.starts[index])
    }

    /// Those nearer than a distance, with theirs, the nearest first.
    pub(super) fn nearer(&self, distance: f32, probe: Vec3) -> Vec<(f32, &Start)> {
        let starts = self.about(distance, probe).map(|index| &self.starts[index]);
        let within = starts.filter(|start| start.near.is_within(distance, probe));
        let mut nearer: Vec<_> =
            within.map(|start| (start.near.distance(probe), start)).filter(|(to, _)| *to < distance).collect();
        nearer.sort_by(|a, b| a.0.total_cmp(&b.0));
        nearer
    }

    /// The starts in leaves that may be within a distance, by rising index.
    fn about(&self, distance: f32, probe: Vec3) -> impl Iterator<Item = usize> {
        let mut next = 0;
        let leaves = std::iter::from_fn(move || {
            loop {
                let around = self.boxes.get(next)?;
                let is_within = around.is_within(distance, probe);
                next = if is_within { next + 1 } else { around.next };
                if is_within && !around.starts.is_empty() {
                    return Some(around.starts.clone());
                }
            }
        });
        leaves.flatten()
    }
}

impl Start {
    fn new(faces: &Faces, region: &Region<'_>) -> Self {
        let face = region.face(faces);
        let rectangle = region.rectangle(faces);
        let around = Rectangle::around(rectangle);
        let Rectangle { lower, upper } = around;
        let candidate = Candidate {
            face,
            lower: lower.map(|step| step.saturating_sub(1)),
            upper: upper.map(|step| (step + 1).min(GRID as u8)),
            convex: false,
            more: false,
        };
        let surface = &faces.surfaces[usize::from(face)];
        let near = match region {
            Region::Inside(piece) => piece.near(surface),
            Region::Side { .. } | Region::Vertex(_) => Osculating::new(surface, rectangle),
        };
        Self { candidate, rectangle: around, near }
    }
}

impl TurnedBox {
    /// Adds one with all that it holds.
    fn add(boxes: &mut Vec<Self>, all: &[Start], starts: Range<usize>) {
        let middle = starts.start + starts.len() / 2;
        let frame = all[middle].near.frame();
        let bounds = all[starts.clone()].iter().map(|start| start.near.bounds(&frame));
        let [low, high] =
            bounds.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
        let is_leaf = starts.len() <= TOGETHER;
        let held = if is_leaf { starts.clone() } else { 0..0 };
        let index = boxes.len();
        boxes.push(Self { frame, middle: 0.5 * (low + high), half: 0.5 * (high - low), starts: held, next: 0 });
        if !is_leaf {
            // Faces apart, if there are several.
            let borders =
                (starts.start + 1..starts.end).filter(|at| all[*at].candidate.face != all[*at - 1].candidate.face);
            let middle = borders.min_by_key(|border| border.abs_diff(middle)).unwrap_or(middle);
            Self::add(boxes, all, starts.start..middle);
            Self::add(boxes, all, middle..starts.end);
        }
        boxes[index].next = boxes.len();
    }

    /// Whether any of it may be nearer than a distance.
    fn is_within(&self, distance: f32, probe: Vec3) -> bool {
        let along = Vec3::from_array(self.frame.map(|axis| axis.dot(probe)));
        let beyond = ((along - self.middle).abs() - self.half).max(Vec3::ZERO);
        beyond.length_squared() <= distance.max(0.0) * distance.max(0.0)
    }
}
