//! A patch with its first and second derivatives, in double precision.

use super::basis::Basis;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate_bake::NurbsPatch;

/// A point of a patch with all derivatives up to the second; metres per unit of parameter, and per unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OraclePoint {
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

impl OraclePoint {
    /// Evaluates a patch at `(u, v) ∈ [0, 1]²`.
    pub fn evaluate(patch: &NurbsPatch, u: f64, v: f64) -> Self {
        let along_u = Basis::new(&patch.knots[0], patch.degree[0], u);
        let along_v = Basis::new(&patch.knots[1], patch.degree[1], v);
        // Homogeneous sums [derivative along u][derivative along v] of (w x, w y, w z, w).
        let mut sums = [[DVec4::ZERO; 3]; 3];
        for i in 0..=patch.degree[0] {
            let mut row = [DVec4::ZERO; 3];
            for j in 0..=patch.degree[1] {
                let index = (along_u.first + i) * patch.counts[1] + along_v.first + j;
                let weighted = patch.points[index].extend(1.0) * patch.weights[index];
                for (entry, basis) in row.iter_mut().zip(&along_v.values) {
                    *entry += weighted * basis[j];
                }
            }
            for (sum, basis) in sums.iter_mut().zip(&along_u.values) {
                for (entry, value) in sum.iter_mut().zip(&row) {
                    *entry += *value * basis[i];
                }
            }
        }
        let [[f, f_v, f_vv], [f_u, f_uv, _], [f_uu, _, _]] = sums;
        // Leibniz' rule on w P = A, solved for the highest derivative of P.
        let inverse = 1.0 / f.w;
        let point = f.xyz() * inverse;
        let tangent_u = (f_u.xyz() - point * f_u.w) * inverse;
        let tangent_v = (f_v.xyz() - point * f_v.w) * inverse;
        Self {
            point,
            tangent_u,
            tangent_v,
            second_uu: (f_uu.xyz() - tangent_u * (2.0 * f_u.w) - point * f_uu.w) * inverse,
            second_uv: (f_uv.xyz() - tangent_u * f_v.w - tangent_v * f_u.w - point * f_uv.w) * inverse,
            second_vv: (f_vv.xyz() - tangent_v * (2.0 * f_v.w) - point * f_vv.w) * inverse,
        }
    }

    /// The unit normal `f_u × f_v`, turned round if `flip`.
    pub fn normal(&self, flip: bool) -> DVec3 {
        let normal = self.tangent_u.cross(self.tangent_v).normalize();
        if flip { -normal } else { normal }
    }

    /// The principal curvatures, 1/m, least first, positive where the surface is convex seen from the side the normal
    /// points to; NaN where the tangents span no plane. Eigenvalues of `−I⁻¹ II`.
    pub fn principal_curvatures(&self, flip: bool) -> [f64; 2] {
        let normal = self.normal(flip);
        let (e, f, g) =
            (self.tangent_u.length_squared(), self.tangent_u.dot(self.tangent_v), self.tangent_v.length_squared());
        let [l, m, n] = [self.second_uu, self.second_uv, self.second_vv].map(|second| -normal.dot(second));
        let determinant = e * g - f * f;
        let mean = (e * n - 2.0 * f * m + g * l) / (2.0 * determinant);
        let gauss = (l * n - m * m) / determinant;
        let half = (mean * mean - gauss).max(0.0).sqrt();
        [mean - half, mean + half]
    }
}
