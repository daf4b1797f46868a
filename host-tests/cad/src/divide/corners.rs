//! Corners of a region, and whether it has four.

use crate::mesh::{Mesh, Side};
use std::f64::consts::PI;

/// Inner angles below this are corners; above it a side goes on.
pub const CORNER: f64 = PI * 150.0 / 180.0;
/// Above this the region has a corner that points inward.
const INWARD: f64 = PI * 210.0 / 180.0;

/// What a region looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Four corners and no holes: the indices of the sides that begin at them.
    Grid([usize; 4]),
    /// Anything else.
    Other,
}

impl Shape {
    /// The shape of a face's region.
    pub fn of(mesh: &Mesh<'_>, face: usize) -> Self {
        let region = &mesh.regions[face];
        let [sides] = &region.loops[..] else { return Self::Other };
        if let [_, _, _, _] = sides[..]
            && sides.iter().any(|side| side.wire.is_none() && side.path.start() == side.path.end())
        {
            return Self::Grid([0, 1, 2, 3]);
        }
        let angles = angles(mesh, face);
        let corners: Vec<usize> = (0..sides.len()).filter(|k| angles[*k] < CORNER).collect();
        match corners[..] {
            [a, b, c, d] if angles.iter().all(|angle| *angle < INWARD && *angle > 0.1) => Self::Grid([a, b, c, d]),
            _ => Self::Other,
        }
    }
}

/// Whether a region has three sides, and a corner between any two of them.
pub fn is_triangle(mesh: &Mesh<'_>, face: usize) -> bool {
    let loops = &mesh.regions[face].loops;
    let has_three = loops.len() == 1 && loops[0].len() == 3 && loops[0].iter().all(|side| side.wire.is_some());
    has_three && angles(mesh, face).into_iter().all(|angle| angle < CORNER)
}

/// The inner angle where each side of the outer outline begins, radians: in space, of the tangents there.
pub fn angles(mesh: &Mesh<'_>, face: usize) -> Vec<f64> {
    let surface = &mesh.part.faces[face].surface;
    let sides = &mesh.regions[face].loops[0];
    let angle = |k: usize| {
        let (before, after) = (&sides[(k + sides.len() - 1) % sides.len()], &sides[k]);
        let is_flat = |side: &Side| side.wire.is_none();
        if is_flat(before) && is_flat(after) {
            return PI;
        }
        if is_flat(before) || is_flat(after) {
            return 0.5 * PI;
        }
        let uv = after.path.start();
        let jet = surface.at(uv);
        let normal = surface.normal(uv);
        let [a, b] = [(before, 1.0), (after, 0.0)].map(|(side, t)| {
            let slope = side.path.slope(t);
            jet.first[0] * slope.x + jet.first[1] * slope.y
        });
        PI - normal.dot(a.cross(b)).atan2(a.dot(b))
    };
    (0..sides.len()).map(angle).collect()
}

/// The sides from one corner to the next, four times.
pub fn four(sides: &[Side], starts: [usize; 4]) -> [Vec<&Side>; 4] {
    [0, 1, 2, 3].map(|k| {
        let (from, to) = (starts[k], starts[(k + 1) % 4]);
        let count = (to + sides.len() - from) % sides.len();
        (0..count).map(|i| &sides[(from + i) % sides.len()]).collect()
    })
}
