// Written by `palpate device` from haply-2diy-v3: the numbers are yours to change.

pub use palpate::device::FiveBar as Mechanism;

/// The device.
pub const DEVICE: palpate::device::Device<Mechanism, 2> = palpate::device::Device {
    kinematics: palpate::device::FiveBar { second_pivot_m: 0.038, cranks_m: [0.07, 0.07], rods_m: [0.09, 0.09], side: 1.0, tool_m: 0.09, workspace_centre_m: palpate::math::vec2(0.019, 0.1) },
    encoders: [palpate::device::Encoder { radians_per_count: 0.001287538, angle_at_zero_rad: 2.932797 }, palpate::device::Encoder { radians_per_count: 0.001287538, angle_at_zero_rad: 0.21008329 }],
    motors: [palpate::device::Motor { torque_at_full_n_m: 0.123 }, palpate::device::Motor { torque_at_full_n_m: 0.123 }],
    feeds: [palpate::device::drive::Feed::Voltage(palpate::device::drive::VoltageFeed { supply_v: 12.0, full_fraction: 1.0, resistance_ohm: 4.0, torque_constant_n_m_per_a: 0.017206557, current_at_full_a: 3.0, ratio: 2.3828125, back_emf_fraction: 0.8 }), palpate::device::drive::Feed::Voltage(palpate::device::drive::VoltageFeed { supply_v: 12.0, full_fraction: 1.0, resistance_ohm: 4.0, torque_constant_n_m_per_a: 0.017206557, current_at_full_a: 3.0, ratio: 2.3828125, back_emf_fraction: 0.8 })],
    dry_friction_n_m: [0.002, 0.002],
    joint_range_rad: [[0.8, 3.3], [-0.2, 2.3]],
    min_margin_m_per_rad: 0.015,
    max_joint_rate_rad_per_s: 40.0,
    max_force_n: 1.3,
    max_stiffness_n_per_m: 300.0,
    max_damping_n_s_per_m: 1.0,
};
const _: () = {
    if let Err(error) = DEVICE.check() {
        panic!("{}", error.message());
    }
    if let Err(error) = DEVICE.kinematics.check() {
        panic!("{}", error.message());
    }
};
