//! Corners of a region, and whether it has four.

use super::plane::of_map;
use crate::mesh::{Mesh, Quad, Side};
use crate::path::Path;
use glam::DVec2;
use std::f64::consts::PI;

/// Inner angles below this are corners; above it a side goes on.
pub const CORNER: f64 = PI * 150.0 / 180.0;
/// Above this the region has a corner that points inward.
const INWARD: f64 = PI * 210.0 / 180.0;

/// Shape of a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Four corners and no holes: the indices of the sides that start at them.
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

/// The inner angle at the start of each side of the outer outline, radians: in space, between the tangents.
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

// A region with four corners as a grid.

/// Whether opposite sides have the same number of pieces.
pub fn is_even(sides: &[Side], starts: [usize; 4]) -> bool {
    let [bottom, right, top, left] = four(sides, starts);
    bottom.len() == top.len() && right.len() == left.len()
}

/// The quads of the grid; none if its lines would fold.
pub fn quads(mesh: &mut Mesh<'_>, face: usize, starts: [usize; 4]) -> Option<Vec<Quad>> {
    let sides = mesh.regions[face].loops[0].clone();
    let [bottom, right, top, left] = four(&sides, starts).map(|sides| sides.into_iter().cloned().collect::<Vec<_>>());
    let (m, n) = (bottom.len(), right.len());
    let chain = |sides: &[Side], t: f64| {
        let x = t * sides.len() as f64;
        let k = (x.floor() as usize).min(sides.len() - 1);
        sides[k].path.at(x - k as f64)
    };
    let map = |s: f64, t: f64| {
        let [a, b] = [chain(&bottom, s), chain(&top, 1.0 - s)];
        let [c, d] = [chain(&left, 1.0 - t), chain(&right, t)];
        let corners = bottom[0].path.start() * ((1.0 - s) * (1.0 - t))
            + right[0].path.start() * (s * (1.0 - t))
            + top[0].path.start() * (s * t)
            + left[0].path.start() * ((1.0 - s) * t);
        a * (1.0 - t) + b * t + c * (1.0 - s) + d * s - corners
    };
    let at = |i: usize, j: usize| map(i as f64 / m as f64, j as f64 / n as f64);
    // Nodes: those of the border, and new ones inside.
    let mut nodes = vec![vec![0; n + 1]; m + 1];
    for i in 0..=m {
        for j in 0..=n {
            nodes[i][j] = match (i, j) {
                (i, 0) if i < m => bottom[i].ends[0],
                (i, j) if i == m && j < n => right[j].ends[0],
                (i, j) if j == n && i > 0 => top[m - i].ends[0],
                (0, j) => left[n - j].ends[0],
                _ => mesh.add_node(mesh.part.faces[face].surface.at(at(i, j)).point),
            };
        }
    }
    // Lines along u and along v, as sides that run that way.
    let line = |mesh: &mut Mesh<'_>, from: [usize; 2], to: [usize; 2]| {
        let (a, b) = (at(from[0], from[1]), at(to[0], to[1]));
        let [p, q] = [from, to].map(|[i, j]| [i as f64 / m as f64, j as f64 / n as f64]);
        let path = Path::sampled(|t| map(p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t));
        let bend = (0..=8).map(|k| path.at(f64::from(k) / 8.0).distance(a.lerp(b, f64::from(k) / 8.0)));
        let path = if bend.fold(0.0, f64::max) <= 1e-11 * a.distance(b) { Path::line(a, b) } else { path };
        mesh.add_inside(face, [nodes[from[0]][from[1]], nodes[to[0]][to[1]]], path)
    };
    let mut along_u = vec![Vec::with_capacity(m); n + 1];
    let mut along_v = vec![Vec::with_capacity(n); m + 1];
    for j in 0..=n {
        for i in 0..m {
            along_u[j].push(match j {
                0 => bottom[i].clone(),
                j if j == n => top[m - 1 - i].reversed(),
                _ => line(mesh, [i, j], [i + 1, j]),
            });
        }
    }
    for (i, column) in along_v.iter_mut().enumerate() {
        for j in 0..n {
            column.push(match i {
                0 => left[n - 1 - j].reversed(),
                i if i == m => right[j].clone(),
                _ => line(mesh, [i, j], [i, j + 1]),
            });
        }
    }
    let mut quads = Vec::with_capacity(m * n);
    for i in 0..m {
        for j in 0..n {
            let sides = [
                along_u[j][i].clone(),
                along_v[i + 1][j].clone(),
                along_u[j + 1][i].reversed(),
                along_v[i][j].reversed(),
            ];
            quads.push(Quad { sides });
        }
    }
    let scale = crate::divide::plane::scale(mesh, face);
    let is_sound = |quad: &Quad| of_map(&|s, t| quad.map(s, t) * scale, has_pole(quad)) > 0.02;
    let sound = quads.iter().all(is_sound);
    sound.then_some(quads)
}

fn has_pole(quad: &Quad) -> bool {
    quad.sides.iter().any(|side| {
        side.wire.is_none() && side.path.start().distance(side.path.end()) <= f64::EPSILON * DVec2::ONE.length()
    })
}
