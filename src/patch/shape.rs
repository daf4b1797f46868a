//! Proved bounds of a patch's shape: bending and stretch.

/// Upper bounds, over the whole patch, of the norms of the second partial derivatives.
///
/// From them the controller computes a step that is proved to lower the distance (see
/// [`crate::track::certified_gain`]). The host proves them from the control points; they hold for the stored
/// coefficients and include their rounding.
///
/// # Units
/// Metres per unit of parameter squared.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SecondDerivativeBounds {
    /// `sup ‖f_uu‖`.
    pub uu: f32,
    /// `sup ‖f_uv‖`.
    pub uv: f32,
    /// `sup ‖f_vv‖`.
    pub vv: f32,
}

impl SecondDerivativeBounds {
    /// The bounds of a plane that is evenly parametrised.
    pub const ZERO: Self = Self { uu: 0.0, uv: 0.0, vv: 0.0 };
}

/// Upper bounds, over the whole patch, of the norms of the third partial derivatives, and of the jumps of the second
/// ones between spans.
///
/// They limit the error of the quadratic model of a second-order step (theory §12). Infinite without a proof, as the
/// jump at a crease.
///
/// # Units
/// Metres per unit of parameter cubed; the jumps, metres per unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ThirdDerivativeBounds {
    /// `sup ‖f_uuu‖`.
    pub uuu: f32,
    /// `sup ‖f_uuv‖`.
    pub uuv: f32,
    /// `sup ‖f_uvv‖`.
    pub uvv: f32,
    /// `sup ‖f_vvv‖`.
    pub vvv: f32,
    /// Maximum jump of `f_uu` across a knot of `u`. On a C¹ patch no other second derivative jumps there.
    pub jump_uu: f32,
    /// Maximum jump of `f_vv` across a knot of `v`.
    pub jump_vv: f32,
}

impl ThirdDerivativeBounds {
    /// Nothing is known.
    pub const UNBOUNDED: Self = Self {
        uuu: f32::INFINITY,
        uuv: f32::INFINITY,
        uvv: f32::INFINITY,
        vvv: f32::INFINITY,
        jump_uu: f32::INFINITY,
        jump_vv: f32::INFINITY,
    };

    /// Whether these can be bounds: not negative, no NaN.
    const fn is_possible(&self) -> bool {
        let Self { uuu, uuv, uvv, vvv, jump_uu, jump_vv } = *self;
        uuu >= 0.0 && uuv >= 0.0 && uvv >= 0.0 && vvv >= 0.0 && jump_uu >= 0.0 && jump_vv >= 0.0
    }
}

/// Bounds of the normal curvature, over a patch or at a point of it.
///
/// # Units
/// 1/m, positive where the surface is convex seen from outside the body: `1/r` on a ball, `−1/r` in a hollow of radius
/// `r`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Curvature {
    /// Lower bound of the principal curvatures.
    pub min: f32,
    /// Upper bound of the principal curvatures.
    pub max: f32,
}

impl Curvature {
    /// Nothing is known.
    pub const UNBOUNDED: Self = Self { min: f32::NEG_INFINITY, max: f32::INFINITY };

    /// The curvature of a plane.
    pub const FLAT: Self = Self { min: 0.0, max: 0.0 };

    /// Whether nothing bends inward: a certificate, for proved bounds.
    pub const fn is_convex(self) -> bool {
        self.min >= 0.0
    }
}

/// Proved bounds of a patch's shape, over the whole patch.
///
/// The host proves the bounds of the stored coefficients by enclosures over cells; they are above the true values by
/// at most a stated slack, or the host reports it. Without a bound (the curvature near a pole, where the tangents span
/// no plane) the value is infinite, and the minimum stretch 0: limits computed from them are then infinite or 0 too,
/// never wrong.
///
/// ```
/// use palpate::patch::{Curvature, SecondDerivativeBounds, ShapeBounds};
///
/// // Written by hand: second derivatives, and a surface that is convex seen from outside.
/// const SHAPE: ShapeBounds = ShapeBounds {
///     curvature: Curvature { min: 0.0, max: 20.0 },
///     ..ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.04, uv: 0.0, vv: 0.04 })
/// };
/// assert!(SHAPE.curvature.is_convex());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ShapeBounds {
    /// Bounds of the second derivatives: always finite.
    pub second_derivatives: SecondDerivativeBounds,
    /// Bounds of the third derivatives, and of the jumps of the second ones.
    pub third_derivatives: ThirdDerivativeBounds,
    /// Bounds of the normal curvature with respect to the outward normal.
    pub curvature: Curvature,
    /// Lower bound of the eigenvalues of the first fundamental form `I`, m²: `wᵀ I w ≥ min_stretch · ‖w‖²`.
    pub min_stretch: f32,
    /// Upper bound of its eigenvalues, m².
    pub max_stretch: f32,
    /// Upper bound of `(uu w_u² + 2 uv |w_u w_v| + vv w_v²) / (wᵀ I w)` for any change `w` of the parameters, with the
    /// bounds of the second derivatives above: the curvature in the certified gain, 1/m. Never below the maximum
    /// curvature, because it includes the crowding of the parameters.
    pub max_bend: f32,
}

impl ShapeBounds {
    /// Only the second derivatives are bounded.
    pub const fn unknown(second_derivatives: SecondDerivativeBounds) -> Self {
        Self {
            second_derivatives,
            third_derivatives: ThirdDerivativeBounds::UNBOUNDED,
            curvature: Curvature::UNBOUNDED,
            min_stretch: 0.0,
            max_stretch: f32::INFINITY,
            max_bend: f32::INFINITY,
        }
    }

    /// Whether these can be bounds: no NaN, in order, the second derivatives finite.
    pub(super) const fn is_possible(&self) -> bool {
        let SecondDerivativeBounds { uu, uv, vv } = self.second_derivatives;
        let finite = uu < f32::INFINITY && uv < f32::INFINITY && vv < f32::INFINITY;
        let positive = uu >= 0.0 && uv >= 0.0 && vv >= 0.0 && self.min_stretch >= 0.0 && self.max_bend >= 0.0;
        let curvature = self.curvature.min <= self.curvature.max;
        finite && positive && curvature && self.third_derivatives.is_possible() && self.min_stretch <= self.max_stretch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_bounds_are_refused_and_missing_ones_are_not() {
        let unknown = ShapeBounds::unknown(SecondDerivativeBounds { uu: 1.0, uv: 0.0, vv: 2.0 });
        assert!(unknown.is_possible() && !unknown.curvature.is_convex());
        let flat = ShapeBounds { curvature: Curvature::FLAT, max_bend: 0.0, ..unknown };
        assert!(flat.is_possible() && flat.curvature.is_convex());
        let third = ThirdDerivativeBounds::UNBOUNDED;
        let derivatives = SecondDerivativeBounds { uu: f32::INFINITY, uv: 0.0, vv: 0.0 };
        for wrong in [
            ShapeBounds { curvature: Curvature { min: 2.0, max: 1.0 }, ..unknown },
            ShapeBounds { curvature: Curvature { min: f32::NAN, max: 1.0 }, ..unknown },
            ShapeBounds { min_stretch: 2.0, max_stretch: 1.0, ..unknown },
            ShapeBounds { min_stretch: f32::NAN, ..unknown },
            ShapeBounds { max_bend: -1.0, ..unknown },
            ShapeBounds { third_derivatives: ThirdDerivativeBounds { uvv: -1.0, ..third }, ..unknown },
            ShapeBounds { third_derivatives: ThirdDerivativeBounds { jump_vv: f32::NAN, ..third }, ..unknown },
            ShapeBounds::unknown(derivatives),
        ] {
            assert!(!wrong.is_possible(), "{wrong:?}");
        }
    }
}
