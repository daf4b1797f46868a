//! Points inside a region that quads may use: half-way in from each vertex of the outline, and the middles of where it
//! is wide.

use super::plane::{Plane, Vertex};
use glam::DVec2;
use std::f64::consts::TAU;

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
