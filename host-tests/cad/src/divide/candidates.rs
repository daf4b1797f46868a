//! The quads that could stand on a side.

use super::plane::cost;
use super::plane::{Edge, Plane};
use crate::effort::Effort;
use glam::DVec2;
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::PI;
use std::rc::Rc;

/// A quad: its corners, its sides from each corner to the next, and what it costs.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Vertices.
    pub corners: [usize; 4],
    /// Sides.
    pub edges: [Edge; 4],
    /// More for a bad one.
    pub cost: f64,
    /// The points inside the region that it lies on.
    pub covers: Rc<[usize]>,
}

/// Whether the turn of the surface along a line matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turning {
    /// It does not.
    Free,
    /// A line along which it turns far costs more.
    Dear,
}

/// Allowed quads, and the cost of lines.
#[derive(Clone, Copy, Debug)]
pub struct Manner {
    /// Whether the turn of the surface along a line matters.
    pub turning: Turning,
    /// Whether quads may have a side of zero length: needed for a region that has no other division.
    pub triangles: bool,
}

/// Search for quads, with a memory of its results.
pub struct Candidates<'p> {
    /// The region.
    pub plane: &'p Plane,
    seen: Vec<Vec<usize>>,
    /// Lines that a quad could have as a side, each once, and their numbers by both ends.
    lines: Vec<[usize; 2]>,
    numbers: Vec<usize>,
    starting: Vec<Vec<usize>>,
    found: HashMap<Edge, Rc<[Candidate]>>,
    /// Turn of the surface along a straight line of the plane, radians.
    turn: &'p dyn Fn(DVec2, DVec2) -> f64,
    turns: HashMap<[usize; 2], f64>,
    /// By a quad's sides, starting at its corner of the lowest index.
    known: RefCell<HashMap<[Edge; 4], Worth>>,
    triangles: bool,
    effort: &'p Effort,
}

/// Cost of a quad, and the outline's vertices that it covers.
type Worth = Option<(f64, Rc<[usize]>)>;

/// Maximum number of lines from one vertex.
const LINES: usize = 24;
/// A line along which the surface turns by more than this, radians, is likely to be cut again; each radian more then
/// costs as much as `TURNED` patches.
const EASY_TURN: f64 = 1.7;
const TURNED: f64 = 2.0;
/// Extra cost of a side of zero length: about two patches.
const TRIANGLE: f64 = 2.0;
/// Minimum angle of the other two sides at such a side, radians; and elsewhere.
const SHARPEST: f64 = 0.01;
const BLUNT: f64 = 0.12;
/// The effort of weighing one.
const WEIGHED: u64 = 16;

impl<'p> Candidates<'p> {
    /// Looks which vertices see each other.
    pub fn new(plane: &'p Plane, turn: &'p dyn Fn(DVec2, DVec2) -> f64, triangles: bool, effort: &'p Effort) -> Self {
        let count = plane.vertices.len();
        let mut seen = vec![Vec::new(); count];
        for a in 0..count {
            for b in a + 1..count {
                let (of_a, of_b) = (plane.vertices[a].node, plane.vertices[b].node);
                if (of_a.is_none() || of_a != of_b) && plane.sees(a, b) {
                    seen[a].push(b);
                    seen[b].push(a);
                }
            }
        }
        for (a, list) in seen.iter_mut().enumerate() {
            let far = |b: &usize| plane.vertices[*b].point.distance(plane.vertices[a].point);
            list.sort_by(|x, y| far(x).total_cmp(&far(y)));
            list.truncate(LINES);
        }
        let (mut lines, mut numbers) = (Vec::new(), vec![usize::MAX; count * count]);
        for (a, list) in seen.iter().enumerate() {
            for b in list {
                if numbers[a * count + b] == usize::MAX {
                    (numbers[a * count + b], numbers[b * count + a]) = (lines.len(), lines.len());
                    lines.push([a, *b]);
                }
            }
        }
        let mut starting = vec![Vec::new(); count];
        for (index, border) in plane.borders.iter().enumerate() {
            starting[border.ends[0]].push(index);
        }
        Self {
            plane,
            seen,
            lines,
            numbers,
            starting,
            found: HashMap::new(),
            turn,
            turns: HashMap::new(),
            known: RefCell::default(),
            triangles,
            effort,
        }
    }

    /// The lines that a quad could have as a side, each once.
    pub fn lines(&self) -> &[[usize; 2]] {
        &self.lines
    }

    /// The number of the line between two vertices.
    pub fn number(&self, a: usize, b: usize) -> Option<usize> {
        Some(self.numbers[a * self.seen.len() + b]).filter(|number| *number != usize::MAX)
    }

    /// The vertices at an edge's start and end.
    pub fn ends(&self, edge: Edge) -> [usize; 2] {
        match edge {
            Edge::Border(index) => self.plane.borders[index].ends,
            Edge::Line(a, b) => [a, b],
        }
    }

    /// The quads on the left of an edge, the cheapest first.
    pub fn on(&mut self, edge: Edge) -> Rc<[Candidate]> {
        if let Some(found) = self.found.get(&edge) {
            return Rc::clone(found);
        }
        let mut found = self.find(edge);
        if self.triangles {
            self.find_triangles(edge, &mut found);
        }
        for quad in &mut found {
            quad.cost += quad.edges.map(|edge| self.turned(edge)).iter().sum::<f64>();
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let found: Rc<[Candidate]> = found.into();
        self.found.insert(edge, Rc::clone(&found));
        found
    }

    /// Cost of a line for the turn of the surface along it; a side of the outline already has its cuts.
    fn turned(&mut self, edge: Edge) -> f64 {
        let Edge::Line(a, b) = edge else { return 0.0 };
        let (plane, turn) = (self.plane, self.turn);
        let along = || turn(plane.vertices[a].point, plane.vertices[b].point);
        let turn = *self.turns.entry([a.min(b), a.max(b)]).or_insert_with(along);
        TURNED * (turn - EASY_TURN).max(0.0)
    }

    fn find(&self, edge: Edge) -> Vec<Candidate> {
        let [a, b] = self.ends(edge);
        let mut found = Vec::new();
        for second in self.from(b) {
            let c = self.ends(second)[1];
            if c == a || c == b || !self.turns_left(edge, second) {
                continue;
            }
            for third in self.from(c) {
                let d = self.ends(third)[1];
                if d == a || d == b || d == c || !self.turns_left(second, third) {
                    continue;
                }
                for fourth in self.between(d, a) {
                    if !self.turns_left(third, fourth) || !self.turns_left(fourth, edge) {
                        continue;
                    }
                    let (corners, edges) = ([a, b, c, d], [edge, second, third, fourth]);
                    if let Some((cost, covers)) = self.worth(corners, edges) {
                        found.push(Candidate { corners, edges, cost, covers });
                    }
                }
            }
        }
        found
    }

    /// Quads of which one side is a point, at their sharpest corner.
    fn find_triangles(&self, edge: Edge, found: &mut Vec<Candidate>) {
        let [a, b] = self.ends(edge);
        for second in self.from(b) {
            let c = self.ends(second)[1];
            if c == a || c == b {
                continue;
            }
            for third in self.between(c, a) {
                let sides = [edge, second, third];
                let angles = [2, 0, 1].map(|before| self.angle(sides[before], sides[(before + 1) % 3]));
                let Some(sharpest) = (0..3).min_by(|x, y| angles[*x].total_cmp(&angles[*y])) else { continue };
                let is_sound =
                    |k: usize| (if k == sharpest { SHARPEST } else { BLUNT }..PI - BLUNT).contains(&angles[k]);
                if !(0..3).all(is_sound) {
                    continue;
                }
                let corner = [a, b, c][sharpest];
                let [p, q, r] = [0, 1, 2].map(|k| sides[(sharpest + k) % 3]);
                let edges = [Edge::Line(corner, corner), p, q, r];
                let corners = [corner, corner, self.ends(p)[1], self.ends(q)[1]];
                if let Some((cost, covers)) = self.worth(corners, edges) {
                    found.push(Candidate { corners, edges, cost: cost + TRIANGLE, covers });
                }
            }
        }
    }

    /// The inner angle between two edges that follow each other, radians, below 0 where they turn right.
    fn angle(&self, first: Edge, second: Edge) -> f64 {
        let (into, out) = (self.slope(first, 1.0), self.slope(second, 0.0));
        let turn = into.perp_dot(out).atan2(into.dot(out));
        if turn < 0.0 { turn } else { PI - turn }
    }

    /// Cost and coverage of a quad; `None` if it is too bad, or if a vertex of the outline lies inside. Computed once
    /// for all four sides.
    fn worth(&self, corners: [usize; 4], edges: [Edge; 4]) -> Worth {
        let first = (0..4).min_by_key(|k| corners[*k]).unwrap_or(0);
        let key = [0, 1, 2, 3].map(|k| edges[(first + k) % 4]);
        if let Some(known) = self.known.borrow().get(&key) {
            return known.clone();
        }
        self.effort.spend(WEIGHED);
        let map = |s: f64, t: f64| self.plane.quad_at(&edges, &corners, s, t);
        let has_point = edges.iter().any(|edge| edge.is_point());
        let worth = cost(&map, has_point).and_then(|cost| Some((cost, self.covered(&corners, &edges)?)));
        self.known.borrow_mut().insert(key, worth.clone());
        worth
    }

    fn from(&self, vertex: usize) -> impl Iterator<Item = Edge> + '_ {
        let borders = self.starting[vertex].iter().map(|index| Edge::Border(*index));
        borders.chain(self.seen[vertex].iter().map(move |to| Edge::Line(vertex, *to)))
    }

    fn between(&self, from: usize, to: usize) -> impl Iterator<Item = Edge> + '_ {
        self.from(from).filter(move |edge| self.ends(*edge)[1] == to)
    }

    /// Whether the corner between two edges that follow each other is less than half a turn, and more than nothing.
    fn turns_left(&self, first: Edge, second: Edge) -> bool {
        let (into, out) = (self.slope(first, 1.0), self.slope(second, 0.0));
        into.perp_dot(out) > 0.1 * into.length() * out.length()
    }

    fn slope(&self, edge: Edge, t: f64) -> DVec2 {
        let step = 1e-3;
        let (low, high) = if t < 0.5 { (0.0, step) } else { (1.0 - step, 1.0) };
        self.plane.point(edge, high) - self.plane.point(edge, low)
    }

    /// The points inside the region that lie in a quad; none if a vertex of the outline does.
    fn covered(&self, corners: &[usize; 4], edges: &[Edge; 4]) -> Option<Rc<[usize]>> {
        let polygon: Vec<DVec2> =
            edges.iter().flat_map(|edge| (0..12).map(|k| self.plane.point(*edge, f64::from(k) / 12.0))).collect();
        let low = polygon.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let high = polygon.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let is_in = |point: DVec2| {
            point.cmpge(low).all() && point.cmple(high).all() && crate::outline::contains(&polygon, point)
        };
        let others = self.plane.vertices.iter().enumerate().filter(|(index, _)| !corners.contains(index));
        let mut covered = Vec::new();
        for (index, vertex) in others.filter(|(_, vertex)| is_in(vertex.point)) {
            if vertex.node.is_some() {
                return None;
            }
            covered.push(index);
        }
        Some(covered.into())
    }
}
