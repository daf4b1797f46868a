//! The gain schedule: the longest step proved to bring the witness point nearer.

use super::boundary::Descent;
use crate::math::sqrt_from_above;
use crate::patch::SecondDerivativeBounds;

/// The gain `a = K h` of a step that is proved to lower the distance, from bounds stored with the patch.
///
/// Let `w` be the direction, `φ(a) = ½ ‖f(x + a w) − Q‖²`, `s` the slope `−gᵀw`, `ℓ²` a bound of `wᵀ I w` (it is `s`,
/// or less, for the laws without feed-forward) and `m = sup ‖D²f[w, w]‖`, the supremum over the patch, at most `‖f_uu‖
/// w_u² + 2 ‖f_uv‖ |w_u w_v| + ‖f_vv‖ w_v²` with the stored bounds. Along the step the speed `‖Df w‖` grows at most by
/// `a m`, and while the distance falls it is at most `R = ‖ΔR‖`, so for `0 ≤ a ≤ 1`
///
/// `φ''(a) = ‖Df w‖² + ΔR · D²f[w, w] ≤ (ℓ + m)² + R m`, hence `φ(a) ≤ φ(0) − a s + ½ a² ((ℓ + m)² + R m)`.
///
/// The minimiser of the right-hand side in `[0, 1]` is `s / ((ℓ + m)² + R m) = s / (ℓ² + m (m + 2ℓ + R))`. The
/// function takes the roots `ℓ` and `R` from above ([`crate::math::sqrt_from_above`], by at most 6.1 %): as an upper
/// bound the inequality holds with any of them, and `a` is the minimiser of that bound. So `½ ‖ΔR‖²` falls by at least
/// `½ a s`, and falls all along the step, so a step cut at the patch's border lowers it too. Near the closest point
/// `m/s → c`, a curvature of the parametrisation, and `a → 1 / (1 + c R)`, or with `c R` larger by those 6.1 %: the
/// gain schedule of the paper's limits of performance with a proved constant. The patch must be C¹ along the step; its
/// second derivatives may jump.
///
/// # Units
/// `distance_squared` in metres squared; the gain is a pure number, `K h` with `K` in 1/s and the period `h` in s. Not
/// above 1, except with feed-forward, where `ℓ²` may be less than `s`: there the plain gain bounds it.
#[inline(always)]
pub fn certified_gain(descent: &Descent, bounds: &SecondDerivativeBounds, distance_squared: f32) -> f32 {
    let [w_u, w_v] = descent.direction;
    let bend = bounds.uu * w_u * w_u + 2.0 * bounds.uv * (w_u * w_v).abs() + bounds.vv * w_v * w_v;
    let (length, distance) = (sqrt_from_above(descent.length_squared), sqrt_from_above(distance_squared));
    descent.slope / (descent.length_squared + bend * (bend + 2.0 * length + distance))
}
