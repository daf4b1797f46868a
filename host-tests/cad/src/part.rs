//! A part as the file has it: faces, loops, oriented edges and vertices, in millimetres, placements applied.

use crate::effort::{Effort, Memory};
use crate::nurbs::{Curve, Surface};
use glam::DVec3;
use std::hash::{Hash as _, Hasher};

/// A part.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Its solids or shells.
    pub solids: Vec<Solid>,
    /// Faces, in the order of the file.
    pub faces: Vec<Face>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Vertices.
    pub vertices: Vec<DVec3>,
    /// Distance below which the file's points are the same, millimetres.
    pub precision: f64,
    /// Remarks for the person at the terminal.
    pub remarks: Vec<String>,
    /// How the side of surfaces that are swept twice is chosen.
    pub sweep: Sweep,
    /// Whether there was one to choose.
    pub is_swept_twice: bool,
    /// Whether faces to which cuts come back without end are tiled with the cuts that they have.
    pub is_loose: bool,
    /// The remaining effort for it.
    pub effort: Effort,
    /// Tilings and patches that were found before.
    pub memory: Memory,
}

/// How a face takes one of two sweeps that are the same but for their sense.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sweep {
    /// The one that has an edge of it at its start.
    #[default]
    Start,
    /// The one of which its outline encloses less than half.
    Outline,
    /// The one that bulges out of the solid.
    Outward,
    /// The one that bulges into it.
    Inward,
}

/// A solid, or a shell by itself.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Its name.
    pub name: String,
    /// Whether the file says that its faces enclose it.
    pub is_closed: bool,
}

/// A face: the part of a surface that lies on the left of its loops, seen from where the surface's normal points.
#[derive(Clone, Debug)]
pub struct Face {
    /// Its name and number in the part: unique.
    pub name: String,
    /// Its number in the file, if that is known.
    pub number: Option<u64>,
    /// The solid that it belongs to.
    pub solid: usize,
    /// Type of its surface, in the file's words.
    pub kind: &'static str,
    /// The whole surface.
    pub surface: Surface,
    /// Whether the outward normal is against the surface's.
    pub flip: bool,
    /// Oriented edges, chained: each ends at the start of the next.
    pub loops: Vec<Vec<Use>>,
    /// Whether the loops run against the file's, which were turned round.
    pub is_healed: bool,
}

/// An edge as a loop runs along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Use {
    /// Its index.
    pub edge: usize,
    /// Against its own direction.
    pub reversed: bool,
}

/// An edge between two vertices, or a closed one from a vertex to itself.
#[derive(Clone, Debug)]
pub struct Edge {
    /// The curve that it is a stretch of.
    pub curve: Curve,
    /// The stretch; on a closed curve it may run beyond the curve's range.
    pub range: [f64; 2],
    /// The vertices at its start and end.
    pub ends: [usize; 2],
    /// Whether the curve is closed.
    pub is_round: bool,
    /// Its number in the file, if that is known.
    pub number: Option<u64>,
}

impl Edge {
    /// All of a curve between two vertices; round, if they are one.
    pub fn whole(curve: Curve, ends: [usize; 2], number: Option<u64>) -> Self {
        Self { range: curve.range(), curve, ends, is_round: ends[0] == ends[1], number }
    }

    /// The stretch between two shares of it.
    pub fn stretch(&self, [from, to]: [f64; 2], ends: [usize; 2]) -> Self {
        let [low, high] = self.range;
        let range = [from, to].map(|share| low + (high - low) * share);
        Self { range, ends, ..self.clone() }
    }

    /// Position and derivative at a share of the way, 0 to 1; of a closed edge any number, round and round.
    pub fn at(&self, share: f64) -> [DVec3; 2] {
        let [low, high] = self.range;
        let [first, last] = self.curve.range();
        let t = low + (high - low) * share;
        let is_beyond = self.is_round && !(first..=last).contains(&t);
        let t = if is_beyond { first + (t - first).rem_euclid(last - first) } else { t };
        let [point, slope, _] = self.curve.at(t);
        [point, slope * (high - low)]
    }

    /// A hash of its curve and stretch.
    pub fn hash(&self, hasher: &mut impl Hasher) {
        let Curve { degree, knots, points } = &self.curve;
        (degree, knots.len(), self.is_round).hash(hasher);
        let points = points.iter().flat_map(|point| point.to_array());
        knots.iter().copied().chain(points).chain(self.range).for_each(|number| number.to_bits().hash(hasher));
    }

    /// The share at which it is nearest to a point, and the distance there.
    pub fn nearest(&self, point: DVec3) -> (f64, f64) {
        const SAMPLES: usize = 64;
        let far = (0..=SAMPLES).map(|k| k as f64 / SAMPLES as f64);
        let far = far.map(|share| (self.at(share)[0].distance_squared(point), share));
        let (_, mut share) = far.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 0.0));
        for _ in 0..16 {
            let [here, slope] = self.at(share);
            let step = (point - here).dot(slope) / slope.length_squared().max(f64::MIN_POSITIVE);
            let next = share + step.clamp(-1.0 / SAMPLES as f64, 1.0 / SAMPLES as f64);
            share = if self.is_closed() { next } else { next.clamp(0.0, 1.0) };
        }
        (share, self.at(share)[0].distance(point))
    }

    /// How long it is, by 32 chords.
    pub fn length(&self) -> f64 {
        let at = |k: i32| self.at(f64::from(k) / 32.0)[0];
        (0..32).map(|k| at(k).distance(at(k + 1))).sum()
    }

    /// Its label in messages; `index` is its index in the part.
    pub fn label(&self, index: usize) -> String {
        label_of_edge(index, self.number)
    }

    /// Whether it ends at its start.
    pub const fn is_closed(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

impl Part {
    /// The vertices at a use's start and end.
    pub fn ends(&self, used: Use) -> [usize; 2] {
        let [a, b] = self.edges[used.edge].ends;
        if used.reversed { [b, a] } else { [a, b] }
    }
}

impl Face {
    /// Its label in messages.
    pub fn label(&self) -> String {
        label(&self.name, self.number)
    }
}

/// An edge by its number in the file, or by its place in the part.
pub fn label_of_edge(index: usize, number: Option<u64>) -> String {
    number.map_or_else(|| format!("edge {}", index + 1), |number| format!("edge #{number}"))
}

/// A face's name with its number in the file.
pub fn label(name: &str, number: Option<u64>) -> String {
    number.map_or_else(|| name.to_owned(), |number| format!("{name} (#{number})"))
}
