//! Baselines for the controller, in double precision: closest points by Newton's method, which needs second derivatives
//! and a start near the answer.

use crate::oracle::OraclePoint;
use glam::DVec3;
use palpate_bake::NurbsPatch;

// Projected Newton for `½ ‖ΔR‖²` over the unit square, after Bertsekas (1982).

/// The usual share of the fall that the slope promises (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// Halvings after which a step no longer moves a double.
const HALVINGS: u32 = 50;

/// The direction of a step from the difference, the gradient and which parameters are held.
type Direction = fn(&OraclePoint, DVec3, [f64; 2], [bool; 2]) -> [f64; 2];

/// One step: the Hessian where it is positive definite, the first fundamental form where not; parameters that press
/// outward are held; halved until the distance falls enough. `None` at a stationary point. With the evaluations spent on
/// lengths.
fn step(
    patch: &NurbsPatch,
    surface: &OraclePoint,
    at: [f64; 2],
    probe: DVec3,
    direction: Direction,
) -> (Option<[f64; 2]>, u32) {
    let difference = surface.point - probe;
    let gradient = [difference.dot(surface.tangent_u), difference.dot(surface.tangent_v)];
    let is_outward = |i: usize, change: f64| (at[i] <= 0.0 && change < 0.0) || (at[i] >= 1.0 && change > 0.0);
    let mut held = [0, 1].map(|i| is_outward(i, -gradient[i]));
    let mut along = direction(surface, difference, gradient, held);
    // The mixed term can turn a parameter that was free outward: then it is held as well.
    if let Some(i) = (0..2).find(|&i| is_outward(i, along[i])) {
        held[i] = true;
        along = direction(surface, difference, gradient, held);
    }
    let slope = gradient[0] * along[0] + gradient[1] * along[1];
    let value = 0.5 * difference.length_squared();
    let mut length = 1.0;
    for tried in 1..=HALVINGS {
        let next = [0, 1].map(|i| (at[i] + length * along[i]).clamp(0.0, 1.0));
        let there = 0.5 * OraclePoint::evaluate(patch, next[0], next[1]).point.distance_squared(probe);
        if next != at && there <= value + SUFFICIENT * length * slope {
            return (Some(next), tried);
        }
        length *= 0.5;
    }
    (None, HALVINGS)
}

/// Down the gradient, over the trace of the first fundamental form: the full step is no longer than Gauss and Newton's.
fn downhill(surface: &OraclePoint, _: DVec3, gradient: [f64; 2], held: [bool; 2]) -> [f64; 2] {
    let trace = surface.tangent_u.length_squared() + surface.tangent_v.length_squared();
    [0, 1].map(|i| if held[i] { 0.0 } else { -gradient[i] / trace })
}

fn direction(surface: &OraclePoint, difference: DVec3, gradient: [f64; 2], held: [bool; 2]) -> [f64; 2] {
    let form = [surface.tangent_u.length_squared(), surface.tangent_v.length_squared()];
    let mixed = surface.tangent_u.dot(surface.tangent_v);
    let hessian = [form[0] + difference.dot(surface.second_uu), form[1] + difference.dot(surface.second_vv)];
    let hessian_mixed = mixed + difference.dot(surface.second_uv);
    let alone = |i: usize| -gradient[i] / if hessian[i] > 0.0 { hessian[i] } else { form[i] };
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            let is_positive = hessian[0] > 0.0 && hessian[0] * hessian[1] > hessian_mixed * hessian_mixed;
            let ([a, d], b) = if is_positive { (hessian, hessian_mixed) } else { (form, mixed) };
            let determinant = a * d - b * b;
            [(b * gradient[1] - d * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
        }
    }
}

// Newton's method as the paper compares with it, one step at a time.

/// Which method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The controller `ẋ = M⁻¹ (−K Ψ − b)`; it ignores the borders, and fails when it leaves the patch.
    Newton,
    /// The same with saturation: a parameter that would pass its border stops there, and the other one takes its full
    /// step.
    SaturatedNewton,
    /// Not in the paper: Newton's method for the minimum of `½ ‖ΔR‖²` over the square, as in textbooks.
    ProjectedNewton,
    /// Not in the paper: the projected gradient of the same, halved in the same way.
    ProjectedGradient,
}

/// Which errors Newton's method drives to zero. The paper's text leaves it open: its Eq. (4) defines measure numbers,
/// and the iteration it calls equivalent drives the covariant errors. The answers are the same, the basins are not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Errors {
    /// `Ψ = I⁻¹ g`, Eq. (4).
    MeasureNumbers,
    /// `g = (ΔR · f_u, ΔR · f_v)`.
    Covariant,
}

/// A method on a patch.
#[derive(Clone, Copy, Debug)]
pub struct Baseline<'a> {
    /// The patch.
    pub patch: &'a NurbsPatch,
    /// The method.
    pub method: Method,
    /// The errors; the projected methods know only the covariant ones.
    pub errors: Errors,
    /// `K h`: with 1, an Euler step of the controller is a step of Newton's iteration. Not used by
    /// the projected methods, which search along their step.
    pub gain: f64,
}

/// Where a step leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advance {
    /// To these parameters.
    To([f64; 2]),
    /// Out of the square, to these.
    Out([f64; 2]),
    /// Nowhere: the matrix is singular, or there is nothing left to do.
    Nowhere,
}

impl<'a> Baseline<'a> {
    /// The method with a gain of 1.
    pub const fn new(patch: &'a NurbsPatch, method: Method, errors: Errors) -> Self {
        Self { patch, method, errors, gain: 1.0 }
    }

    /// One step from `at`, in the square, for a probe at rest.
    pub fn step(&self, at: [f64; 2], probe: DVec3) -> Advance {
        self.counted_step(at, probe).0
    }

    /// The same, with the evaluations of the patch that it took.
    pub fn counted_step(&self, at: [f64; 2], probe: DVec3) -> (Advance, u32) {
        let surface = OraclePoint::evaluate(self.patch, at[0], at[1]);
        let along: Option<Direction> = match self.method {
            Method::ProjectedNewton => Some(direction),
            Method::ProjectedGradient => Some(downhill),
            _ => None,
        };
        if let Some(along) = along {
            let (next, tried) = step(self.patch, &surface, at, probe, along);
            return (next.map_or(Advance::Nowhere, Advance::To), 1 + tried);
        }
        let kinematics = match self.errors {
            Errors::MeasureNumbers => ErrorKinematics::measure_numbers(&surface, probe),
            Errors::Covariant => Some(ErrorKinematics::covariant(&surface, probe)),
        };
        let direction = kinematics.and_then(|kinematics| kinematics.newton_direction());
        let Some(direction) = direction else { return (Advance::Nowhere, 1) };
        let next = [0, 1].map(|i| at[i] + self.gain * direction[i]);
        let inside = next.iter().all(|parameter| (0.0..=1.0).contains(parameter));
        let saturated = next.map(|parameter| parameter.clamp(0.0, 1.0));
        let advance = match self.method {
            _ if next == at || (self.method == Method::SaturatedNewton && saturated == at) => Advance::Nowhere,
            Method::Newton if !inside => Advance::Out(next),
            _ => Advance::To(saturated),
        };
        (advance, 1)
    }
}

// How the projection errors change with the parameters: `Ψ̇ = M(x) ẋ + b(x)` of the paper's Figure 2.

/// The projection errors at a point of the surface, and their derivative.
///
/// With the tangents `f_i` (`i` is `u` or `v`), `ΔR = f − Q` and the first fundamental form `I_ij = f_i · f_j`, the
/// errors solve `I Ψ = g`, `g_i = ΔR · f_i`. Differentiated along `x_k`: `I ∂_kΨ = ∂_k g − (∂_k I) Ψ`, where
///
/// - `∂_k g_i = f_i · f_k + ΔR · f_ik`,
/// - `((∂_k I) Ψ)_i = Σ_j (f_ik · f_j + f_i · f_jk) Ψ_j`.
///
/// `Σ_j f_j Ψ_j` is the tangential part of `ΔR`, so the rest of `ΔR · f_ik` is the normal part `Δ N · f_ik`, and
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
    use palpate_bake::Model;

    /// A biquadratic dome; probes above its middle.
    fn dome() -> NurbsPatch {
        let text = r#"
            unit = "m"
            [[patch]]
            degree = [2, 2]
            points = [
              [[0, 0, 0], [0.5, 0, 0.4], [1, 0, 0]],
              [[0, 0.5, 0.4], [0.5, 0.5, 0.9], [1, 0.5, 0.4]],
              [[0, 1, 0], [0.5, 1, 0.4], [1, 1, 0]],
            ]"#;
        Model::parse(text, "test").expect("the model is good").patches.remove(0)
    }

    #[test]
    fn every_method_converges_from_nearby_newton_quadratically() {
        let (patch, probe) = (dome(), DVec3::new(0.55, 0.45, 0.8));
        for (method, errors) in [
            (Method::Newton, Errors::MeasureNumbers),
            (Method::Newton, Errors::Covariant),
            (Method::SaturatedNewton, Errors::MeasureNumbers),
            (Method::ProjectedNewton, Errors::Covariant),
        ] {
            let baseline = Baseline::new(&patch, method, errors);
            let mut at = [0.5, 0.5];
            // From 0.05 away, squared five times, is far below the digits of a double.
            for _ in 0..6 {
                if let Advance::To(next) = baseline.step(at, probe) {
                    at = next;
                }
            }
            let surface = OraclePoint::evaluate(&patch, at[0], at[1]);
            let difference = surface.point - probe;
            let residual = difference.dot(surface.tangent_u).abs() + difference.dot(surface.tangent_v).abs();
            assert!(residual < 1e-14, "{method:?}, {errors:?}: {residual:e} left");
        }
    }

    #[test]
    fn at_the_border_newton_leaves_and_saturation_stays() {
        // The closest point lies on u = 1: the unrestricted step has to cross it.
        let (patch, probe, start) = (dome(), DVec3::new(0.4, 1.6, 0.3), [0.95, 0.5]);
        let step = |method| Baseline::new(&patch, method, Errors::Covariant).step(start, probe);
        assert!(matches!(step(Method::Newton), Advance::Out([u, _]) if u > 1.0));
        assert!(matches!(step(Method::SaturatedNewton), Advance::To([1.0, _])));
        assert!(matches!(step(Method::ProjectedNewton), Advance::To([u, _]) if u <= 1.0));
        assert!(matches!(step(Method::ProjectedGradient), Advance::To([u, _]) if u <= 1.0));
    }

    #[test]
    fn the_projected_gradient_ends_where_newton_does() {
        let patch = dome();
        // Over the middle, and beyond a border.
        for probe in [DVec3::new(0.55, 0.45, 0.8), DVec3::new(0.4, 1.6, 0.3)] {
            let [gradient, newton] = [Method::ProjectedGradient, Method::ProjectedNewton].map(|method| {
                let (baseline, mut at) = (Baseline::new(&patch, method, Errors::Covariant), [0.2, 0.7]);
                for _ in 0..2_000 {
                    let Advance::To(next) = baseline.step(at, probe) else { break };
                    at = next;
                }
                at
            });
            // The fall of V is lost in rounding at the root of a double's digits.
            assert!((0..2).all(|i| (gradient[i] - newton[i]).abs() < 1e-7), "{gradient:?} {newton:?}");
        }
    }
}

#[cfg(test)]
mod error_kinematics_tests {
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
