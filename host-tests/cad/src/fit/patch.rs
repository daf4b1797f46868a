//! The inside of a patch whose borders are given.
//!
//! Only the inner control points are free. What is asked of them, in the sense of least squares, is distance zero from
//! the surface, seen along its normal, and along the borders tangents that lie in the surface's tangent plane: so that
//! faces that are tangent stay so. How the patch runs within the surface is nobody's concern, and stays as Coons's
//! patch has it.

use super::least_squares::Normal;
use crate::bezier::{Bezier, Points, bernstein};
use crate::mesh::Quad;
use crate::nurbs::Surface;
use glam::{DVec2, DVec3};

/// Weight of a border's tangent beside a distance, both in millimetres: of a patch of length 1 a slope of 1 counts as
/// this.
const TANGENT: f64 = 0.3;
/// Weight of staying where it is, along the surface.
const STAY: f64 = 0.03;
const ROUNDS: usize = 8;

/// Fits a patch of at least these degrees to the part of a surface that a quad is. `curves` are the borders bottom,
/// right, top and left, the first and the third along `u`, the others along `v`.
pub fn fit_patch(surface: &Surface, quad: &Quad, curves: &[Points; 4], least: [usize; 2]) -> Bezier {
    let [bottom, right, top, left] = curves;
    let mut patch = Bezier::coons(bottom, top, left, right, least);
    let [p, q] = patch.degree;
    if p < 2 || q < 2 || surface.degree == [1, 1] && surface.counts == [2, 2] {
        return patch;
    }
    let unknown = |i: usize, j: usize| (i - 1) * (q - 1) + j - 1;
    let is_inner = |i: usize, j: usize| i > 0 && j > 0 && i < p && j < q;
    let count = 3 * (p - 1) * (q - 1);
    let steps = [2 * p + 3, 2 * q + 3];
    let mut guesses: Vec<DVec2> = Vec::new();
    for k in 0..=steps[0] {
        for l in 0..=steps[1] {
            guesses.push(quad.map(k as f64 / steps[0] as f64, l as f64 / steps[1] as f64));
        }
    }
    let mut before = f64::INFINITY;
    for _ in 0..ROUNDS {
        let mut normal = Normal::new(count);
        let mut largest: f64 = 0.0;
        for k in 0..=steps[0] {
            for l in 0..=steps[1] {
                let (s, t) = (k as f64 / steps[0] as f64, l as f64 / steps[1] as f64);
                let [a, b] = [bernstein(p, s), bernstein(q, t)];
                let [here, du, dv] = patch.at(s, t);
                let guess = &mut guesses[k * (steps[1] + 1) + l];
                let foot = surface.project(here, *guess);
                *guess = foot.uv;
                let across = surface.normal(foot.uv);
                largest = largest.max(foot.distance);
                // Along the surface it stays where it is.
                let tangents = [across.any_orthonormal_vector(), across.cross(across.any_orthonormal_vector())];
                for tangent in tangents {
                    let mut row = Vec::with_capacity(count);
                    for i in 1..p {
                        for j in 1..q {
                            let share = a[0][i] * b[0][j] * STAY;
                            row.extend((0..3).map(|c| (3 * unknown(i, j) + c, share * tangent[c])));
                        }
                    }
                    normal.add(&row, 0.0);
                }
                let mut add = |factor: &dyn Fn(usize, usize) -> f64, value: f64, weight: f64| {
                    let mut row = Vec::with_capacity(count);
                    for i in 1..p {
                        for j in 1..q {
                            let share = factor(i, j) * weight;
                            row.extend((0..3).map(|c| (3 * unknown(i, j) + c, share * across[c])));
                        }
                    }
                    normal.add(&row, value * weight);
                };
                let inside = k > 0 && l > 0 && k < steps[0] && l < steps[1];
                if inside {
                    add(&|i, j| a[0][i] * b[0][j], (foot.point - here).dot(across), 1.0);
                    continue;
                }
                if (k == 0 || k == steps[0]) && l > 0 && l < steps[1] {
                    add(&|i, j| a[1][i] * b[0][j], -du.dot(across), TANGENT / p as f64);
                }
                if (l == 0 || l == steps[1]) && k > 0 && k < steps[0] {
                    add(&|i, j| a[0][i] * b[1][j], -dv.dot(across), TANGENT / q as f64);
                }
            }
        }
        if largest <= 1e-9 || largest > 0.99 * before && largest <= before {
            break;
        }
        before = largest;
        normal.damp(1e-7);
        let Some(step) = normal.solve() else { break };
        for i in 0..=p {
            for j in 0..=q {
                if is_inner(i, j) {
                    let k = 3 * unknown(i, j);
                    let index = patch.index(i, j);
                    patch.points[index] += DVec3::new(step[k], step[k + 1], step[k + 2]);
                }
            }
        }
    }
    patch
}
