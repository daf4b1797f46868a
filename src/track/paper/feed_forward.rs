//! Motion of the probe, fed forward (Remark 3).

use super::laws::FeedForward;
use crate::math::Vec3;
use crate::patch::SurfacePoint;
use crate::track::ProjectionErrors;

/// The gradient that stands in for `g` when a step of the given gain also follows the probe's motion.
///
/// A tick sees the probe where it is now, so `g` already contains the motion of the last period, `moved`, as `g_m =
/// −(moved · f_u, moved · f_v)`. A step `−a I⁻¹ g` follows the fraction `a` of it; with the rest, `1 − a`, `−I⁻¹ (a g +
/// (1 − a) g_m) = −a I⁻¹ (g + (1 − a)/a g_m)`, it corrects the old error with gain `a` and follows all of the motion:
/// `ẋ = I⁻¹ Jᵀ q̇ − K Ψ` in discrete time. The part of the motion that comes from the surface's curvature is left to
/// the correction: the lag shrinks by about `κ ‖ΔR‖`, not to zero.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    /// Eq. (13), on skewed tangents: each component's motion is followed exactly where its share of the rise of the
    /// distance, `Ψ` times the motion's component, is positive.
    #[test]
    fn gated_follows_what_disturbs_and_leaves_what_helps() {
        let surface =
            SurfacePoint { point: Vec3::ZERO, tangent_u: vec3(1.0, 0.0, 0.0), tangent_v: vec3(0.7, 1.1, 0.0) };
        let mut reached = [0; 4];
        for turn in 0..24 {
            for move_turn in 0..24 {
                let along = |turn: i32| {
                    let (sine, cosine) = crate::math::sin_cos(turn as f32 * 0.261_8 + 0.1);
                    vec3(cosine, sine, 0.0)
                };
                let errors = ProjectionErrors::new(&surface, along(turn) * 0.1);
                let moved = along(move_turn) * 0.01;
                let of = |kind| gradient(kind, &errors, &surface, moved, 0.25);
                let [none, gated, full] = [FeedForward::None, FeedForward::Gated, FeedForward::Full].map(of);
                let psi = errors.measure_numbers().unwrap();
                let motion = [-moved.dot(surface.tangent_u), -moved.dot(surface.tangent_v)];
                let disturbs = [0, 1].map(|axis| psi[axis] * motion[axis] > 0.0);
                for axis in [0, 1] {
                    assert_eq!(gated[axis], if disturbs[axis] { full[axis] } else { none[axis] });
                    // With the gain of a quarter, three quarters of the motion are to be followed besides: three times.
                    assert!((full[axis] - none[axis] - 3.0 * motion[axis]).abs() < 1e-6);
                }
                reached[usize::from(disturbs[0]) + 2 * usize::from(disturbs[1])] += 1;
            }
        }
        assert!(reached.iter().all(|count| *count > 0), "{reached:?}");
    }
}
