//! A ring of quads along an outline, and the rest tiled within straight sides.
//!
//! Where an outline goes on smoothly at a vertex, a line has to leave there: two smooth vertices in a row leave a
//! search without points inside nothing to choose. Behind a ring, a quad to each side, the sides are straight and
//! every vertex is a corner.

use super::candidates::Candidate;
use super::plane::{Border, Edge, Plane, Vertex};
use super::quality;
use glam::DVec2;
use std::f64::consts::TAU;

/// A plane with the vertices of a ring, the ring's quads, and the region within as a plane of its own.
pub struct Ring {
    /// The whole, the ring's vertices behind the outline's.
    pub plane: Plane,
    /// Its quads.
    pub quads: Vec<Candidate>,
    /// What it leaves.
    pub within: Plane,
}

impl Ring {
    /// The ring whose vertices lie so far in, as a part of the way across; `None` if a quad of it would fold.
    pub fn new(outline: &Plane, depth: f64) -> Option<Self> {
        let count = outline.vertices.len();
        let points: Vec<DVec2> = (0..count).map(|index| inward(outline, index, depth)).collect::<Option<_>>()?;
        let mut plane = outline.clone();
        plane.vertices.extend(super::steiner::vertices(points.clone()));
        let mut quads = Vec::with_capacity(outline.borders.len());
        for (index, border) in outline.borders.iter().enumerate() {
            let [a, b] = border.ends;
            let (corners, edges) = (
                [a, b, count + b, count + a],
                [
                    Edge::Border(index),
                    Edge::Line(b, count + b),
                    Edge::Line(count + b, count + a),
                    Edge::Line(count + a, a),
                ],
            );
            let cost = quality::cost(&|s, t| plane.quad_at(&edges, &corners, s, t), false)?;
            quads.push(Candidate { corners, edges, cost, covers: Vec::new().into() });
        }
        let within = within(outline, &points);
        within.is_simple().then_some(Self { plane, quads, within })
    }

    /// The whole with the quads of the region within.
    pub fn joined(&self, found: &[Candidate]) -> (Plane, Vec<Candidate>) {
        // Behind the outline's vertices as many of the ring, and points that were put inside.
        let first = self.plane.vertices.len() / 2;
        let mut plane = self.plane.clone();
        plane.vertices.extend(self.within.vertices[first..].iter().copied());
        let place = |vertex: usize| first + vertex;
        let edge = |edge: &Edge| {
            let [a, b] = match *edge {
                Edge::Border(index) => self.within.borders[index].ends,
                Edge::Line(a, b) => [a, b],
            };
            Edge::Line(place(a), place(b))
        };
        let moved = found.iter().map(|quad| Candidate {
            corners: quad.corners.map(place),
            edges: quad.edges.each_ref().map(edge),
            cost: quad.cost,
            covers: Vec::new().into(),
        });
        let quads = self.quads.iter().cloned().chain(moved).collect();
        (plane, quads)
    }
}

/// A point on the line that halves the angle at a vertex.
fn inward(plane: &Plane, index: usize, depth: f64) -> Option<DVec2> {
    let Vertex { point, angle, .. } = plane.vertices[index];
    let [out, back] = angle?;
    let whole = out.perp_dot(back).atan2(out.dot(back)).rem_euclid(TAU);
    let whole = if whole < 1e-9 { TAU } else { whole };
    let way = DVec2::from_angle(0.5 * whole).rotate(out);
    let far = super::steiner::hit(plane, point, way)?;
    // No farther than its sides are long: a wide region has a narrow ring.
    let sides = plane.borders.iter().filter(|border| border.ends.contains(&index));
    let length =
        sides.clone().map(|border| border.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum::<f64>());
    let length = length.fold(f64::INFINITY, f64::min);
    // Nor so far that it would meet the ring of another loop.
    let others = plane.polygons.iter().filter(|polygon| !polygon.contains(&point)).flatten();
    let clear = others.flat_map(|other| sides.clone().map(|border| distance(*other, &border.points)));
    let clear = clear.fold(f64::INFINITY, f64::min);
    Some(point + way * (depth * far).min(0.5 * length).min(depth * clear))
}

/// Of a point from a line through points.
fn distance(point: DVec2, line: &[DVec2]) -> f64 {
    let of = |pair: &[DVec2]| {
        let way = pair[1] - pair[0];
        let along = ((point - pair[0]).dot(way) / way.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        point.distance(pair[0] + way * along)
    };
    line.windows(2).map(of).fold(f64::INFINITY, f64::min)
}

/// The region between the ring's inner sides.
fn within(outline: &Plane, points: &[DVec2]) -> Plane {
    let mut vertices: Vec<Vertex> =
        points.iter().map(|point| Vertex { point: *point, node: Some(0), angle: None }).collect();
    // Different nodes: those of one node do not see each other.
    (vertices.iter_mut().enumerate()).for_each(|(index, vertex)| vertex.node = Some(index));
    let mut borders = Vec::with_capacity(outline.borders.len());
    for border in &outline.borders {
        let [a, b] = border.ends;
        let way = (points[b] - points[a]).normalize_or_zero();
        vertices[a].angle = Some([way, vertices[a].angle.map_or(way, |angle| angle[1])]);
        vertices[b].angle = Some([vertices[b].angle.map_or(-way, |angle| angle[0]), -way]);
        borders.push(Border { points: vec![points[a], points[b]], ..border.clone() });
    }
    let loops = outline.borders.iter().map(|border| border.place[0]).max().map_or(0, |last| last + 1);
    let polygon = |index: usize| {
        outline.borders.iter().filter(|border| border.place[0] == index).map(|border| points[border.ends[0]]).collect()
    };
    Plane { vertices, borders, polygons: (0..loops).map(polygon).collect() }
}
