//! How the projection errors change with the parameters: `Ψ̇ = M(x) ẋ + b(x)` of the paper's Figure 2.

use crate::oracle::OraclePoint;
use glam::DVec3;

/// The projection errors at a point of the surface, and their derivative.
///
/// With the tangents `f_i` (`i` is `u` or `v`), `ΔR = f − Q` and the first fundamental form `I_ij = f_i · f_j`, the
/// errors solve `I Ψ = g`, `g_i = ΔR · f_i`. Differentiated along `x_k`: `I ∂_kΨ = ∂_k g − (∂_k I) Ψ`, where
///
/// - `∂_k g_i = f_i · f_k + ΔR · f_ik`,
/// - `((∂_k I) Ψ)_i = Σ_j (f_ik · f_j + f_i · f_jk) Ψ_j`.
///
/// `Σ_j f_j Ψ_j` is the tangential part of `ΔR`, so what is left of `ΔR · f_ik` is the normal part `Δ N · f_ik`, and
///
/// `M = 1 + I⁻¹ B`, `B_ik = Δ N · f_ik − f_i · Σ_j f_jk Ψ_j`.
///
/// The first term of `B` is `Δ` times the second fundamental form, the second the Christoffel symbols times the errors.
/// At the closest point (`Ψ = 0`) the eigenvalues of `M` are `1 + κ ‖ΔR‖`, with the principal curvatures `κ` seen from
/// `Q`. For a patch and a probe at rest `b = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorKinematics {
    /// `Ψ`, the measure numbers of Eq. (4) (or the covariant errors).
    pub errors: [f64; 2],
    /// `M = dΨ/dx`, row by row.
    pub matrix: [[f64; 2]; 2],
}

/// `sin²` of the angle between the tangents below which half the digits of the inverse of `I` are lost.
const MIN_SINE_SQUARED: f64 = 1e-8;

impl ErrorKinematics {
    /// Of the measure numbers; `None` where the tangents span no plane.
    pub fn measure_numbers(surface: &OraclePoint, probe: DVec3) -> Option<Self> {
        let tangents = [surface.tangent_u, surface.tangent_v];
        let seconds = [[surface.second_uu, surface.second_uv], [surface.second_uv, surface.second_vv]];
        let [e, f, g] = [tangents[0].length_squared(), tangents[0].dot(tangents[1]), tangents[1].length_squared()];
        let determinant = e * g - f * f;
        // Also refuses NaN.
        let spans_a_plane = determinant > MIN_SINE_SQUARED * e * g;
        if !spans_a_plane {
            return None;
        }
        let solve = |right: [f64; 2]| {
            [(g * right[0] - f * right[1]) / determinant, (e * right[1] - f * right[0]) / determinant]
        };
        let difference = surface.point - probe;
        let errors = solve(tangents.map(|tangent| tangent.dot(difference)));
        let normal_part = difference - tangents[0] * errors[0] - tangents[1] * errors[1];
        let column = |k: usize| {
            let turning = seconds[0][k] * errors[0] + seconds[1][k] * errors[1];
            solve([0, 1].map(|i: usize| normal_part.dot(seconds[i][k]) - tangents[i].dot(turning)))
        };
        let [along_u, along_v] = [column(0), column(1)];
        Some(Self { errors, matrix: [[1.0 + along_u[0], along_v[0]], [along_u[1], 1.0 + along_v[1]]] })
    }

    /// Of the covariant errors `g_i = ΔR · f_i`, whose derivative is the Hessian of `½ ‖ΔR‖²`, `I_ik + ΔR · f_ik`: the
    /// textbook form of the iteration, and another flow with the same rest.
    pub fn covariant(surface: &OraclePoint, probe: DVec3) -> Self {
        let difference = surface.point - probe;
        let mixed = surface.tangent_u.dot(surface.tangent_v) + difference.dot(surface.second_uv);
        let along_u = surface.tangent_u.length_squared() + difference.dot(surface.second_uu);
        let along_v = surface.tangent_v.length_squared() + difference.dot(surface.second_vv);
        Self {
            errors: [surface.tangent_u, surface.tangent_v].map(|tangent| tangent.dot(difference)),
            matrix: [[along_u, mixed], [mixed, along_v]],
        }
    }

    /// `−M⁻¹ Ψ`: the control `w = M⁻¹ (−K Ψ − b)` for a gain of 1 and nothing that moves; `None` where `M` is singular.
    pub fn newton_direction(&self) -> Option<[f64; 2]> {
        let ([psi_u, psi_v], [[a, b], [c, d]]) = (self.errors, self.matrix);
        let determinant = a * d - b * c;
        let direction = [(b * psi_v - d * psi_u) / determinant, (c * psi_u - a * psi_v) / determinant];
        direction.iter().all(|component| component.is_finite()).then_some(direction)
    }

    /// The eigenvalues of `M`, the greater first; `None` where they are complex.
    pub fn eigenvalues(&self) -> Option<[f64; 2]> {
        let [[a, b], [c, d]] = self.matrix;
        let (middle, half) = (0.5 * (a + d), 0.5 * (a - d));
        let discriminant = half * half + b * c;
        (discriminant >= 0.0).then(|| [middle + discriminant.sqrt(), middle - discriminant.sqrt()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use palpate_bake::{Model, NurbsPatch};

    /// Rational, of mixed degree and skewed, so that no term of `M` vanishes.
    fn patch() -> NurbsPatch {
        let text = r#"
            unit = "m"
            [[patch]]
            degree = [2, 3]
            points = [
              [[0.0, 0.0, 0.0], [0.4, 0.2, 0.5, 0.7], [0.7, 0.1, 0.4], [1.1, 0.3, 0.0]],
              [[0.3, 0.5, 0.4], [0.6, 0.6, 0.9, 1.4], [0.9, 0.7, 0.8], [1.4, 0.6, 0.3]],
              [[0.1, 1.0, 0.1], [0.5, 1.1, 0.5], [0.9, 1.2, 0.3, 0.8], [1.2, 1.0, -0.2]],
            ]"#;
        Model::parse(text, "test").expect("the model is good").patches.remove(0)
    }

    fn check(kinematics: impl Fn(&OraclePoint, DVec3) -> ErrorKinematics) {
        let (patch, probe) = (patch(), DVec3::new(0.9, 0.2, 1.7));
        let at = |x: [f64; 2]| kinematics(&OraclePoint::evaluate(&patch, x[0], x[1]), probe);
        for [u, v] in [[0.2, 0.3], [0.5, 0.5], [0.8, 0.15], [0.35, 0.9]] {
            let matrix = at([u, v]).matrix;
            // Central differences: h² of truncation and ε/h of rounding meet near 1e-10 for h = 1e-5.
            let h = 1e-5;
            let ahead = [at([u + h, v]).errors, at([u, v + h]).errors];
            let behind = [at([u - h, v]).errors, at([u, v - h]).errors];
            for i in 0..2 {
                for k in 0..2 {
                    let difference = (ahead[k][i] - behind[k][i]) / (2.0 * h);
                    assert!((matrix[i][k] - difference).abs() < 1e-8, "M[{i}][{k}] {} {difference}", matrix[i][k]);
                }
            }
        }
    }

    #[test]
    fn the_matrix_is_the_derivative_of_the_measure_numbers() {
        check(|surface, probe| ErrorKinematics::measure_numbers(surface, probe).expect("the patch is regular"));
    }

    #[test]
    fn the_matrix_is_the_derivative_of_the_covariant_errors() {
        check(ErrorKinematics::covariant);
    }

    #[test]
    fn parallel_tangents_have_no_error_kinematics() {
        let flat = OraclePoint {
            point: DVec3::ZERO,
            tangent_u: DVec3::X,
            tangent_v: DVec3::X * 2.0,
            second_uu: DVec3::ZERO,
            second_uv: DVec3::ZERO,
            second_vv: DVec3::ZERO,
        };
        assert_eq!(ErrorKinematics::measure_numbers(&flat, DVec3::Z), None);
    }
}
