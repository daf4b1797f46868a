//! The last bounds on a force: its length, and how fast it may grow.

use crate::math::{Vec3, inverse_sqrt, saturate};

/// `force` with at most the length `greatest`, its direction kept. A force that is not finite stays so: the gate turns
/// it into a fault.
#[inline]
pub fn saturated(force: Vec3, greatest: f32) -> Vec3 {
    let squared = force.length_squared();
    if squared > greatest * greatest {
        if squared < f32::INFINITY {
            return force * (greatest * inverse_sqrt(squared));
        }
        // Divided by its largest entry first, for its square is not finite.
        let scale = saturate(force.x.abs(), 1e-18, f32::MAX);
        let scale = if force.y.abs() > scale { force.y.abs() } else { scale };
        let scale = if force.z.abs() > scale { force.z.abs() } else { scale };
        let unit = force * (1.0 / scale);
        return unit * (greatest * inverse_sqrt(unit.length_squared()));
    }
    force
}

/// `force`, grown from `last` by at most `most` (N). A fall is not limited: only the difference from the nearest weaker
/// force of the last direction counts as growth, so a limit never holds a probe that has left the surface.
#[inline]
pub fn slewed(force: Vec3, last: Vec3, most: f32) -> Vec3 {
    if most == f32::INFINITY {
        return force;
    }
    let squared = last.length_squared();
    let share = if squared > 0.0 { saturate(force.dot(last) / squared, 0.0, 1.0) } else { 0.0 };
    let weaker = last * share;
    weaker + saturated(force - weaker, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vec3;

    #[test]
    fn a_long_force_keeps_its_direction() {
        for length in [6.0_f32, 1e10, 1e25, 3e38] {
            let force = saturated(vec3(0.6, 0.0, -0.8) * length, 5.0);
            assert!((force - vec3(3.0, 0.0, -4.0)).length() < 1e-5, "{length}: {force}");
        }
        assert_eq!(saturated(vec3(1.0, -2.0, 0.5), 5.0), vec3(1.0, -2.0, 0.5));
        assert!(
            !saturated(Vec3::X * f32::NAN, 5.0).is_finite() && !saturated(Vec3::X * f32::INFINITY, 5.0).is_finite()
        );
    }

    #[test]
    fn a_force_grows_slowly_and_falls_at_once() {
        assert!((slewed(Vec3::X * 5.0, Vec3::X, 0.1).x - 1.1).abs() < 1e-6);
        assert_eq!(slewed(Vec3::X * 0.2, Vec3::X, 0.1).x, 0.2);
        assert_eq!(slewed(Vec3::ZERO, Vec3::X * 4.0, 0.1), Vec3::ZERO);
        // Reversed: zero at once, and then a step.
        assert!((slewed(Vec3::X * -3.0, Vec3::X, 0.1).x + 0.1).abs() < 1e-6);
        assert!((slewed(Vec3::Y * 3.0, Vec3::X, 0.1) - Vec3::Y * 0.1).length() < 1e-6);
        assert_eq!(slewed(Vec3::X * 5.0, Vec3::ZERO, f32::INFINITY).x, 5.0);
    }
}
