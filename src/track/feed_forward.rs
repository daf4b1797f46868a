//! Motion of the probe, fed forward (Remark 3).

use super::law::FeedForward;
use super::projection::ProjectionErrors;
use crate::math::Vec3;
use crate::patch::SurfacePoint;

/// The gradient that stands in for `g` when a step of the given gain also follows the probe's motion.
///
/// A tick sees the probe where it is now, so `g` already holds what the motion of the last period, `moved`, added to it:
/// `g_m = −(moved · f_u, moved · f_v)`. A step `−a I⁻¹ g` follows the fraction `a` of it; with the rest, `1 − a`,
/// `−I⁻¹ (a g + (1 − a) g_m) = −a I⁻¹ (g + (1 − a)/a g_m)`, it corrects the old error with gain `a` and follows all of the
/// motion: `ẋ = I⁻¹ Jᵀ q̇ − K Ψ` in discrete time. What the surface's curvature makes of the motion is left to the
/// correction: the lag shrinks by about `κ ‖ΔR‖`, not to zero.
#[inline]
pub fn gradient(
    feed_forward: FeedForward,
    errors: &ProjectionErrors,
    surface: &SurfacePoint,
    moved: Vec3,
    gain: f32,
) -> [f32; 2] {
    let [along_u, along_v] = errors.gradient;
    let motion = [-moved.dot(surface.tangent_u), -moved.dot(surface.tangent_v)];
    let rest = (1.0 - gain) / gain;
    let psi = errors.measure_numbers().unwrap_or(errors.gradient);
    // Motion disturbs a component where it drives the error further from zero.
    let followed = |axis: usize| match feed_forward {
        FeedForward::None => 0.0,
        FeedForward::Gated if psi[axis] * motion[axis] <= 0.0 => 0.0,
        FeedForward::Gated | FeedForward::Full => rest * motion[axis],
    };
    [along_u + followed(0), along_v + followed(1)]
}
