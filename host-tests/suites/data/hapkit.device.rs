// Written by `palpate device` from hapkit: the numbers are yours to change.

pub use palpate::device::Paddle as Mechanism;

/// The device.
pub const DEVICE: palpate::device::Device<Mechanism, 1> = palpate::device::Device {
    kinematics: palpate::device::Paddle { handle_m: 0.065659, mass_moment_kg_m: 0.0 },
    encoders: [palpate::device::Encoder { radians_per_count: 0.00024020499, angle_at_zero_rad: 0.00012010249 }],
    motors: [palpate::device::Motor { torque_at_full_n_m: 0.52363634 }],
    feeds: [palpate::device::drive::Feed::Voltage(palpate::device::drive::VoltageFeed { supply_v: 12.0, full_fraction: 1.0, resistance_ohm: 10.0, torque_constant_n_m_per_a: 0.025, current_at_full_a: 1.2, ratio: 17.454544, back_emf_fraction: 0.8 })],
    dry_friction_n_m: [0.002],
    joint_range_rad: [[-0.8, 0.8]],
    min_margin_m_per_rad: 0.05,
    max_joint_rate_rad_per_s: 35.0,
    max_force_n: 7.9,
    max_stiffness_n_per_m: 500.0,
    max_damping_n_s_per_m: 2.0,
};
const _: () = {
    if let Err(error) = DEVICE.check() {
        panic!("{}", error.message());
    }
    if let Err(error) = DEVICE.kinematics.check(DEVICE.full_torques_n_m()) {
        panic!("{}", error.message());
    }
};
