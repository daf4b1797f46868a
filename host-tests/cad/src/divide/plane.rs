//! A region in a plane: its parameters, stretched so that lengths along both are about those in space.

use crate::mesh::Mesh;
use glam::DVec2;
use std::f64::consts::TAU;

/// Factors from parameters to millimetres: the mean of the tangents' lengths along the outline.
pub fn scale(mesh: &Mesh<'_>, face: usize) -> DVec2 {
    let surface = &mesh.part.faces[face].surface;
    let (mut sum, mut count) = (DVec2::ZERO, 0.0);
    for side in mesh.regions[face].loops.iter().flatten() {
        for k in 0..8 {
            let jet = surface.at(side.path.at((f64::from(k) + 0.5) / 8.0));
            sum += DVec2::new(jet.first[0].length(), jet.first[1].length());
            count += 1.0;
        }
    }
    (sum / f64::max(count, 1.0)).max(DVec2::splat(f64::MIN_POSITIVE))
}

/// One side of the outline in the plane.
#[derive(Clone, Debug)]
pub struct Border {
    /// The vertices at its start and end.
    pub ends: [usize; 2],
    /// Points along it, both ends included, equally spaced in its parameter; two if it is straight.
    pub points: Vec<DVec2>,
    /// Which loop, and which side of it.
    pub place: [usize; 2],
}

/// A directed side that needs a quad on its left: of the outline, or a line between two vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Edge {
    /// A side of the outline.
    Border(usize),
    /// A straight line.
    Line(usize, usize),
}

impl Edge {
    /// Whether it has no length: the side of a quad that is a triangle.
    pub const fn is_point(self) -> bool {
        matches!(self, Self::Line(a, b) if a == b)
    }
}

/// A vertex in the plane.
#[derive(Clone, Copy, Debug)]
pub struct Vertex {
    /// Where.
    pub point: DVec2,
    /// The mesh's node; `None` for a point that may be added inside.
    pub node: Option<usize>,
    /// First and last direction of its inner angle: along the outline, and back along it. `None` inside.
    pub angle: Option<[DVec2; 2]>,
}

/// The region.
#[derive(Clone, Debug)]
pub struct Plane {
    /// Vertices: of the outline, then inside.
    pub vertices: Vec<Vertex>,
    /// Sides of the outline.
    pub borders: Vec<Border>,
    /// The loops as polygons.
    pub polygons: Vec<Vec<DVec2>>,
}

impl Plane {
    /// A face's region.
    pub fn new(mesh: &Mesh<'_>, face: usize, scale: DVec2) -> Self {
        let (mut vertices, mut borders, mut polygons) = (Vec::new(), Vec::new(), Vec::new());
        for (index, sides) in mesh.regions[face].loops.iter().enumerate() {
            let first = vertices.len();
            let mut polygon = Vec::new();
            for (k, side) in sides.iter().enumerate() {
                let before = &sides[(k + sides.len() - 1) % sides.len()];
                let along = |slope: DVec2, chord: DVec2| {
                    let slope = if slope.length() > 1e-9 * chord.length() { slope } else { chord };
                    (slope * scale).normalize_or_zero()
                };
                let out = along(side.path.slope(0.0), side.path.end() - side.path.start());
                let back = along(-before.path.slope(1.0), before.path.start() - before.path.end());
                let point = side.path.start() * scale;
                vertices.push(Vertex { point, node: Some(side.ends[0]), angle: Some([out, back]) });
                let mut points: Vec<_> = side.path.polyline().map(|uv| uv * scale).collect();
                polygon.extend(points.iter().copied());
                points.push(side.path.end() * scale);
                let ends = [first + k, first + (k + 1) % sides.len()];
                borders.push(Border { ends, points, place: [index, k] });
            }
            polygons.push(polygon);
        }
        Self { vertices, borders, polygons }
    }

    /// Whether a point is inside the outline and outside the holes.
    pub fn contains(&self, point: DVec2) -> bool {
        let mut inside = self.polygons.iter().map(|polygon| crate::outline::contains(polygon, point));
        inside.next() == Some(true) && inside.all(|inside| !inside)
    }

    /// Whether the straight line between two vertices runs inside all the way.
    pub fn sees(&self, a: usize, b: usize) -> bool {
        let (p, q) = (self.vertices[a].point, self.vertices[b].point);
        let way = q - p;
        if way.length() < 1e-9 || !self.leaves(a, way) || !self.leaves(b, -way) || !self.contains(p.lerp(q, 0.5)) {
            return false;
        }
        let touches = |border: &Border| {
            let last = border.points.len() - 2;
            border.points.windows(2).enumerate().any(|(k, pair)| {
                // A side that begins here is left at an angle already.
                let own = k == 0 && (border.ends[0] == a || border.ends[0] == b)
                    || k == last && (border.ends[1] == a || border.ends[1] == b);
                !own && crate::outline::meet([p, q], [pair[0], pair[1]])
            })
        };
        !self.borders.iter().any(touches)
    }

    /// Whether no two sides cross.
    pub fn is_simple(&self) -> bool {
        self.borders.iter().enumerate().all(|(index, border)| {
            self.borders[index + 1..].iter().all(|other| {
                let is_next = border.ends.iter().any(|end| other.ends.contains(end));
                let pairs = || border.points.windows(2).flat_map(|a| other.points.windows(2).map(move |b| (a, b)));
                is_next || !pairs().any(|(a, b)| crate::outline::meet([a[0], a[1]], [b[0], b[1]]))
            })
        })
    }

    /// A point of an edge, of its parameter beyond the ends too.
    pub fn point(&self, edge: Edge, t: f64) -> DVec2 {
        let line = |a: DVec2, b: DVec2, t: f64| a + (b - a) * t;
        match edge {
            Edge::Line(a, b) => line(self.vertices[a].point, self.vertices[b].point, t),
            Edge::Border(index) => {
                let points = &self.borders[index].points;
                let x = t * (points.len() - 1) as f64;
                let k = (x.floor().max(0.0) as usize).min(points.len() - 2);
                line(points[k], points[k + 1], x - k as f64)
            }
        }
    }

    /// A point of a quad, by Coons's map over its edges.
    pub fn quad_at(&self, edges: &[Edge; 4], corners: &[usize; 4], s: f64, t: f64) -> DVec2 {
        let [bottom, right, top, left] = *edges;
        let corner = |k: usize| self.vertices[corners[k]].point;
        let ruled = self.point(bottom, s) * (1.0 - t)
            + self.point(top, 1.0 - s) * t
            + self.point(left, 1.0 - t) * (1.0 - s)
            + self.point(right, t) * s;
        let bilinear = corner(0) * ((1.0 - s) * (1.0 - t))
            + corner(1) * (s * (1.0 - t))
            + corner(2) * (s * t)
            + corner(3) * ((1.0 - s) * t);
        ruled - bilinear
    }

    /// Whether a direction points into the region at a vertex, five degrees at least from both sides there.
    fn leaves(&self, vertex: usize, way: DVec2) -> bool {
        const LEAST: f64 = 0.087;
        let Some([out, back]) = self.vertices[vertex].angle else { return true };
        let turn = |from: DVec2, to: DVec2| from.perp_dot(to).atan2(from.dot(to)).rem_euclid(std::f64::consts::TAU);
        let whole = turn(out, back);
        let whole = if whole < 1e-9 { std::f64::consts::TAU } else { whole };
        let here = turn(out, way);
        here > LEAST && here < whole - LEAST
    }
}

// How good a quad is: the least sine between the lines of its map, 1 for a rectangle, below 0 where it folds.

/// Over a grid of 7 × 7 points, the border's included. Where a side is one point the grid keeps off it.
pub fn of_map(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool) -> f64 {
    above(map, has_pole, f64::NEG_INFINITY)
}

/// The same; once it is found to lie below `floor`, what was found so far.
fn above(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool, floor: f64) -> f64 {
    // The corners first: there most are told to fold.
    const LINES: [i32; 7] = [0, 6, 3, 1, 5, 2, 4];
    let step = 1e-4;
    let mut least: f64 = 1.0;
    for i in LINES {
        for j in LINES {
            let keep = if has_pole { 0.05 } else { step };
            let [s, t] = [i, j].map(|k| (f64::from(k) / 6.0).clamp(keep, 1.0 - keep));
            let du = map(s + step, t) - map(s - step, t);
            let dv = map(s, t + step) - map(s, t - step);
            let sine = du.perp_dot(dv) / (du.length() * dv.length()).max(f64::MIN_POSITIVE);
            least = least.min(sine);
            if least < floor {
                return least;
            }
        }
    }
    least
}

/// Cost of a quad: one patch, more if it is slanted, slightly more if it is long. `None` if it is too bad.
pub fn cost(map: &dyn Fn(f64, f64) -> DVec2, has_pole: bool) -> Option<f64> {
    const LEAST: f64 = 0.12;
    let sine = above(map, has_pole, LEAST);
    if sine < LEAST {
        return None;
    }
    let lengths = [map(1.0, 0.5).distance(map(0.0, 0.5)), map(0.5, 1.0).distance(map(0.5, 0.0))];
    let aspect = (lengths[0] / lengths[1]).max(lengths[1] / lengths[0]);
    Some(1.0 + 2.0 * (1.0 - sine) * (1.0 - sine) + 0.05 * aspect.ln())
}

// Points inside a region that quads may use: half-way in from each vertex of the outline, and the middles of where it
// is wide.

/// Points half-way between each vertex and the middle of the region, along the line that halves its angle.
pub fn inward(plane: &Plane, depth: f64) -> Vec<DVec2> {
    let mut points: Vec<DVec2> = Vec::new();
    for vertex in &plane.vertices {
        let Some([out, back]) = vertex.angle else { continue };
        let whole = out.perp_dot(back).atan2(out.dot(back)).rem_euclid(TAU);
        let whole = if whole < 1e-9 { TAU } else { whole };
        let way = DVec2::from_angle(0.5 * whole).rotate(out);
        let Some(far) = hit(plane, vertex.point, way) else { continue };
        let point = vertex.point + way * (depth * far);
        let near = 0.1 * far;
        if plane.contains(point) && points.iter().all(|other| other.distance(point) > near) {
            points.push(point);
        }
    }
    points
}

/// The middles of the widest places, each apart from those before.
pub fn middles(plane: &Plane, count: usize) -> Vec<DVec2> {
    const GRID: usize = 40;
    let points = || plane.polygons[0].iter();
    let low = points().copied().fold(DVec2::INFINITY, DVec2::min);
    let high = points().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    let all: Vec<DVec2> = plane.polygons.concat();
    let mut found: Vec<DVec2> = Vec::new();
    for _ in 0..count {
        let mut best = (0.0, DVec2::ZERO);
        for k in 0..GRID * GRID {
            let share = DVec2::new(((k % GRID) as f64 + 0.5) / GRID as f64, ((k / GRID) as f64 + 0.5) / GRID as f64);
            let point = low + (high - low) * share;
            let clear = all.iter().chain(&found).map(|other| other.distance(point)).fold(f64::INFINITY, f64::min);
            if clear > best.0 && plane.contains(point) {
                best = (clear, point);
            }
        }
        if best.0 > 0.0 {
            found.push(best.1);
        }
    }
    found
}

/// As vertices.
pub fn vertices(points: Vec<DVec2>) -> impl Iterator<Item = Vertex> {
    points.into_iter().map(|point| Vertex { point, node: None, angle: None })
}

/// How far a ray goes before it meets the outline.
pub fn hit(plane: &Plane, from: DVec2, way: DVec2) -> Option<f64> {
    let mut least = f64::INFINITY;
    for pair in plane.borders.iter().flat_map(|border| border.points.windows(2)) {
        let (a, b) = (pair[0] - from, pair[1] - from);
        let (x, y) = (way.perp_dot(a), way.perp_dot(b));
        if (x > 0.0) == (y > 0.0) {
            continue;
        }
        let at = a.lerp(b, x / (x - y)).dot(way);
        if at > 1e-6 * pair[0].distance(pair[1]).max(1e-9) && at < least {
            least = at;
        }
    }
    least.is_finite().then_some(least)
}
