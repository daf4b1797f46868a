//! Whether a point is a corner of a patch, or on one.

use crate::bezier::Bezier;
use glam::DVec3;
use std::collections::HashMap;

/// Corners of patches by cells, and the patches for points that are none.
pub struct Corners<'b> {
    near: f64,
    cells: HashMap<[i64; 3], Vec<DVec3>>,
    patches: Vec<(DVec3, DVec3, &'b Bezier)>,
}

impl<'b> Corners<'b> {
    /// Of patches; `near` is the distance that counts, millimetres.
    pub fn new(patches: &[&'b Bezier], near: f64) -> Self {
        let mut cells: HashMap<[i64; 3], Vec<DVec3>> = HashMap::new();
        let mut boxed = Vec::new();
        for patch in patches {
            let [p, q] = patch.degree;
            for corner in [(0, 0), (p, 0), (0, q), (p, q)].map(|(i, j)| patch.points[patch.index(i, j)]) {
                cells.entry(cell(corner, near)).or_default().push(corner);
            }
            let low = patch.points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
            let high = patch.points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
            boxed.push((low - near, high + near, *patch));
        }
        Self { near, cells, patches: boxed }
    }

    /// Whether one is near a point.
    pub fn has(&self, point: DVec3) -> bool {
        let [x, y, z] = cell(point, self.near);
        let about = (0..27).map(|k: i64| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let mut corners = about.filter_map(|cell| self.cells.get(&cell)).flatten();
        corners.any(|corner| corner.distance(point) <= self.near) || self.is_on_a_patch(point)
    }

    /// Where a closed edge starts, or at a pole.
    fn is_on_a_patch(&self, point: DVec3) -> bool {
        const GRID: usize = 5;
        let near = self.patches.iter().filter(|(low, high, _)| point.cmpge(*low).all() && point.cmple(*high).all());
        near.into_iter().any(|(_, _, patch)| {
            let guess = |k: usize| [k % GRID, k / GRID].map(|k| k as f64 / (GRID - 1) as f64);
            let far = |at: [f64; 2]| patch.at(at[0], at[1])[0].distance_squared(point);
            let mut starts: Vec<[f64; 2]> = (0..GRID * GRID).map(guess).collect();
            starts.sort_by(|a, b| far(*a).total_cmp(&far(*b)));
            starts.into_iter().take(3).any(|start| patch.project(point, start).1 <= self.near)
        })
    }
}

fn cell(point: DVec3, size: f64) -> [i64; 3] {
    (point / size).floor().to_array().map(|along| along as i64)
}
