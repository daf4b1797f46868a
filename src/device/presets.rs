//! Devices by name, with where their numbers come from.

use super::{Device, Encoder, Motor, SerialArm};
use crate::math::vec3;

/// WoodenHaptics as published in 2016: 3-D serial arm with Maxon RE30 motors on capstans.
///
/// Lengths 80, 205 and 245 mm; capstan 10 mm on bodies of 160, 120 and 120 mm (16:1, 12:1, 12:1); 2,000 counts a turn;
/// 0.0259 N·m/A at 3 A; 5 N, 1,000 N/m, 8 N·s/m. Source: the configuration of the project's CHAI3D driver
/// (woody-experimental, `cWoodenDevice`). Zero counts is the calibration pose: first link upright, second level.
/// The joint range and the greatest rate are ours: wide enough for its workspace and for a hand at 3 m/s.
pub const WOODEN_HAPTICS_2016: Device<SerialArm, 3> = Device {
    kinematics: SerialArm {
        base_height: 0.080,
        first_link: 0.205,
        second_link: 0.245,
        workspace_centre: vec3(0.220, 0.0, 0.080),
    },
    encoders: [
        Encoder::geared(2_000.0, -16.0, 0.0),
        Encoder::geared(2_000.0, -12.0, 0.0),
        Encoder::geared(2_000.0, 12.0, 0.0),
    ],
    motors: [
        Motor::current_driven(0.0259, 3.0, -16.0),
        Motor::current_driven(0.0259, 3.0, -12.0),
        Motor::current_driven(0.0259, 3.0, 12.0),
    ],
    joint_range: [[-1.6, 1.6], [-0.8, 2.2], [-1.2, 1.8]],
    greatest_joint_rate: 25.0,
    greatest_force: 5.0,
    greatest_stiffness: 1_000.0,
    greatest_damping: 8.0,
};
