//! Flaws of a body as a whole, though every patch and every seam is right: the body intersects itself, its pieces
//! intersect or contain each other, or it is open, perhaps unintentionally.
//!
//! The search works on facets (`facets`); a cut counts only if the surfaces themselves meet there (`crossing`). So it
//! finds flaws larger than the facets, and proves nothing.

use crate::jet::Jet;
use crate::model::Unit;
use crate::patch::NurbsPatch;
use crate::topology::{Border, Topology};
use crate::{Axis, parallel};
use glam::{DMat3, DVec3};
use palpate::body::EdgeKind;
use std::f64::consts::TAU;

/// All flaws of a body.
pub fn find(patches: &[NurbsPatch], topology: &Topology) -> Vec<Flaw> {
    let facets = Facets::of(patches);
    let crossings = find_crossings(patches, &facets, topology);
    let mut flaws = Vec::new();
    if let Some(first) = crossings.first() {
        flaws.push(Flaw::Crossing { patches: first.patches, pairs: crossings.len(), at: first.at });
    }
    // Where pieces cut each other a point of one says nothing of the rest of it.
    flaws.extend(find_nested(patches, &facets, topology, &crossings));
    flaws.extend(find_gap(patches, topology));
    flaws
}

// A flaw of a body, and its words.

/// A flaw of a body. Patches go by their indices.
#[derive(Clone, Debug, PartialEq)]
pub enum Flaw {
    /// Two patches, or a patch and itself, cut each other.
    Crossing {
        /// The patches.
        patches: [usize; 2],
        /// How many pairs of patches do.
        pairs: usize,
        /// Where, metres.
        at: DVec3,
    },
    /// A piece lies in another, both of them solid; or one that is hollow lies in none.
    Nested {
        /// A patch of the piece.
        patch: usize,
        /// How many solid pieces it lies in, less the hollows.
        inside: i32,
        /// Whether its normals point inward, as those of a hollow do.
        hollow: bool,
    },
    /// Edges with one face.
    Open {
        /// How many.
        edges: usize,
        /// One of them: patch and side.
        first: [usize; 2],
        /// The two that are nearest to one another, patch and side each, and how far they are apart, metres.
        nearest: Option<([[usize; 2]; 2], f64)>,
    },
}

impl Flaw {
    /// Whether the flaw breaks what the patches' proofs assume about the body: a point inside may then be classified as
    /// outside.
    pub const fn is_wrong(&self) -> bool {
        matches!(self, Self::Crossing { .. } | Self::Nested { .. })
    }

    /// In words, in a unit; `label` names a patch, `centre` is where the patches' frame lies, metres.
    pub fn describe(&self, label: &dyn Fn(usize) -> String, centre: DVec3, unit: Unit) -> String {
        let (per_metre, unit) = (unit.per_metre(), unit.symbol());
        let side = |[patch, side]: [usize; 2]| {
            format!("side {} of patch {}", ["u = 0", "u = 1", "v = 0", "v = 1"][side], label(patch))
        };
        let length = |metres: f64| format!("{:.4} {unit}", metres * per_metre);
        match self {
            Self::Crossing { patches: [a, b], pairs, at } => {
                let [x, y, z] = ((*at + centre) * per_metre).to_array();
                let who = if a == b {
                    format!("patch {} cuts itself", label(*a))
                } else {
                    format!("patch {} and patch {} cut each other", label(*a), label(*b))
                };
                let more = if *pairs > 1 { format!(", and {} more pairs do", pairs - 1) } else { String::new() };
                format!(
                    "{who} near {x:.4}, {y:.4}, {z:.4} {unit}{more}: inside the body there is surface, and points deep inside may count as outside"
                )
            }
            Self::Nested { patch, hollow: true, .. } => {
                format!(
                    "the closed piece with patch {} is inside out, and no hollow: it lies in no other piece",
                    label(*patch)
                )
            }
            Self::Nested { patch, inside, .. } => format!(
                "the closed piece with patch {} lies in {}: turn `flip` of all its patches if it is a hollow, or leave it out",
                label(*patch),
                if *inside == 1 { "another piece".to_owned() } else { format!("{inside} others") }
            ),
            Self::Open { edges, first, nearest } => {
                let near = nearest.map_or_else(String::new, |([a, b], gap)| {
                    format!("; {} and {} are {} apart: an open seam?", side(a), side(b), length(gap))
                });
                format!("the body is open: {edges} edges have one face, the first is {}{near}", side(*first))
            }
        }
    }
}

// Patches as triangles: watertight where the patches are, for neighbours have the same spans along the edge they
// share.

/// A cell of a patch, two triangles.
#[derive(Clone, Copy, Debug)]
struct Cell {
    /// Its corners: `u` low and high, `v` low first.
    pub corners: [DVec3; 4],
    /// Which of its corners lie on the patch's border.
    pub on_border: [bool; 4],
    /// Its middle.
    pub parameters: [f64; 2],
    pub low: DVec3,
    pub high: DVec3,
}

/// The cells of all patches.
struct Facets {
    pub patches: Vec<Vec<Cell>>,
    pub boxes: Vec<[DVec3; 2]>,
}

/// Cells a span along each parameter, of a body with few spans; and how many cells a body has at most, some seconds'
/// work.
const FINEST: usize = 8;
const MOST_CELLS: usize = 1 << 18;

impl Facets {
    fn of(patches: &[NurbsPatch]) -> Self {
        let spans = |patch: &NurbsPatch, axis| patch.borders(axis).len() - 1;
        let all: usize = patches.iter().map(|patch| spans(patch, Axis::U) * spans(patch, Axis::V)).sum();
        let steps = (1..=FINEST).rev().find(|steps| all * steps * steps <= MOST_CELLS).unwrap_or(1);
        let patches = parallel::map(patches, |_, patch| cells(patch, steps));
        let bound = |cells: &Vec<Cell>| {
            let empty = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            cells.iter().fold(empty, |[low, high], cell| [low.min(cell.low), high.max(cell.high)])
        };
        let boxes = patches.iter().map(bound).collect();
        Self { patches, boxes }
    }
}

impl Cell {
    /// Its triangles, in the sense of `f_u × f_v`.
    const fn triangles(&self) -> [[DVec3; 3]; 2] {
        let [a, b, c, d] = self.corners;
        [[a, c, d], [a, d, b]]
    }
}

fn cells(patch: &NurbsPatch, steps: usize) -> Vec<Cell> {
    let along = |axis| -> Vec<f64> {
        let borders = patch.borders(axis);
        let inside = |pair: &[f64]| {
            let (start, width) = (pair[0], pair[1] - pair[0]);
            (0..steps).map(move |k| start + width * k as f64 / steps as f64)
        };
        borders.windows(2).flat_map(inside).chain([1.0]).collect()
    };
    let (along_u, along_v) = (along(Axis::U), along(Axis::V));
    let rows: Vec<Vec<DVec3>> =
        along_u.iter().map(|u| along_v.iter().map(|v| Jet::of(patch, *u, *v).point).collect()).collect();
    let mut cells = Vec::with_capacity((along_u.len() - 1) * (along_v.len() - 1));
    let is_end = |along: &[f64], k: usize| k == 0 || k == along.len() - 1;
    for (i, pair_u) in along_u.windows(2).enumerate() {
        for (j, pair_v) in along_v.windows(2).enumerate() {
            let corners = [rows[i][j], rows[i][j + 1], rows[i + 1][j], rows[i + 1][j + 1]];
            let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
            let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
            let parameters = [0.5 * (pair_u[0] + pair_u[1]), 0.5 * (pair_v[0] + pair_v[1])];
            let on_border = [[i, j], [i, j + 1], [i + 1, j], [i + 1, j + 1]]
                .map(|[i, j]| is_end(&along_u, i) || is_end(&along_v, j));
            cells.push(Cell { corners, on_border, parameters, low, high });
        }
    }
    cells
}

// Where patches cut each other.
//
// Facets that cut each other are a hint: between two curved surfaces that lie near each other facets cut where the
// surfaces do not. From each hint Newton's method looks for a point of both surfaces, inside both patches, at which
// they are not tangent. A border behind which the surface goes on smoothly counts as inside: an edge that is sharp may
// only touch.

/// Two patches that cut each other, and where.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    pub patches: [usize; 2],
    pub at: DVec3,
}

/// Points of facets nearer than this, in sizes, are one: neighbours share their edge to 1e-6.
const SAME: f64 = 2e-6;
/// Surfaces meet where Newton's method leaves less than this, in sizes.
const MET: f64 = 1e-9;
/// A point this near to a border, of the parameter's range, is on it: bodies that only touch meet at borders.
const BORDER: f64 = 1e-3;
/// Normals at a smaller sine are those of surfaces that touch.
const TRANSVERSAL: f64 = 1e-3;
/// On one patch, places with parameters nearer than this are one place.
const APART: f64 = 1e-2;
/// Hints that are followed for one pair of patches: along a cut each is as good as the next.
const HINTS: usize = 16;

/// One crossing of every pair of patches that cut each other.
fn find_crossings(patches: &[NurbsPatch], facets: &Facets, topology: &Topology) -> Vec<Crossing> {
    let (size, pieces) = (topology.size, topology.pieces());
    let mut smooth = vec![[false; 4]; patches.len()];
    for edge in topology.edges.iter().filter(|edge| edge.kind == EdgeKind::Smooth) {
        for border in [edge.owner].into_iter().chain(edge.partner.map(|(border, _)| border)) {
            smooth[border.patch][border.side] = true;
        }
    }
    let meets = |[low_a, high_a]: [DVec3; 2], [low_b, high_b]: [DVec3; 2]| {
        low_a.cmple(high_b).all() && low_b.cmple(high_a).all()
    };
    let of_patch = |a: usize, cells: &Vec<Cell>| -> Vec<Crossing> {
        let beyond = (a..patches.len()).filter(|b| meets(facets.boxes[a], facets.boxes[*b]));
        let crossing = |b: usize| {
            let [low, high] = facets.boxes[b];
            let near: Vec<&Cell> = cells.iter().filter(|cell| meets([cell.low, cell.high], [low, high])).collect();
            let [low, high] = facets.boxes[a];
            let others: Vec<&Cell> =
                facets.patches[b].iter().filter(|cell| meets([cell.low, cell.high], [low, high])).collect();
            let pairs = near.iter().flat_map(|cell| others.iter().map(move |other| (*cell, *other)));
            let hints = pairs
                .filter(|(cell, other)| meets([cell.low, cell.high], [other.low, other.high]))
                .filter(|(cell, other)| !are_neighbours(cell, other, a == b, SAME * size) && cut(cell, other));
            let both = Both { patches: [&patches[a], &patches[b]], smooth: [smooth[a], smooth[b]], is_one: a == b };
            let is_one_piece = pieces[a] == pieces[b];
            let mut found = hints.take(HINTS).filter_map(|(cell, other)| both.meeting(cell, other, is_one_piece, size));
            found.next().map(|at| Crossing { patches: [a, b], at })
        };
        beyond.filter_map(crossing).collect()
    };
    parallel::map(&facets.patches, of_patch).into_iter().flatten().collect()
}

/// Whether they share a corner, of two patches one on both borders: inside, corners that coincide may lie on a cut.
fn are_neighbours(a: &Cell, b: &Cell, is_one: bool, tolerance: f64) -> bool {
    let corners = |cell: &Cell| {
        let all = cell.corners.into_iter().zip(cell.on_border);
        all.filter(move |(_, on_border)| is_one || *on_border).map(|(corner, _)| corner).collect::<Vec<_>>()
    };
    let others = corners(b);
    corners(a).iter().any(|corner| others.iter().any(|other| corner.distance(*other) <= tolerance))
}

/// Whether any of their triangles cut each other.
fn cut(a: &Cell, b: &Cell) -> bool {
    let pierces = |of: [DVec3; 3], triangle: [DVec3; 3]| {
        [[of[0], of[1]], [of[1], of[2]], [of[2], of[0]]].into_iter().any(|segment| pierced(triangle, segment))
    };
    let (a, b) = (a.triangles(), b.triangles());
    a.iter().any(|first| b.iter().any(|second| pierces(*first, *second) || pierces(*second, *first)))
}

/// Whether a segment goes through a triangle. The plane counts as its upper side, so that of the segments of a surface
/// whose corners lie on it one goes through.
fn pierced([a, b, c]: [DVec3; 3], [from, to]: [DVec3; 2]) -> bool {
    let volume = |p: DVec3, q: DVec3, r: DVec3, s: DVec3| (q - p).cross(r - p).dot(s - p);
    let (above, below) = (volume(a, b, c, from), volume(a, b, c, to));
    if (above >= 0.0) == (below >= 0.0) {
        return false;
    }
    let sides = [volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

/// Two patches, which of their sides are smooth, and whether they are one.
struct Both<'a> {
    patches: [&'a NurbsPatch; 2],
    smooth: [[bool; 4]; 2],
    is_one: bool,
}

impl Both<'_> {
    /// A point inside both patches at which their surfaces cut each other, from the middles of two cells. At a seam of
    /// one piece its two patches always meet.
    fn meeting(&self, a: &Cell, b: &Cell, is_one_piece: bool, size: f64) -> Option<DVec3> {
        let mut at = [a.parameters, b.parameters];
        for _ in 0..30 {
            let jets = [0, 1].map(|k| Jet::of(self.patches[k], at[k][0], at[k][1]));
            let off = jets[1].point - jets[0].point;
            let tangents = [jets[0].tangent_u, jets[0].tangent_v, -jets[1].tangent_u, -jets[1].tangent_v];
            if off.length() <= MET * size {
                let normals = jets.map(|jet| jet.tangent_u.cross(jet.tangent_v).normalize_or_zero());
                let sides = [0, 1].map(|k| sides_of(at[k]));
                let on_seam = sides.iter().all(|sides| sides.iter().any(|on| *on)) && is_one_piece;
                let is_inside = (0..2).all(|k| (0..4).all(|side| !sides[k][side] || self.smooth[k][side]));
                let is_apart = !self.is_one || (0..2).any(|axis| (at[0][axis] - at[1][axis]).abs() > APART);
                let crosses = normals[0].cross(normals[1]).length() > TRANSVERSAL;
                return (is_inside && !on_seam && is_apart && crosses).then_some(jets[0].point);
            }
            // The shortest step in all four parameters that closes the gap: δ = Jᵀ (J Jᵀ)⁻¹ off.
            let outer = |v: DVec3| DMat3::from_cols(v * v.x, v * v.y, v * v.z);
            let gram = tangents.iter().fold(DMat3::ZERO, |sum, tangent| sum + outer(*tangent));
            let pull = gram.inverse() * off;
            if !pull.is_finite() {
                return None;
            }
            for (k, tangent) in tangents.iter().enumerate() {
                let parameter = &mut at[k / 2][k % 2];
                *parameter = (*parameter + tangent.dot(pull)).clamp(0.0, 1.0);
            }
        }
        None
    }
}

/// The sides that parameters lie on: `u = 0`, `u = 1`, `v = 0`, `v = 1`.
fn sides_of([u, v]: [f64; 2]) -> [bool; 4] {
    [u < BORDER, u > 1.0 - BORDER, v < BORDER, v > 1.0 - BORDER]
}

// Open edges, and which of them may be two sides of one gap.

/// Maximum distance between two open borders, relative to the body's size, for them to be reported as open edges of one
/// seam.
const GAPING: f64 = 0.02;
/// Number of compared points of a border.
const SAMPLES: usize = 16;

/// The flaw of a body of several patches with open edges.
fn find_gap(patches: &[NurbsPatch], topology: &Topology) -> Option<Flaw> {
    let open: Vec<Border> =
        topology.edges.iter().filter(|edge| edge.partner.is_none()).map(|edge| edge.owner).collect();
    let first = *open.first().filter(|_| patches.len() > 1)?;
    let lines: Vec<Vec<DVec3>> = open.iter().map(|border| line(*border, &patches[border.patch])).collect();
    let place = |border: Border| [border.patch, border.side];
    let mut nearest: Option<([[usize; 2]; 2], f64)> = None;
    for (i, one) in lines.iter().enumerate() {
        for (j, other) in lines.iter().enumerate().skip(i + 1) {
            let forward = one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let backward = one.iter().zip(other.iter().rev()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let gap = forward.min(backward);
            if gap <= nearest.map_or(GAPING * topology.size, |(_, least)| least) {
                nearest = Some(([place(open[i]), place(open[j])], gap));
            }
        }
    }
    Some(Flaw::Open { edges: open.len(), first: place(first), nearest })
}

fn line(border: Border, patch: &NurbsPatch) -> Vec<DVec3> {
    (0..=SAMPLES).map(|k| border.point(patch, k as f64 / SAMPLES as f64)).collect()
}

// Closed pieces that lie in each other.
//
// The winding number of a closed piece is 1 inside one whose normals point out, −1 inside one whose normals point in,
// a hollow. A solid piece lies where all others together wind 0 times, a hollow where they do once.

/// Patches of a piece from which it is asked where it lies.
const NESTING_SAMPLES: usize = 16;

/// Flaws of the pieces that no other cuts.
fn find_nested(patches: &[NurbsPatch], facets: &Facets, topology: &Topology, crossings: &[Crossing]) -> Vec<Flaw> {
    let turn = |patch: usize| if patches[patch].flip { -1.0 } else { 1.0 };
    let piece_of = &topology.pieces();
    let mut pieces: Vec<usize> = piece_of.clone();
    pieces.sort_unstable();
    pieces.dedup();
    if pieces.len() < 2 {
        return Vec::new();
    }
    let is_cut = |piece: usize| {
        crossings.iter().any(|crossing| {
            let [a, b] = crossing.patches.map(|patch| piece_of[patch]);
            a != b && (a == piece || b == piece)
        })
    };
    let is_closed =
        |piece: usize| topology.edges.iter().all(|edge| edge.partner.is_some() || piece_of[edge.owner.patch] != piece);
    let closed: Vec<usize> = pieces.into_iter().filter(|piece| is_closed(*piece)).collect();
    let patches_of = |piece: usize| (0..piece_of.len()).filter(move |patch| piece_of[*patch] == piece);
    let winding = |piece: usize, at: DVec3| -> f64 {
        patches_of(piece).map(|patch| turn(patch) * angles(facets, patch, at)).sum::<f64>() / TAU
    };
    let volume = |piece: usize| patches_of(piece).map(|patch| turn(patch) * flux(facets, patch)).sum::<f64>();
    let flaw = |&piece: &usize| {
        let hollow = volume(piece) < 0.0;
        // Where pieces touch, a point says nothing; one that is clear of the others does.
        let places = patches_of(piece).take(NESTING_SAMPLES).filter_map(|patch| facets.patches[patch].first());
        let counts = places.map(|cell| {
            let at = cell.corners.iter().sum::<DVec3>() * 0.25;
            closed.iter().filter(|other| **other != piece).map(|other| winding(*other, at)).sum::<f64>().round() as i32
        });
        let inside = if hollow { counts.max() } else { counts.min() }?;
        let is_right = inside == i32::from(hollow);
        let patch = patches_of(piece).next()?;
        (!is_right && !is_cut(piece)).then_some(Flaw::Nested { patch, inside, hollow })
    };
    closed.iter().filter_map(flaw).collect()
}

/// Half of the solid angles of a patch's facets, seen from a point (A. van Oosterom and J. Strackee, *The solid angle
/// of a plane triangle*, 1983).
fn angles(facets: &Facets, patch: usize, at: DVec3) -> f64 {
    let half = |[a, b, c]: [DVec3; 3]| {
        let [a, b, c] = [a - at, b - at, c - at];
        let [x, y, z] = [a.length(), b.length(), c.length()];
        a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    facets.patches[patch].iter().flat_map(|cell| cell.triangles()).map(half).sum()
}

/// Six times the volume between a patch's facets and the origin.
fn flux(facets: &Facets, patch: usize) -> f64 {
    facets.patches[patch].iter().flat_map(|cell| cell.triangles()).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}
