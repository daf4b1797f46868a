//! What the page shows beside the controller: Newton's method, as the paper compares with it, in the `f32` of the
//! firmware's own tables.

use palpate::math::Vec3;
use palpate::patch::{CurvedPoint, SplinePatch};
use palpate::track::ProjectionErrors;

/// Which errors it drives to zero, and what it does at a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Newton {
    /// The paper's: the measure numbers `Ψ` of Eq. (4); what leaves the patch has failed.
    Paper,
    /// The same with saturation: a parameter that would pass its border stops there.
    Saturated,
    /// The textbooks': the gradient of `½ ‖ΔR‖²` by its Hessian, with saturation.
    Textbook,
}

impl Newton {
    /// The next parameters, outside of `[0, 1]²` where the method leaves it; `None` where its matrix is singular.
    pub fn step(self, patch: &SplinePatch<'static>, [u, v]: [f32; 2], probe: Vec3) -> Option<[f32; 2]> {
        let at = patch.evaluate_curved(u, v);
        let (errors, matrix) = if self == Self::Textbook { hessian(&at, probe) } else { measured(&at, probe)? };
        let ([first, second], [[a, b], [c, d]]) = (errors, matrix);
        let determinant = a * d - b * c;
        let next = [u + (b * second - d * first) / determinant, v + (c * first - a * second) / determinant];
        if !next.iter().all(|parameter| parameter.is_finite()) {
            return None;
        }
        Some(if self == Self::Paper { next } else { next.map(|parameter| parameter.clamp(0.0, 1.0)) })
    }
}

/// `g` and its derivative `I + ΔR · D²f`.
fn hessian(at: &CurvedPoint, probe: Vec3) -> ([f32; 2], [[f32; 2]; 2]) {
    let errors = ProjectionErrors::new(&at.surface, probe);
    let [uu, uv, vv] = at.second.along(errors.difference);
    let mixed = errors.form.f + uv;
    (errors.gradient, [[errors.form.e + uu, mixed], [mixed, errors.form.g + vv]])
}

/// `Ψ = I⁻¹ g` and its derivative `M = 1 + I⁻¹ B`, `B_ik = Δ N · f_ik − f_i · Σ_j f_jk Ψ_j`, where `Δ N` is the
/// normal part of `ΔR` (the paper's Figure 2). `None` where the tangents span no plane.
fn measured(at: &CurvedPoint, probe: Vec3) -> Option<([f32; 2], [[f32; 2]; 2])> {
    let errors = ProjectionErrors::new(&at.surface, probe);
    let psi = errors.measure_numbers()?;
    let tangents = [at.surface.tangent_u, at.surface.tangent_v];
    let mixed = at.second.uv;
    let seconds = [[at.second.half_uu * 2.0, mixed], [mixed, at.second.half_vv * 2.0]];
    let normal_part = errors.difference - tangents[0] * psi[0] - tangents[1] * psi[1];
    let (form, determinant) = (errors.form, errors.form.determinant());
    let column = |k: usize| {
        let turning = seconds[0][k] * psi[0] + seconds[1][k] * psi[1];
        let [x, y] = [0, 1].map(|i: usize| normal_part.dot(seconds[i][k]) - tangents[i].dot(turning));
        [(form.g * x - form.f * y) / determinant, (form.e * y - form.f * x) / determinant]
    };
    let [along_u, along_v] = [column(0), column(1)];
    Some((psi, [[1.0 + along_u[0], along_v[0]], [along_u[1], 1.0 + along_v[1]]]))
}
