//! Phantom Premium.

use crate::device::drive::Feed;
use crate::device::{Device, Encoder, Motor, SerialArm};
use crate::math::vec3;
use core::f32::consts::FRAC_PI_2;

/// An arm of the Phantom Premium 1.5's size.
///
/// Links 209.55 and 169.545 mm; 13.3:1, 11.2:1 and 11.2:1; 0.0234 N·m/A, 0.129 N·m at most (5.5 A); and the balance of
/// the links, which all but carry themselves (a counterweight of 31.75 mm lever among them): the dynamic model of
/// Çavuşoğlu, Feygin and Tendick (2001) as measured again in a public implementation, where the angles count the first
/// link up from level and the second up from hanging. Zero counts is that pose, and its probe the origin: first link
/// level, second hanging. Resolution is published as 0.03 mm, so 4,000 counts are assumed; maximum force (the force
/// that the motors reach at the origin along every axis) and damping too. Stiffness: half of the limit of stability in the
/// weakest direction of the workspace, by `palpate zwidth`. The frame: x away from the base, z up.
/// [`crate::servo::recommended`] is softer, so that a hand feels no count.
pub const PHANTOM_PREMIUM: Device<SerialArm, 3> = Device {
    kinematics: SerialArm {
        base_height_m: 0.0,
        first_link_m: 0.209_55,
        second_link_m: 0.169_545,
        workspace_centre_m: vec3(0.209_55, 0.0, -0.169_545),
        end_masses_kg: [
            (0.209_55 * 0.026_22 - 0.035_188_75 * 0.267_84 + 0.104_777_39 * 0.026_146) / 0.209_55,
            (0.052_378_92 * 0.026_22 - 0.051_535_41 * 0.215_42 + 0.031_75 * 0.026_146) / 0.169_545,
        ],
    },
    encoders: [
        Encoder::geared(4_000.0, 13.3, 0.0),
        Encoder::geared(4_000.0, -11.2, FRAC_PI_2),
        Encoder::geared(4_000.0, -11.2, FRAC_PI_2),
    ],
    motors: [
        Motor::current_driven(0.023_4, 5.5, 13.3),
        Motor::current_driven(0.023_4, 5.5, -11.2),
        Motor::current_driven(0.023_4, 5.5, -11.2),
    ],
    feeds: [Feed::Current; 3],
    dry_friction_n_m: [0.01; 3],
    joint_range_rad: [[-1.58, 1.58], [-0.51, 3.74], [-2.17, 2.08]],
    min_margin_m_per_rad: 0.05,
    max_joint_rate_rad_per_s: 25.0,
    max_force_n: 6.5,
    max_stiffness_n_per_m: 660.0,
    max_damping_n_s_per_m: 5.0,
};
