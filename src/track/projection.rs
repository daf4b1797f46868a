//! The projection errors at a witness point.

use crate::math::Vec3;
use crate::patch::SurfacePoint;

/// The first fundamental form `I = [[E, F], [F, G]]`, metres squared.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct FirstFundamentalForm {
    /// `E = f_u · f_u`.
    pub e: f32,
    /// `F = f_u · f_v`.
    pub f: f32,
    /// `G = f_v · f_v`.
    pub g: f32,
}

impl FirstFundamentalForm {
    /// `det I = E G − F²`, the squared area of a unit parameter square.
    #[inline]
    pub fn determinant(&self) -> f32 {
        self.e * self.g - self.f * self.f
    }
}

/// The distance of the witness point from the closest one, in the tangent plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectionErrors {
    /// `ΔR = P − Q`, metres.
    pub difference: Vec3,
    /// `g = (ΔR · f_u, ΔR · f_v)`, the gradient of `½ ‖ΔR‖²`, metres squared.
    pub gradient: [f32; 2],
    /// The first fundamental form at the witness point.
    pub form: FirstFundamentalForm,
}

/// Minimum `sin²` of the angle between the tangents at which the first fundamental form is inverted. Below it the
/// determinant, a difference of nearly equal numbers, would have fewer than ten good bits.
pub(super) const MIN_SINE_SQUARED: f32 = 1.0e-4;

impl ProjectionErrors {
    /// The errors of the probe against a surface point.
    #[inline(always)]
    pub fn new(surface: &SurfacePoint, probe: Vec3) -> Self {
        let (f_u, f_v) = (surface.tangent_u, surface.tangent_v);
        let difference = surface.point - probe;
        Self {
            difference,
            gradient: [difference.dot(f_u), difference.dot(f_v)],
            form: FirstFundamentalForm { e: f_u.dot(f_u), f: f_u.dot(f_v), g: f_v.dot(f_v) },
        }
    }

    /// The measure numbers `Ψ = I⁻¹ g` of Eq. (4); `None` where the tangents are so nearly parallel, or so short, that
    /// they span no plane (at a pole).
    #[inline]
    pub fn measure_numbers(&self) -> Option<[f32; 2]> {
        self.correction().map(|[along_u, along_v]| [-along_u, -along_v])
    }

    /// `−Ψ`, the change of the parameters that removes the errors on a plane; `None` as of [`Self::measure_numbers`].
    #[inline(always)]
    pub fn correction(&self) -> Option<[f32; 2]> {
        let FirstFundamentalForm { e, f, g } = self.form;
        let determinant = self.form.determinant();
        if determinant > MIN_SINE_SQUARED * (e * g) {
            let inverse = -1.0 / determinant;
            let [along_u, along_v] = self.gradient;
            Some([(g * along_u - f * along_v) * inverse, (e * along_v - f * along_u) * inverse])
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    #[test]
    fn measure_numbers_rebuild_the_difference_on_skewed_tangents() {
        let surface =
            SurfacePoint { point: vec3(0.1, 0.2, 0.3), tangent_u: vec3(2.0, 0.0, 0.0), tangent_v: vec3(1.5, 0.5, 0.0) };
        let errors = ProjectionErrors::new(&surface, vec3(-0.4, 0.7, 1.0));
        let [psi_u, psi_v] = errors.measure_numbers().unwrap();
        let rebuilt = surface.tangent_u * psi_u + surface.tangent_v * psi_v + vec3(0.0, 0.0, -0.7);
        // A handful of roundings of numbers near 1.
        assert!((rebuilt - errors.difference).length() < 1e-6);
    }

    #[test]
    fn parallel_tangents_have_no_measure_numbers() {
        let surface = SurfacePoint { point: Vec3::ZERO, tangent_u: Vec3::X, tangent_v: Vec3::X * 3.0 };
        assert_eq!(ProjectionErrors::new(&surface, Vec3::Y).measure_numbers(), None);
        let pole = SurfacePoint { point: Vec3::ZERO, tangent_u: Vec3::ZERO, tangent_v: Vec3::X };
        assert_eq!(ProjectionErrors::new(&pole, Vec3::Y).measure_numbers(), None);
    }
}
