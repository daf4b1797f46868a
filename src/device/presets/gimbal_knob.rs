//! A knob on a gimbal motor.

use crate::device::drive::{Feed, VoltageFeed};
use crate::device::{Commutation, Device, Dial, Encoder, Endurance, Motor, Protection};

/// Counts of an AS5047P in a turn.
const COUNTS: f32 = 16_384.0;
/// Current at full duty, A, in the scale that keeps the power: 0.61 A of amplitude in a phase.
const CURRENT_AT_FULL: f32 = 0.75;
const FEED: VoltageFeed = VoltageFeed::three_phase(12.0, 7.5, 80.0, CURRENT_AT_FULL);

/// A dial of 40 mm on the shaft of a gimbal motor GBM5208-75T, with a magnetic sensor AS5047P behind it, on 12 V.
///
/// Eleven pole pairs, 7.5 Ω a phase and 80 rpm/V as published by users of the motor (eliferin14/
/// GBM5208-75T_system_identification, which cites its sellers). So 84 mN·m/A, and 63 mN·m at full duty, for which the
/// motor needs 5.6 of the 8.5 V that the stage gives at most. Assumed: friction, and the maximum stiffness and damping,
/// which the simulated knob takes. The cogging is each motor's own: record it ([`crate::device::CoggingMap`]).
pub const GIMBAL_KNOB: Device<Dial, 1> = Device {
    kinematics: Dial { radius_m: 0.02, cogging: None },
    encoders: [Encoder::geared(COUNTS, 1.0, 0.0)],
    motors: [Motor::current_driven(FEED.torque_constant_n_m_per_a, CURRENT_AT_FULL, 1.0)],
    feeds: [Feed::Voltage(FEED)],
    dry_friction_n_m: [2e-3],
    joint_range_rad: [[f32::NEG_INFINITY, f32::INFINITY]],
    min_margin_m_per_rad: 0.01,
    max_joint_rate_rad_per_s: 120.0,
    max_force_n: 2.8,
    max_stiffness_n_per_m: 4_000.0,
    max_damping_n_s_per_m: 8.0,
};

/// How the sensor of [`GIMBAL_KNOB`] goes with the motor's poles.
pub const GIMBAL_KNOB_COMMUTATION: Commutation = Commutation { counts_per_turn: 16_384, pole_pairs: 11 };

/// Protection of [`GIMBAL_KNOB`].
///
/// Users of the motor cite one point at which a seller has it hold, 0.47 A at 5 V, without a duration. This protection
/// assumes 0.4 A continuous, in whichever phase has the most ([`Endurance::three_phase`]): 41 of the 63 mN·m. It
/// assumes 20 s, short for a winding of its weight. Above nine and a half turns a second under force, the motor runs
/// away, or a spring that was wound up by far was released.
///
/// No polarity check: it needs contacts that start in free air, which a knob does not have, and the alignment finds the
/// polarity at every start. No supply range: add one if your board measures the supply.
pub const GIMBAL_KNOB_PROTECTION: Protection<1> = Protection {
    motors: [Endurance::three_phase(0.4, CURRENT_AT_FULL, 20.0)],
    max_joint_rates_rad_per_s: [60.0],
    max_probe_speed_m_per_s: 1.2,
    supply: None,
    polarity: None,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Kinematics;
    use crate::math::vec3;

    #[test]
    fn the_greatest_force_is_within_the_motor_and_the_motor_within_its_supply() {
        let [torque] =
            GIMBAL_KNOB.kinematics.pose([0.0]).expect("within reach").torques(vec3(GIMBAL_KNOB.max_force_n, 0.0, 0.0));
        let [motor] = GIMBAL_KNOB.motors;
        assert!(motor.fraction(torque) <= 1.0, "{}", motor.fraction(torque));
        // 60/(2π · 80) V·s/rad between two wires, over √2.
        assert!((FEED.torque_constant_n_m_per_a - 0.084_4).abs() < 1e-4, "{}", FEED.torque_constant_n_m_per_a);
        const { assert!(FEED.resistance_ohm * CURRENT_AT_FULL < FEED.full_v()) };
        assert!(GIMBAL_KNOB_COMMUTATION.is_valid());
    }

    #[test]
    fn it_bears_for_ever_what_its_strongest_detents_hold_and_the_amplitude_of_a_phase_is_what_counts() {
        let [Endurance { continuous, .. }] = GIMBAL_KNOB_PROTECTION.motors;
        // 0.75 A, √(2/3) of which is the amplitude.
        let squared = 2.0 / 3.0 * (continuous * CURRENT_AT_FULL) * (continuous * CURRENT_AT_FULL);
        assert!((squared - 0.4 * 0.4).abs() < 1e-6, "{squared}");
        assert!(continuous * GIMBAL_KNOB.motors[0].torque_at_full_n_m > 0.04);
    }
}
