// The device. `cargo palpate firmware --board pico2 --device my.toml …` puts your own in its place, from its file.

pub use palpate::device::SerialArm as Mechanism;

/// A motor's bridge: Maxon RE30 for 24 V, 0.611 Ω by its data sheet and 0.1 Ω for the bridge, which is ours to guess.
const fn feed(ratio: f32) -> palpate::device::drive::Feed {
    palpate::device::drive::Feed::Voltage(palpate::device::drive::VoltageFeed {
        supply_v: 24.0,
        full_fraction: 1.0,
        resistance_ohm: 0.711,
        torque_constant_n_m_per_a: 0.0259,
        current_at_full_a: 3.0,
        ratio,
        back_emf_fraction: 0.8,
    })
}

/// The device: the preset, with 14-bit angle sensors on the motors' shafts and bridges that give a voltage.
pub const DEVICE: palpate::device::Device<Mechanism, 3> = palpate::device::Device {
    encoders: [
        palpate::device::Encoder::geared(16_384.0, -16.0, 0.0),
        palpate::device::Encoder::geared(16_384.0, -12.0, 0.0),
        palpate::device::Encoder::geared(16_384.0, 12.0, 0.0),
    ],
    feeds: [feed(16.0), feed(-12.0), feed(12.0)],
    ..palpate::device::presets::WOODEN_HAPTICS_2016
};

/// The limits of its motors and joints; the board's loop watches the supply.
pub const PROTECTION: palpate::device::Protection<3> = palpate::device::presets::WOODEN_HAPTICS_2016_PROTECTION;

/// The homing reference: the arm held still in its calibration pose (first link upright, second level).
pub const REFERENCE: Option<palpate::device::Reference<3>> =
    Some(palpate::device::Reference::Pose(DEVICE.angles_at_zero()));

/// Which of the board's encoder inputs and motor outputs each joint is on.
pub const WIRING: palpate::commission::Wiring<3> = palpate::commission::Wiring::STRAIGHT;
