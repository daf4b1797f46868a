//! A point of a patch with its derivatives up to the second.

use super::SurfacePoint;
use crate::math::Vec3;

/// A point of a patch with its derivatives up to the second: one evaluation.
///
/// # Units
/// Metres, metres per unit of parameter, metres per unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedPoint {
    /// The point and both tangents.
    pub surface: SurfacePoint,
    /// The second derivatives.
    pub second: SecondDerivatives,
}

/// The second derivatives at a point of a patch, those of one variable halved: the form of Horner's rule, and of a
/// quadratic model.
///
/// # Units
/// Metres per unit of parameter squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondDerivatives {
    /// `½ f_uu`.
    pub half_uu: Vec3,
    /// `f_uv`.
    pub uv: Vec3,
    /// `½ f_vv`.
    pub half_vv: Vec3,
}

impl SecondDerivatives {
    /// The second derivatives of a plane that is evenly parametrised.
    pub const NONE: Self = Self { half_uu: Vec3::ZERO, uv: Vec3::ZERO, half_vv: Vec3::ZERO };

    /// `(ΔR · f_uu, ΔR · f_uv, ΔR · f_vv)`: the part of bending in the Hessian of `½ ‖ΔR‖²`.
    #[inline(always)]
    pub fn along(&self, difference: Vec3) -> [f32; 3] {
        let [uu, uv, vv] = [self.half_uu, self.uv, self.half_vv].map(|second| difference.dot(second));
        [uu + uu, uv, vv + vv]
    }

    /// `D²f[w, w]`.
    #[inline]
    pub fn bend(&self, [w_u, w_v]: [f32; 2]) -> Vec3 {
        self.half_uu * (2.0 * w_u * w_u) + self.uv * (2.0 * (w_u * w_v)) + self.half_vv * (2.0 * w_v * w_v)
    }
}

impl CurvedPoint {
    /// Result of a table without coefficients, which no check lets pass.
    pub(super) const NOWHERE: Self = Self { surface: SurfacePoint::NOWHERE, second: SecondDerivatives::NONE };
}
