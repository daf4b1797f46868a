//! Proof that a patch has a tangent plane everywhere: `(f_u × f_v) · n > 0` for one direction `n` on each of a few
//! cells.
//!
//! The product is a polynomial; where all its Bernstein coefficients are positive, so is it. Otherwise the cell is
//! halved. At a pole the product vanishes with the distance from it: the coefficients of its side are zero and left
//! out, and the proof holds beside the pole.

use crate::bezier::Bezier;
use glam::DVec3;

/// Halvings of a cell before giving up.
const DEPTH: usize = 8;

/// Whether the patch is proved regular.
pub fn is_regular(patch: &Bezier) -> bool {
    let scale = patch.points.iter().map(|point| point.distance(patch.points[0])).fold(0.0, f64::max);
    proved(patch, poles(patch, 1e-9 * scale), DEPTH)
}

/// Which sides are one point: `u = 0`, `u = 1`, `v = 0`, `v = 1`.
fn poles(patch: &Bezier, near: f64) -> [bool; 4] {
    let [p, q] = patch.degree;
    let is_point = |points: Vec<DVec3>| points.iter().all(|point| point.distance(points[0]) <= near);
    let row = |i: usize| (0..=q).map(|j| patch.points[patch.index(i, j)]).collect();
    let column = |j: usize| (0..=p).map(|i| patch.points[patch.index(i, j)]).collect();
    [is_point(row(0)), is_point(row(p)), is_point(column(0)), is_point(column(q))]
}

fn proved(patch: &Bezier, poles: [bool; 4], depth: usize) -> bool {
    let [p, q] = patch.degree;
    let step = |from: usize, to: usize| patch.points[to] - patch.points[from];
    let mut normal = DVec3::ZERO;
    for i in 0..p {
        for j in 0..q {
            // Of the cell's diagonals, so that a cell with two corners in one counts too.
            let rising = step(patch.index(i, j), patch.index(i + 1, j + 1));
            normal += rising.cross(step(patch.index(i + 1, j), patch.index(i, j + 1)));
        }
    }
    let normal = normal.normalize_or_zero();
    // f_u has degrees (p − 1, q), f_v (p, q − 1): their product (2p − 1, 2q − 1).
    let (m, n) = (2 * p - 1, 2 * q - 1);
    let mut sums = vec![0.0; (m + 1) * (n + 1)];
    for i in 0..p {
        for j in 0..=q {
            let du = step(patch.index(i, j), patch.index(i + 1, j));
            for k in 0..=p {
                for l in 0..q {
                    let dv = step(patch.index(k, l), patch.index(k, l + 1));
                    let weight = choose(p - 1, i) * choose(q, j) * choose(p, k) * choose(q - 1, l)
                        / (choose(m, i + k) * choose(n, j + l));
                    sums[(i + k) * (n + 1) + j + l] += weight * du.cross(dv).dot(normal);
                }
            }
        }
    }
    let is_left_out =
        |i: usize, j: usize| poles[0] && i == 0 || poles[1] && i == m || poles[2] && j == 0 || poles[3] && j == n;
    let mut all = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j)));
    if all.all(|(i, j)| is_left_out(i, j) || sums[i * (n + 1) + j] > 0.0) {
        return true;
    }
    if depth == 0 {
        return false;
    }
    let axis = depth % 2;
    let [first, second] = halves(patch, axis);
    let (mut low, mut high) = (poles, poles);
    (low[2 * axis + 1], high[2 * axis]) = (false, false);
    proved(&first, low, depth - 1) && proved(&second, high, depth - 1)
}

/// De Casteljau's scheme at the middle.
fn halves(patch: &Bezier, axis: usize) -> [Bezier; 2] {
    let [p, q] = patch.degree;
    let (mut first, mut second) = (patch.clone(), patch.clone());
    let (lines, degree) = if axis == 0 { (q, p) } else { (p, q) };
    for line in 0..=lines {
        let index = |k: usize| if axis == 0 { patch.index(k, line) } else { patch.index(line, k) };
        let mut points: Vec<DVec3> = (0..=degree).map(|k| patch.points[index(k)]).collect();
        for k in 0..=degree {
            first.points[index(k)] = points[0];
            second.points[index(degree - k)] = points[points.len() - 1];
            points = points.windows(2).map(|pair| (pair[0] + pair[1]) * 0.5).collect();
        }
    }
    [first, second]
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).map(|i| (n - i) as f64 / (i + 1) as f64).product()
}
