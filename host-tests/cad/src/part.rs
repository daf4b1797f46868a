//! A part as the file has it: faces, loops, oriented edges and vertices, in millimetres, placements applied.

use crate::nurbs::{Curve, Surface};
use glam::DVec3;

/// A part.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// The names of its solids or shells.
    pub solids: Vec<String>,
    /// Faces, in the order of the file.
    pub faces: Vec<Face>,
    /// Edges.
    pub edges: Vec<Edge>,
    /// Vertices.
    pub vertices: Vec<DVec3>,
    /// What the file counts as one point, millimetres.
    pub precision: f64,
    /// Remarks for the person at the terminal.
    pub remarks: Vec<String>,
}

/// A face: the part of a surface that lies on the left of its loops, seen from where the surface's normal points.
#[derive(Clone, Debug)]
pub struct Face {
    /// Its name and number in the part: unique.
    pub name: String,
    /// Its number in the file, if that is known.
    pub number: Option<u64>,
    /// What its surface is, in the file's words.
    pub kind: &'static str,
    /// The whole surface.
    pub surface: Surface,
    /// Whether the outward normal is against the surface's.
    pub flip: bool,
    /// Oriented edges, chained: each ends where the next begins.
    pub loops: Vec<Vec<Use>>,
}

/// An edge as a loop runs along it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Its index.
    pub edge: usize,
    /// Against its own direction.
    pub reversed: bool,
}

/// An edge between two vertices, or a closed one from a vertex to itself.
#[derive(Clone, Debug)]
pub struct Edge {
    /// The curve, from one end to the other.
    pub curve: Curve,
    /// The vertices where it begins and ends.
    pub ends: [usize; 2],
}

impl Edge {
    /// Position and derivative at a share of the way, 0 to 1; of a closed edge any number, round and round.
    pub fn at(&self, share: f64) -> [DVec3; 2] {
        let [low, high] = self.curve.range();
        let share = if self.is_closed() && !(0.0..=1.0).contains(&share) { share.rem_euclid(1.0) } else { share };
        let [point, first, _] = self.curve.at(low + (high - low) * share);
        [point, first * (high - low)]
    }

    /// Whether it ends where it began.
    pub const fn is_closed(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

impl Part {
    /// The vertices where a use begins and ends.
    pub fn ends(&self, used: Use) -> [usize; 2] {
        let [a, b] = self.edges[used.edge].ends;
        if used.reversed { [b, a] } else { [a, b] }
    }
}

impl Face {
    /// What messages call it.
    pub fn label(&self) -> String {
        label(&self.name, self.number)
    }
}

/// A face's name with its number in the file.
pub fn label(name: &str, number: Option<u64>) -> String {
    number.map_or_else(|| name.to_owned(), |number| format!("{name} (#{number})"))
}
