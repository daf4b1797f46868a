//! WoodenHaptics.

use crate::device::drive::Feed;
use crate::device::{Device, Encoder, Motor, SerialArm};
use crate::math::vec3;

/// WoodenHaptics as published in 2016: 3-D serial arm with Maxon RE30 motors on capstans.
///
/// Lengths 80, 205 and 245 mm; capstan 10 mm on bodies of 160, 120 and 120 mm (16:1, 12:1, 12:1); 2,000 counts a turn;
/// 0.0259 N·m/A at 3 A; 5 N, 1,000 N/m, 8 N·s/m. Source: the configuration of the project's CHAI3D driver
/// (woody-experimental, `cWoodenDevice`). Zero counts is the calibration pose: first link upright, second level.
/// Directions are those of the driver's USB variant, in which the turntable's encoder counts against its motor. At the
/// workspace centre the first link's motor is at full duty with 4.8 N along x; along y and z 5 N are within reach. Link
/// masses 170 and 110 g with centres at 51 and 91 mm, from the same driver; its gravity compensation lifts the second
/// link at the sum of both centres instead of at the first link's end, which is not followed here. A plain
/// wall of 1,000 N/m and 2 to 8 N·s/m at 4 kHz, pressed in simulation, gives stiffness times depth to 1 %, and no count
/// moves; [`crate::servo::recommended`] is softer, so that a hand feels no count either. The joint range and the maximum rate are ours: wide enough for its workspace and for a hand at 3 m/s.
pub const WOODEN_HAPTICS_2016: Device<SerialArm, 3> = Device {
    kinematics: SerialArm {
        base_height_m: 0.080,
        first_link_m: 0.205,
        second_link_m: 0.245,
        workspace_centre_m: vec3(0.220, 0.0, 0.080),
        end_masses_kg: [0.170 * 0.051 / 0.205 + 0.110, 0.110 * 0.091 / 0.245],
    },
    encoders: [
        Encoder::geared(2_000.0, -16.0, 0.0),
        Encoder::geared(2_000.0, -12.0, 0.0),
        Encoder::geared(2_000.0, 12.0, 0.0),
    ],
    motors: [
        Motor::current_driven(0.0259, 3.0, 16.0),
        Motor::current_driven(0.0259, 3.0, -12.0),
        Motor::current_driven(0.0259, 3.0, 12.0),
    ],
    feeds: [Feed::Current; 3],
    dry_friction_n_m: [0.01; 3],
    joint_range_rad: [[-1.6, 1.6], [-0.8, 2.2], [-1.2, 1.8]],
    min_margin_m_per_rad: 0.05,
    max_joint_rate_rad_per_s: 25.0,
    max_force_n: 5.0,
    max_stiffness_n_per_m: 1_000.0,
    max_damping_n_s_per_m: 8.0,
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::Kinematics;

    #[test]
    fn wooden_haptics_resolves_what_is_published() {
        // Published for the probe: 43, 54 and 64 µm, to the micrometre. The levers are the reach at the workspace
        // centre and the two links.
        for ((encoder, lever), micrometres) in
            WOODEN_HAPTICS_2016.encoders.iter().zip([0.220, 0.205, 0.245]).zip([43.0, 54.0, 64.0])
        {
            let step = encoder.radians_per_count.abs() * lever * 1e6;
            assert!((step - micrometres).abs() <= 0.5, "{step} µm, published {micrometres} µm");
        }
    }

    #[test]
    fn wooden_haptics_gives_its_greatest_force_at_the_workspace_centre_or_all_but_four_percent() {
        // Joint angles that put the probe at the centre, to a millimetre.
        let pose = WOODEN_HAPTICS_2016.kinematics.pose([0.0, 0.344, 0.907]).expect("within reach");
        assert!(pose.position.length() < 1e-3, "{}", pose.position);
        // 5 N × 0.205 m × cos 0.344 along x ask the first link for 0.965 N·m; 12 × 3 A × 0.0259 N·m/A are 0.932 N·m.
        for (axis, load) in [(vec3(1.0, 0.0, 0.0), 1.035), (vec3(0.0, 1.0, 0.0), 0.885), (vec3(0.0, 0.0, 1.0), 0.809)] {
            let torques = pose.torques(axis * WOODEN_HAPTICS_2016.max_force_n);
            let fractions: [f32; 3] =
                core::array::from_fn(|joint| WOODEN_HAPTICS_2016.motors[joint].fraction(torques[joint]));
            let largest = fractions.into_iter().fold(0.0, |most: f32, fraction: f32| most.max(fraction.abs()));
            // To the last digit above.
            assert!((largest - load).abs() < 0.001, "{axis}: {fractions:?}");
        }
    }
}
