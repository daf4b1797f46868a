//! A region with four corners as a grid.

use super::corners::four;
use super::quality;
use crate::mesh::{Mesh, Quad, Side};
use crate::path::Path;
use glam::DVec2;

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
    let scale = super::plane::scale(mesh, face);
    let is_sound = |quad: &Quad| quality::of_map(&|s, t| quad.map(s, t) * scale, has_pole(quad)) > 0.02;
    let sound = quads.iter().all(is_sound);
    sound.then_some(quads)
}

fn has_pole(quad: &Quad) -> bool {
    quad.sides.iter().any(|side| {
        side.wire.is_none() && side.path.start().distance(side.path.end()) <= f64::EPSILON * DVec2::ONE.length()
    })
}
