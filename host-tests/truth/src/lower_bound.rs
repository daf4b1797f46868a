//! A proved lower bound of the distance to a body: branch and bound over rectangles of its faces' parameters, each as
//! its tangent plane with the proved bounds of the second derivatives.

use glam::DVec3;
use palpate_bake::BakedBody;
use palpate_bake::locator::StoredSurface;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Evaluations at most; after them the bound is looser, never wrong.
const MOST: usize = 20_000;
/// Of the size: distance between the bounds at which the search ends, far above the rounding of doubles.
const CLOSE: f64 = 1e-7;

/// A rectangle of parameters, and a lower bound of its distance.
struct Cell {
    bound: f64,
    face: usize,
    middle: [f64; 2],
    half: [f64; 2],
}

impl PartialEq for Cell {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Cell {}

impl PartialOrd for Cell {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The nearest is the maximum, which a heap gives first.
impl Ord for Cell {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

/// A distance, metres, that no point of the body goes below.
pub fn lower_bound(body: &BakedBody, probe: DVec3) -> f64 {
    let surfaces: Vec<_> = body.faces.iter().map(|face| StoredSurface::new(&face.patch)).collect();
    let mut nearest = f64::INFINITY;
    let mut cell = |face: usize, middle: [f64; 2], half: [f64; 2]| {
        let at = surfaces[face].evaluate(middle);
        let from = at.point - probe;
        nearest = nearest.min(from.length());
        let second = body.faces[face].patch.shape.second_derivatives;
        let [uu, uv, vv] = [second.uu, second.uv, second.vv].map(f64::from);
        let [h, k] = half;
        let bend = 0.5 * (h * h * uu + 2.0 * h * k * uv + k * k * vv);
        let bound = to_parallelogram(from, at.first[0] * h, at.first[1] * k) - bend;
        (Cell { bound, face, middle, half }, nearest)
    };
    let mut cells = BinaryHeap::new();
    for (face, baked) in body.faces.iter().enumerate() {
        let spans = |axis: usize| baked.patch.breaks[axis].windows(2).map(|pair| [pair[0], pair[1]].map(f64::from));
        for u in spans(0) {
            for v in spans(1) {
                let [middle, half] = [0.5, -0.5].map(|sign| [u, v].map(|[low, high]| 0.5 * high + sign * low));
                cells.push(cell(face, middle, half).0);
            }
        }
    }
    let mut left = MOST;
    while let Some(Cell { bound, face, middle, half }) = cells.pop() {
        let half = half.map(|half| 0.5 * half);
        let mut upper = f64::INFINITY;
        for [s, t] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
            let (quarter, nearest) = cell(face, [middle[0] + s * half[0], middle[1] + t * half[1]], half);
            // A part is no nearer than the whole.
            cells.push(Cell { bound: quarter.bound.max(bound), ..quarter });
            upper = nearest;
        }
        left = left.saturating_sub(4);
        if left == 0 || upper - bound <= CLOSE * f64::from(body.size) {
            return bound.max(0.0);
        }
    }
    0.0
}

/// The distance from the origin to the points `from + s a + t b` with `s` and `t` from −1 to 1.
fn to_parallelogram(from: DVec3, a: DVec3, b: DVec3) -> f64 {
    let on_side = |end: DVec3, along: DVec3| {
        let t = -end.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        (end + along * t.clamp(-1.0, 1.0)).length()
    };
    let sides = [on_side(from + a, b), on_side(from - a, b), on_side(from + b, a), on_side(from - b, a)];
    let normal = a.cross(b);
    let area = normal.length_squared();
    let [s, t] = [from.cross(b), a.cross(from)].map(|part| -part.dot(normal) / area);
    if area > 0.0 && s.abs() <= 1.0 && t.abs() <= 1.0 {
        return (from.dot(normal) / area.sqrt()).abs();
    }
    sides.into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_bake::{Model, Random};
    use std::path::Path;

    #[test]
    fn it_is_below_the_distance_of_a_sphere_and_close() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/sphere_body.toml");
        let model = Model::read(&path).expect("it ships");
        let body = BakedBody::new(&model, "sphere").expect("it ships");
        let radius = 0.5 * f64::from(body.size);
        let mut random = Random::new(5);
        for _ in 0..100 {
            let probe = DVec3::from_array([(); 3].map(|()| random.between(-2.0, 2.0) * radius));
            // The tables' rounding to f32, a quarter of a part in 10⁶.
            let (truth, bound) = ((probe.length() - radius).abs(), lower_bound(&body, probe));
            assert!(bound <= truth + 1e-6 * radius && truth <= bound + 1e-5 * radius, "{probe}: {bound} of {truth}");
        }
    }
}
