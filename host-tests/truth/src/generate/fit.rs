//! A homogeneous polynomial as a Bézier patch.

use glam::{DVec4, Vec4Swizzles as _};
use palpate_bake::NurbsPatch;

/// The Bézier patch of a polynomial `(u, v) ↦ (w x, w y, w z, w)` of at most these degrees: its values at a grid of as
/// many points as there are coefficients determine it. The weights must come out positive.
pub fn fit(degree: [usize; 2], flip: bool, homogeneous: impl Fn(f64, f64) -> DVec4) -> NurbsPatch {
    let [rows, columns] = degree.map(|degree| degree + 1);
    let at = |index: usize, degree: usize| index as f64 / degree as f64;
    let mut values: Vec<DVec4> = (0..rows)
        .flat_map(|i| (0..columns).map(move |j| (i, j)))
        .map(|(i, j)| homogeneous(at(i, degree[0]), at(j, degree[1])))
        .collect();
    let along_u = interpolation(degree[0]);
    let along_v = interpolation(degree[1]);
    let column = |values: &[DVec4], i: usize, j: usize| {
        (0..rows).map(|k| values[k * columns + j] * along_u[i][k]).sum::<DVec4>()
    };
    values = (0..rows * columns).map(|index| column(&values, index / columns, index % columns)).collect();
    let row = |i: usize, j: usize| (0..columns).map(|k| values[i * columns + k] * along_v[j][k]).sum::<DVec4>();
    let controls: Vec<DVec4> = (0..rows * columns).map(|index| row(index / columns, index % columns)).collect();
    let heaviest = controls.iter().map(|control| control.w).fold(0.0, f64::max);
    let clamped = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    NurbsPatch {
        name: None,
        degree,
        knots: degree.map(clamped),
        counts: [rows, columns],
        points: controls.iter().map(|control| control.xyz() / control.w).collect(),
        // Weights that differ by the rounding of the fit are one weight.
        weights: controls.iter().map(|control| 1e-12 * (1e12 * control.w / heaviest).round()).collect(),
        flip,
    }
}

/// The matrix from values at `k/degree` to Bernstein coefficients: the inverse of `B_j(k/degree)`, by Gauss and Jordan
/// with pivots.
fn interpolation(degree: usize) -> Vec<Vec<f64>> {
    let size = degree + 1;
    let bernstein = |j: usize, x: f64| {
        let choose = (0..j).fold(1.0, |product, k| product * (degree - k) as f64 / (k + 1) as f64);
        choose * x.powi(j as i32) * (1.0 - x).powi((degree - j) as i32)
    };
    let mut matrix: Vec<Vec<f64>> = (0..size)
        .map(|k| {
            let values = (0..size).map(|j| bernstein(j, k as f64 / degree as f64));
            values.chain((0..size).map(|j| if j == k { 1.0 } else { 0.0 })).collect()
        })
        .collect();
    for pivot in 0..size {
        let best = (pivot..size).max_by(|a, b| matrix[*a][pivot].abs().total_cmp(&matrix[*b][pivot].abs()));
        matrix.swap(pivot, best.unwrap_or(pivot));
        let scale = matrix[pivot][pivot];
        matrix[pivot].iter_mut().for_each(|entry| *entry /= scale);
        let row = matrix[pivot].clone();
        for (_, other) in matrix.iter_mut().enumerate().filter(|(index, _)| *index != pivot) {
            let factor = other[pivot];
            other.iter_mut().zip(&row).for_each(|(entry, of_pivot)| *entry -= factor * of_pivot);
        }
    }
    matrix.into_iter().map(|row| row[size..].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::OraclePoint;
    use glam::DVec3;

    #[test]
    fn a_rational_polynomial_comes_back_at_every_degree() {
        let exact = |u: f64, v: f64| {
            let (s, t) = (0.3 * u + 0.2 * v - 0.1, 0.5 * v - 0.2 * u);
            let weight = 1.0 + s * s + t * t;
            (DVec3::new(2.0 * s, 2.0 * t, 1.0 - s * s - t * t) / weight, weight)
        };
        for degree in [[2, 2], [2, 3], [5, 4]] {
            let patch = fit(degree, false, |u, v| (exact(u, v).0 * exact(u, v).1).extend(exact(u, v).1));
            for (u, v) in [(0.0, 0.0), (0.21, 0.93), (0.5, 0.4), (1.0, 1.0)] {
                let error = OraclePoint::evaluate(&patch, u, v).point.distance(exact(u, v).0);
                // Weights are kept to 1e-12; the interpolation's condition is below 1e3 at degree 5.
                assert!(error < 1e-11, "{degree:?} at {u}, {v}: {error:e}");
            }
        }
    }
}
