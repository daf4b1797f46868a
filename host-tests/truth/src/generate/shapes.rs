//! The shapes.

use crate::oracle::OraclePoint;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate_bake::NurbsPatch;
use palpate_bake::Random;

/// Surface that a patch is cut from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// An ellipsoid of random axes: stereographic, so biquadratic and rational.
    Ellipsoid,
    /// An elliptic paraboloid.
    Paraboloid,
    /// A round cylinder: curved one way only.
    Cylinder,
    /// A plane.
    Plane,
    /// A convex graph of degree 4.
    Quartic,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Ellipsoid, Self::Paraboloid, Self::Cylinder, Self::Plane, Self::Quartic];

    /// The minimum degree, along both parameters, of a patch with a skewed parametrisation.
    const fn degree(self) -> usize {
        match self {
            Self::Plane => 1,
            Self::Ellipsoid | Self::Paraboloid => 2,
            Self::Cylinder => 3,
            Self::Quartic => 4,
        }
    }
}

/// A convex patch.
#[derive(Clone, Debug)]
pub struct ConvexPatch {
    /// The surface that it is cut from.
    pub kind: Kind,
    /// The patch, millimetres to decimetres large, near the origin, turned any way; its normals point out of the convex
    /// body.
    pub surface: NurbsPatch,
}

impl ConvexPatch {
    /// Draws a patch of a kind.
    pub fn draw(kind: Kind, random: &mut Random) -> Self {
        let degree = [(); 2].map(|()| kind.degree() + random.below(6 - kind.degree()));
        // The cut: a parallelogram in the shape's own parameters, down to 15° between its sides.
        let extent = random.scale(0.15, 0.9);
        let (turn, opening) = (random.between(0.0, std::f64::consts::TAU), random.between(0.26, 2.88));
        let sides = [(turn, extent), (turn + opening, extent * random.scale(0.3, 1.0))]
            .map(|(a, l)| [l * a.cos(), l * a.sin()]);
        let centre = [(); 2].map(|()| random.between(-0.4, 0.4));
        let at = move |u: f64, v: f64| {
            [0, 1].map(|axis| centre[axis] + (u - 0.5) * sides[0][axis] + (v - 0.5) * sides[1][axis])
        };
        let shape = draw_shape(kind, random);
        // u ↦ u / (u + c (1 − u)) spreads the parameter unevenly; with weights it costs no degree.
        let spread = [(); 2].map(|()| if random.happens(0.3) { random.scale(0.5, 2.0) } else { 1.0 });
        let (axes, scale) = (random.axes(), random.scale(0.02, 0.2));
        let turned = move |point: DVec3| (axes[0] * point.x + axes[1] * point.y + axes[2] * point.z) * scale;
        // The patch lies about as far from the frame's origin as it is large: f32 resolves coordinates, not sizes.
        let [s, t] = at(0.5, 0.5);
        let middle = turned(shape(s, t).xyz() / shape(s, t).w);
        let origin = random.direction() * scale * extent * random.between(0.0, 1.0) - middle;
        let place = |point: DVec4| (turned(point.xyz()) + origin * point.w).extend(point.w);
        let homogeneous = |u: f64, v: f64| {
            let [below_u, below_v] = [u + spread[0] * (1.0 - u), v + spread[1] * (1.0 - v)];
            let [s, t] = at(u / below_u, v / below_v);
            place(shape(s, t)) * below_u.powi(degree[0] as i32) * below_v.powi(degree[1] as i32)
        };
        let mut surface = fit(degree, false, homogeneous);
        // Of a convex body, every outward normal points away from every inner point.
        let middle = OraclePoint::evaluate(&surface, 0.5, 0.5);
        let inner = place(kind.inner_point()).truncate();
        surface.flip = middle.tangent_u.cross(middle.tangent_v).dot(middle.point - inner) < 0.0;
        Self { kind, surface }
    }

    /// The outward unit normal at `(u, v)`, with the point.
    pub fn point_and_normal(&self, u: f64, v: f64) -> (DVec3, DVec3) {
        let at = OraclePoint::evaluate(&self.surface, u, v);
        let normal = at.tangent_u.cross(at.tangent_v).normalize();
        (at.point, if self.surface.flip { -normal } else { normal })
    }

    /// The cosine of the widest angle between two normals, from a grid of them.
    pub fn widest_cosine(&self) -> f64 {
        let grid = || (0..=8).map(|index| f64::from(index) / 8.0);
        let normals: Vec<DVec3> = grid().flat_map(|u| grid().map(move |v| self.point_and_normal(u, v).1)).collect();
        normals.iter().flat_map(|a| normals.iter().map(|b| a.dot(*b))).fold(1.0, f64::min)
    }
}

impl Kind {
    /// A point inside the convex body, in its own frame.
    const fn inner_point(self) -> DVec4 {
        match self {
            Self::Ellipsoid | Self::Cylinder => DVec4::new(0.0, 0.0, 0.0, 1.0),
            Self::Paraboloid | Self::Plane | Self::Quartic => DVec4::new(0.0, 0.0, -10.0, 1.0),
        }
    }
}

/// The homogeneous map of a shape, in its own frame and about of size 1.
fn draw_shape(kind: Kind, random: &mut Random) -> Box<dyn Fn(f64, f64) -> DVec4> {
    match kind {
        Kind::Ellipsoid => {
            let [a, b, c] = [(); 3].map(|()| random.scale(0.4, 1.0));
            Box::new(move |s, t| {
                let square = s * s + t * t;
                DVec4::new(2.0 * a * s, 2.0 * b * t, c * (1.0 - square), 1.0 + square)
            })
        }
        Kind::Paraboloid => {
            let [a, b] = [(); 2].map(|()| random.scale(0.1, 1.5));
            Box::new(move |s, t| DVec4::new(s, t, -0.5 * (a * s * s + b * t * t), 1.0))
        }
        Kind::Cylinder => {
            let height = random.scale(0.5, 2.0);
            Box::new(move |s, t| {
                let square = 1.0 + s * s;
                DVec4::new(1.0 - s * s, 2.0 * s, height * t * square, square)
            })
        }
        Kind::Plane => Box::new(|s, t| DVec4::new(s, t, 0.0, 1.0)),
        Kind::Quartic => {
            let [a, b, c, d] = [(); 4].map(|()| random.scale(0.1, 1.0));
            Box::new(move |s, t| {
                let [s2, t2] = [s * s, t * t];
                DVec4::new(s, t, -0.5 * (a * s2 + b * t2) - c * s2 * s2 - d * t2 * t2, 1.0)
            })
        }
    }
}

// A homogeneous polynomial as a Bézier patch.

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
