//! The part during division: nodes, wires that two sides share, regions with their outlines, and finally quads.
//!
//! A wire is one curve in space for both its faces, whose results from it agree bit for bit. A cut through a wire cuts
//! it in all outlines at once, so that no line ends in the middle of a side.

use crate::part::Part;
use crate::path::Path;
use glam::{DVec2, DVec3};

/// The part and its cuts.
#[derive(Clone)]
pub struct Mesh<'p> {
    /// The part.
    pub part: &'p Part,
    /// Where wires end.
    pub nodes: Vec<DVec3>,
    /// Curves; those that were cut stay in the list and in no outline.
    pub wires: Vec<Wire>,
    /// A region a face.
    pub regions: Vec<Region>,
    /// Regions that hand no cuts on.
    pub loose: Vec<usize>,
}

/// A curve in space over `[0, 1]`.
#[derive(Clone, Debug)]
pub struct Wire {
    /// The nodes at its start and end.
    pub ends: [usize; 2],
    /// Its curve.
    pub source: Source,
}

/// Curve of a wire.
#[derive(Clone, Debug)]
pub enum Source {
    /// A stretch of an edge of the part.
    Edge {
        /// The edge.
        edge: usize,
        /// Shares of it.
        range: [f64; 2],
    },
    /// A curve inside a face.
    Inside {
        /// The face.
        face: usize,
        /// In its parameters.
        path: Path,
    },
}

/// One side of a region or a quad.
#[derive(Clone, Debug)]
pub struct Side {
    /// The wire, and whether the side runs against it; `None` where the side is one point of the surface.
    pub wire: Option<(usize, bool)>,
    /// The nodes at its start and end.
    pub ends: [usize; 2],
    /// In the face's parameters, in the side's direction.
    pub path: Path,
}

/// A face's outlines, the face on their left in its parameters, and its quads.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// The outer outline first, when it is known; then holes.
    pub loops: Vec<Vec<Side>>,
    /// Its quads.
    pub quads: Vec<Quad>,
}

/// Four sides round, in the face's parameters counter-clockwise: bottom, right, top, left.
#[derive(Clone, Debug)]
pub struct Quad {
    /// Sides.
    pub sides: [Side; 4],
}

impl Side {
    /// The other way round.
    pub fn reversed(&self) -> Self {
        let wire = self.wire.map(|(wire, against)| (wire, !against));
        Self { wire, ends: [self.ends[1], self.ends[0]], path: self.path.reversed() }
    }

    /// Moved in the parameters.
    pub fn shifted(&self, by: DVec2) -> Self {
        Self { path: self.path.shifted(by), ..self.clone() }
    }

    /// A side that is one point.
    pub fn pole(node: usize, from: DVec2, to: DVec2) -> Self {
        Self { wire: None, ends: [node; 2], path: Path::line(from, to) }
    }
}

impl Quad {
    /// The face's parameters at `(s, t)` of the square: Coons's map over the sides' paths.
    pub fn map(&self, s: f64, t: f64) -> DVec2 {
        let [bottom, right, top, left] = &self.sides;
        let across = bottom.path.at(s) * (1.0 - t) + top.path.at(1.0 - s) * t;
        let up = left.path.at(1.0 - t) * (1.0 - s) + right.path.at(t) * s;
        let corners = bottom.path.start() * ((1.0 - s) * (1.0 - t))
            + bottom.path.end() * (s * (1.0 - t))
            + top.path.end() * ((1.0 - s) * t)
            + top.path.start() * (s * t);
        across + up - corners
    }
}

impl<'p> Mesh<'p> {
    /// Nodes and wires of a part, uncut; no outlines yet.
    pub fn new(part: &'p Part) -> Self {
        let whole = |(edge, of): (usize, &crate::part::Edge)| Wire {
            ends: of.ends,
            source: Source::Edge { edge, range: [0.0, 1.0] },
        };
        let wires = part.edges.iter().enumerate().map(whole).collect();
        let regions = vec![Region::default(); part.faces.len()];
        Self { part, nodes: part.vertices.clone(), wires, regions, loose: Vec::new() }
    }

    /// Position and derivative on a wire.
    pub fn at(&self, wire: usize, t: f64) -> [DVec3; 2] {
        match &self.wires[wire].source {
            Source::Edge { edge, range: [from, to] } => {
                let [point, slope] = self.part.edges[*edge].at(from + (to - from) * t);
                [point, slope * (to - from)]
            }
            Source::Inside { face, path } => {
                let jet = self.part.faces[*face].surface.at(path.at(t));
                let slope = path.slope(t);
                [jet.point, jet.first[0] * slope.x + jet.first[1] * slope.y]
            }
        }
    }

    /// A node on a face.
    pub fn add_node(&mut self, point: DVec3) -> usize {
        self.nodes.push(point);
        self.nodes.len() - 1
    }

    /// A wire inside a face, and the side that runs along it.
    pub fn add_inside(&mut self, face: usize, ends: [usize; 2], path: Path) -> Side {
        self.wires.push(Wire { ends, source: Source::Inside { face, path: path.clone() } });
        Side { wire: Some((self.wires.len() - 1, false)), ends, path }
    }

    /// Cuts a wire at rising parameters, in every outline and quad-less region; gives the pieces.
    pub fn cut(&mut self, wire: usize, at: &[f64]) -> Vec<usize> {
        let old = self.wires[wire].clone();
        let borders: Vec<f64> = [0.0].into_iter().chain(at.iter().copied()).chain([1.0]).collect();
        let mut nodes = vec![old.ends[0]];
        for t in at {
            let point = self.at(wire, *t)[0];
            nodes.push(self.add_node(point));
        }
        nodes.push(old.ends[1]);
        let mut pieces = Vec::new();
        for (k, pair) in borders.windows(2).enumerate() {
            let source = match &old.source {
                Source::Edge { edge, range: [from, to] } => {
                    let [a, b] = [pair[0], pair[1]].map(|t| from + (to - from) * t);
                    Source::Edge { edge: *edge, range: [a, b] }
                }
                Source::Inside { face, path } => Source::Inside { face: *face, path: path.part(pair[0], pair[1]) },
            };
            self.wires.push(Wire { ends: [nodes[k], nodes[k + 1]], source });
            pieces.push(self.wires.len() - 1);
        }
        for region in 0..self.regions.len() {
            let mut loops = std::mem::take(&mut self.regions[region].loops);
            for outline in &mut loops {
                while let Some(place) = outline.iter().position(|side| side.wire.is_some_and(|(of, _)| of == wire)) {
                    let parts = self.cut_side(region, &outline[place], &borders, &pieces);
                    outline.splice(place..=place, parts);
                }
            }
            self.regions[region].loops = loops;
        }
        pieces
    }

    /// Moves the start of a closed wire of an edge.
    pub fn turn(&mut self, wire: usize, start: f64) {
        if start == 0.0 {
            return;
        }
        let point = self.at(wire, start)[0];
        let node = self.add_node(point);
        let Source::Edge { range, .. } = &mut self.wires[wire].source else { return };
        let width = range[1] - range[0];
        *range = [range[0] + start * width, range[1] + start * width];
        self.wires[wire].ends = [node; 2];
        for face in 0..self.regions.len() {
            let mut loops = std::mem::take(&mut self.regions[face].loops);
            for side in loops.iter_mut().flatten() {
                let Some((of, against)) = side.wire else { continue };
                if of != wire {
                    continue;
                }
                let first = if against { 1.0 - start } else { start };
                let whole = side.path.end() - side.path.start();
                let round = |t: f64| {
                    let t = first + t;
                    side.path.at(t - t.floor()) + whole * t.floor()
                };
                let path = Path::sampled(round);
                let point = |t: f64| self.at(wire, if against { 1.0 - t } else { t })[0];
                side.path = path.polished(&self.part.faces[face].surface, point);
                side.ends = [node; 2];
            }
            self.regions[face].loops = loops;
        }
    }

    /// A side along a wire that was cut.
    pub fn cut_side(&self, region: usize, side: &Side, borders: &[f64], pieces: &[usize]) -> Vec<Side> {
        let against = side.wire.is_some_and(|(_, against)| against);
        let surface = &self.part.faces[region].surface;
        let piece = |k: usize| {
            let (low, high) = (borders[k], borders[k + 1]);
            let ends = self.wires[pieces[k]].ends;
            let (range, ends) =
                if against { ([1.0 - high, 1.0 - low], [ends[1], ends[0]]) } else { ([low, high], ends) };
            let path = side.path.part(range[0], range[1]);
            let point = |t: f64| self.at(pieces[k], if against { 1.0 - t } else { t })[0];
            let path = match self.wires[pieces[k]].source {
                Source::Edge { .. } => path.polished(surface, point),
                Source::Inside { .. } => path,
            };
            Side { wire: Some((pieces[k], against)), ends, path }
        };
        let order: Vec<usize> = if against { (0..pieces.len()).rev().collect() } else { (0..pieces.len()).collect() };
        order.into_iter().map(piece).collect()
    }

    /// How long a wire is, and through what angle its direction turns, by 64 chords.
    pub fn extent(&self, wire: usize) -> (f64, f64) {
        let slopes: Vec<_> = (0..=64).map(|k| self.at(wire, f64::from(k) / 64.0)).collect();
        let length = slopes.windows(2).map(|pair| pair[0][0].distance(pair[1][0])).sum();
        let turn = slopes.windows(2).map(|pair| {
            let [a, b] = [pair[0][1].normalize_or_zero(), pair[1][1].normalize_or_zero()];
            a.cross(b).length().atan2(a.dot(b))
        });
        (length, turn.sum())
    }

    /// The angle through which a stretch of a wire turns.
    pub fn turn_of(&self, wire: usize, [from, to]: [f64; 2]) -> f64 {
        let slope = |k: i32| self.at(wire, from + (to - from) * f64::from(k) / 16.0)[1].normalize_or_zero();
        (0..16).map(|k| slope(k).angle_between(slope(k + 1))).filter(|turn| turn.is_finite()).sum()
    }

    /// The parameters that cut a wire into pieces of one length.
    pub fn even(&self, wire: usize, pieces: usize) -> Vec<f64> {
        let points: Vec<_> = (0..=256).map(|k| self.at(wire, f64::from(k) / 256.0)[0]).collect();
        let mut lengths = vec![0.0];
        for pair in points.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
        }
        let whole = lengths[lengths.len() - 1];
        let place = |k: usize| {
            let wanted = whole * k as f64 / pieces as f64;
            let next = lengths.partition_point(|length| *length < wanted).clamp(1, 256);
            let (low, high) = (lengths[next - 1], lengths[next]);
            let share = if high > low { (wanted - low) / (high - low) } else { 0.5 };
            (next as f64 - 1.0 + share) / 256.0
        };
        (1..pieces).map(place).collect()
    }
}
