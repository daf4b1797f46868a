//! Haply's planar pantographs.

use crate::device::drive::{Feed, VoltageFeed};
use crate::device::{Device, Encoder, FiveBar, Motor};
use crate::math::vec2;

const DEGREE: f32 = core::f32::consts::PI / 180.0;

/// Haply 2diy, third version: a five-bar that lies on the table.
///
/// Cranks 70 mm, rods 90 mm, pivots 38 mm apart; 4,880 counts a turn of the joint, so 90 µm at a crank's end; folded
/// back against its stops the cranks stand at 168° and 12°, which is zero counts. Source: the `Pantograph` class and
/// set-up of Haply's course material. 0.123 N·m a joint, as that software scales it. Assumed: the drive (2,048 counts a
/// turn of the motor make the ratio; 4 Ω, 3 A on 12 V), directions, maximum stiffness and damping. 1.3 N is the force
/// that the motors reach in every direction at the workspace centre, which is ours. The frame: x to the right, y away
/// from the pivots.
pub const HAPLY_2DIY_V3: Device<FiveBar, 2> = Device {
    kinematics: FiveBar {
        second_pivot_m: 0.038,
        cranks_m: [0.07; 2],
        rods_m: [0.09; 2],
        side: 1.0,
        tool_m: 0.09,
        workspace_centre_m: vec2(0.019, 0.1),
    },
    encoders: [Encoder::geared(4_880.0, 1.0, 168.0 * DEGREE), Encoder::geared(4_880.0, 1.0, 12.0 * DEGREE)],
    motors: [Motor { torque_at_full_n_m: 0.123 }; 2],
    feeds: [Feed::Voltage(VoltageFeed {
        supply_v: 12.0,
        full_fraction: 1.0,
        resistance_ohm: 4.0,
        torque_constant_n_m_per_a: 0.123 / 3.0 / (4_880.0 / 2_048.0),
        current_at_full_a: 3.0,
        ratio: 4_880.0 / 2_048.0,
        back_emf_fraction: 0.8,
    }); 2],
    dry_friction_n_m: [2e-3; 2],
    joint_range_rad: [[0.8, 3.3], [-0.2, 2.3]],
    min_margin_m_per_rad: 0.015,
    max_joint_rate_rad_per_s: 40.0,
    max_force_n: 1.3,
    max_stiffness_n_per_m: 300.0,
    max_damping_n_s_per_m: 1.0,
};

/// Haply development kit, first version: a smaller five-bar with geared encoders.
///
/// Cranks 50 mm, rods 70 mm, pivots 20 mm apart; 13,824 counts a turn, so 23 µm at a crank's end; zero counts with the
/// cranks at 180° and 0°. Source: HaplyHaptics/Haply-API, `Pantograph` and `add_encoder`. 0.123 N·m a joint. Assumed as
/// for [`HAPLY_2DIY_V3`], with 1,024 counts a turn of the motor, 12 Ω and 1 A.
pub const HAPLY_KIT_V1: Device<FiveBar, 2> = Device {
    kinematics: FiveBar {
        second_pivot_m: 0.02,
        cranks_m: [0.05; 2],
        rods_m: [0.07; 2],
        side: 1.0,
        tool_m: 0.07,
        workspace_centre_m: vec2(0.01, 0.075),
    },
    encoders: [Encoder::geared(13_824.0, 1.0, 180.0 * DEGREE), Encoder::geared(13_824.0, 1.0, 0.0)],
    motors: [Motor { torque_at_full_n_m: 0.123 }; 2],
    feeds: [Feed::Voltage(VoltageFeed {
        supply_v: 12.0,
        full_fraction: 1.0,
        resistance_ohm: 12.0,
        torque_constant_n_m_per_a: 0.123 / 13.5,
        current_at_full_a: 1.0,
        ratio: 13.5,
        back_emf_fraction: 0.8,
    }); 2],
    dry_friction_n_m: [2e-3; 2],
    joint_range_rad: [[0.8, 3.4], [-0.3, 2.3]],
    min_margin_m_per_rad: 0.012,
    max_joint_rate_rad_per_s: 50.0,
    max_force_n: 2.0,
    max_stiffness_n_per_m: 300.0,
    max_damping_n_s_per_m: 1.0,
};
