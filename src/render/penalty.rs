//! The penalty force: a unilateral spring and damper along the surface normal.

use crate::math::saturate;

/// Stiffness, damping and their limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalty {
    /// Stiffness, N/m.
    pub stiffness_n_per_m: f32,
    /// Damping, N·s/m. A sampled wall is passive only with the device's own damping above `stiffness · period / 2 +
    /// damping` (Colgate and Schenkel).
    pub damping_n_s_per_m: f32,
    /// Maximum force, N.
    pub max_force_n: f32,
}

impl Penalty {
    /// The push along the outward normal, N, at a signed gap (m) that changes at a rate (m/s): from 0, because the wall
    /// never pulls, to the maximum force.
    #[inline]
    pub fn push(&self, gap: f32, gap_rate: f32) -> f32 {
        if gap < 0.0 {
            let spring_and_damper = -self.stiffness_n_per_m * gap - self.damping_n_s_per_m * gap_rate;
            saturate(spring_and_damper, 0.0, self.max_force_n)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: Penalty = Penalty { stiffness_n_per_m: 1_000.0, damping_n_s_per_m: 5.0, max_force_n: 5.0 };

    #[test]
    fn the_wall_pushes_and_never_pulls() {
        assert_eq!(WALL.push(0.001, -1.0), 0.0);
        assert_eq!(WALL.push(-0.002, 0.0), 2.0);
        assert_eq!(WALL.push(-0.001, -0.1), 1.5);
        assert_eq!(WALL.push(-0.001, 10.0), 0.0);
        assert_eq!(WALL.push(-1.0, 0.0), 5.0);
    }

    #[test]
    fn nothing_that_is_not_a_number_becomes_a_force_beyond_the_limit() {
        for gap in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            for rate in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                let push = WALL.push(gap, rate);
                assert!((0.0..=5.0).contains(&push), "{gap} {rate}: {push}");
            }
        }
    }
}
