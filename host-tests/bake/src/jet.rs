//! A patch with its first and second derivatives, in double precision, by de Boor's triangle: what the bake measures of
//! a patch. Deliberately another way than the oracle's sums of basis functions, so that one error cannot be in both.

use crate::patch::{Axis, NurbsPatch};
use glam::{DVec3, DVec4, Vec4Swizzles as _};

/// A point of a patch with all derivatives up to the second (its 2-jet); metres per unit of parameter, and per unit
/// squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    /// `f(u, v)`.
    pub point: DVec3,
    /// `f_u`.
    pub tangent_u: DVec3,
    /// `f_v`.
    pub tangent_v: DVec3,
    /// `f_uu`.
    pub second_uu: DVec3,
    /// `f_uv`.
    pub second_uv: DVec3,
    /// `f_vv`.
    pub second_vv: DVec3,
}

impl Jet {
    /// Of a patch at `(u, v) ∈ [0, 1]²`; on an inner knot the span above it is taken, at 1 the last.
    pub fn of(patch: &NurbsPatch, u: f64, v: f64) -> Self {
        let [along_u, along_v] =
            [(0, u), (1, v)].map(|(axis, at)| Triangle::at(&patch.knots[axis], patch.degree[axis], at));
        let homogeneous = |i: usize, j: usize| {
            let index = i * patch.counts[1] + j;
            (patch.points[index] * patch.weights[index]).extend(patch.weights[index])
        };
        // Of each row its point and derivatives along v; of those the same along u.
        let rows: Vec<[DVec4; 3]> = (along_u.first()..=along_u.span)
            .map(|i| along_v.reduce((along_v.first()..=along_v.span).map(|j| homogeneous(i, j)).collect()))
            .collect();
        let [[a, a_u, a_uu], [a_v, a_uv, _], [a_vv, _, _]] =
            [0, 1, 2].map(|k| along_u.reduce(rows.iter().map(|row| row[k]).collect()));
        // P = A / w, and the quotient rule.
        let point = a.xyz() / a.w;
        let tangent = |along: DVec4| (along.xyz() - along.w * point) / a.w;
        let (tangent_u, tangent_v) = (tangent(a_u), tangent(a_v));
        let second = |both: DVec4, [first, other]: [DVec4; 2], [along_first, along_other]: [DVec3; 2]| {
            (both.xyz() - both.w * point - first.w * along_other - other.w * along_first) / a.w
        };
        Self {
            point,
            tangent_u,
            tangent_v,
            second_uu: second(a_uu, [a_u; 2], [tangent_u; 2]),
            second_uv: second(a_uv, [a_u, a_v], [tangent_u, tangent_v]),
            second_vv: second(a_vv, [a_v; 2], [tangent_v; 2]),
        }
    }

    /// The principal curvatures, 1/m, in ascending order, positive where the surface is convex seen from the side the
    /// normal points to; NaN where the tangents span no plane. The roots of `det(II + κ I) = 0`.
    pub fn principal_curvatures(&self, flip: bool) -> [f64; 2] {
        let cross = self.tangent_u.cross(self.tangent_v);
        let normal = if flip { -cross } else { cross } / cross.length();
        // In an orthonormal frame of the tangent plane the shape operator is symmetric, and its eigenvalues are safe.
        let x = self.tangent_u.normalize();
        let (stretch_u, y) = (self.tangent_u.length(), x.cross(cross / cross.length()));
        let (shear, stretch_v) = (self.tangent_v.dot(x), self.tangent_v.dot(y));
        let [uu, uv, vv] = [self.second_uu, self.second_uv, self.second_vv].map(|second| -normal.dot(second));
        let xx = uu / (stretch_u * stretch_u);
        let xy = (uv - shear * stretch_u * xx) / (stretch_u * stretch_v);
        let yy = (vv - 2.0 * shear * stretch_v * xy - shear * shear * xx) / (stretch_v * stretch_v);
        let (mean, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        [mean - half, mean + half]
    }
}

/// De Boor's triangle along one parameter.
struct Triangle<'a> {
    knots: &'a [f64],
    degree: usize,
    /// The last knot that is not above the parameter, but below the end.
    span: usize,
    at: f64,
}

impl<'a> Triangle<'a> {
    fn at(knots: &'a [f64], degree: usize, at: f64) -> Self {
        let last = knots.len() - degree - 2;
        let span = (degree..=last).rev().find(|&index| knots[index] <= at && knots[index] < knots[last + 1]);
        Self { knots, degree, span: span.unwrap_or(degree), at }
    }

    /// The first of the `degree + 1` control points that count.
    const fn first(&self) -> usize {
        self.span - self.degree
    }

    /// The curve with those control points: point, first and second derivative.
    fn reduce(&self, mut points: Vec<DVec4>) -> [DVec4; 3] {
        let (p, k) = (self.degree, self.span);
        let knot = |index: usize| self.knots[index];
        let (mut first, mut second) = (DVec4::ZERO, DVec4::ZERO);
        for level in 1..=p {
            // The blossom with all but two, or one, of its arguments at the parameter, and the others at the knots
            // around it: its differences are the derivatives.
            if level + 1 == p {
                let above = (points[p] - points[p - 1]) / (knot(k + 2) - knot(k));
                let below = (points[p - 1] - points[p - 2]) / (knot(k + 1) - knot(k - 1));
                second = (above - below) * ((p * (p - 1)) as f64 / (knot(k + 1) - knot(k)));
            }
            if level == p {
                first = (points[p] - points[p - 1]) * (p as f64 / (knot(k + 1) - knot(k)));
            }
            for index in (level..=p).rev() {
                let low = knot(k - p + index);
                let share = (self.at - low) / (knot(k + index + 1 - level) - low);
                points[index] = points[index - 1] * (1.0 - share) + points[index] * share;
            }
        }
        [points[p], first, second]
    }
}

// A patch on a grid, as its size and its shape are looked at.

impl NurbsPatch {
    /// The largest side of the bounding box of a grid of points on the patch, 8 to a span, metres.
    pub fn size(&self) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        self.for_each_sample(8, |_, surface| {
            low = low.min(surface.point);
            high = high.max(surface.point);
            true
        });
        (high - low).max_element()
    }

    /// Evaluates a grid of `steps` intervals a span, borders included, until `visit` says false.
    pub(super) fn for_each_sample(&self, steps: usize, mut visit: impl FnMut([f64; 2], &Jet) -> bool) {
        let parameters = |axis| {
            let borders = self.borders(axis);
            let inside = |pair: &[f64]| {
                let (left, width) = (pair[0], pair[1] - pair[0]);
                (0..steps).map(move |step| left + width * step as f64 / steps as f64)
            };
            borders.windows(2).flat_map(inside).chain([1.0]).collect::<Vec<_>>()
        };
        let along_v = parameters(Axis::V);
        for u in parameters(Axis::U) {
            for &v in &along_v {
                if !visit([u, v], &Jet::of(self, u, v)) {
                    return;
                }
            }
        }
    }
}
