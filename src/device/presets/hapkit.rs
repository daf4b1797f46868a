//! Hapkit.

use crate::device::drive::{Feed, VoltageFeed};
use crate::device::{Device, Encoder, Motor, Paddle};

/// Turns of the motor for one of the sector.
const RATIO: f32 = 0.073_152 / 0.004_191;

/// Hapkit, the one-joint paddle for teaching.
///
/// Handle 65.659 mm, sector 73.152 mm on a pulley of 4.191 mm; 726.6 sensor counts for ten degrees of the handle, so 16
/// µm a count at the hand. Source: reitermarkus/hapkit, `constants.hpp`. Motor 0.03 N·m, which is 8 N at the handle.
/// Assumed: the winding (10 Ω and 0.025 N·m/A on 12 V give those 0.03 N·m at standstill), directions (counts and duty
/// rise towards x), maximum stiffness and damping; the paddle's weight is not known and left out.
pub const HAPKIT: Device<Paddle, 1> = Device {
    kinematics: Paddle { handle_m: 0.065_659, mass_moment_kg_m: 0.0 },
    encoders: [Encoder::new(core::f32::consts::PI / 18.0 / 726.6, 0.0)],
    motors: [Motor::current_driven(0.025, 1.2, RATIO)],
    feeds: [Feed::Voltage(VoltageFeed {
        supply_v: 12.0,
        full_fraction: 1.0,
        resistance_ohm: 10.0,
        torque_constant_n_m_per_a: 0.025,
        current_at_full_a: 1.2,
        ratio: RATIO,
        back_emf_fraction: 0.8,
    })],
    dry_friction_n_m: [2e-3],
    joint_range_rad: [[-0.8, 0.8]],
    // The only margin a lever has is its own length: a quarter above, all of the force is given.
    min_margin_m_per_rad: 0.05,
    max_joint_rate_rad_per_s: 35.0,
    max_force_n: 7.9,
    max_stiffness_n_per_m: 500.0,
    max_damping_n_s_per_m: 2.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::drive::Supply;
    use crate::device::{Duty, Kinematics};
    use crate::math::vec3;

    #[test]
    fn full_duty_is_the_published_eight_newtons() {
        let [motor] = HAPKIT.motors;
        let [torque] = HAPKIT.kinematics.pose([0.0]).expect("within reach").torques(vec3(7.97, 0.0, 0.0));
        // 0.03 N·m · 0.073152/0.004191 / 0.065659 m, to its three digits.
        assert!((motor.fraction(torque) - 1.0).abs() < 1e-3, "{}", motor.fraction(torque));
        // At standstill the supply gives all of it.
        assert_eq!(HAPKIT.feed(true, [Duty::FULL], [0.0], Supply::UNMEASURED), [Duty::FULL]);
        // After a fault nothing, whatever the rates say.
        assert_eq!(HAPKIT.feed(false, [Duty::ZERO], [30.0], Supply::UNMEASURED), [Duty::ZERO]);
        assert_ne!(HAPKIT.feed(true, [Duty::ZERO], [30.0], Supply::UNMEASURED), [Duty::ZERO]);
    }
}
