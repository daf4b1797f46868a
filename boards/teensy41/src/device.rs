// The device. `cargo palpate firmware --board teensy41 --device my.toml …` puts your own in its place, from its file.

pub use palpate::device::SerialArm as Mechanism;

/// The device: the preset, with 14-bit angle sensors on the motors' shafts.
pub const DEVICE: palpate::device::Device<Mechanism, 3> = palpate::device::Device {
    encoders: [
        palpate::device::Encoder::geared(16_384.0, -16.0, 0.0),
        palpate::device::Encoder::geared(16_384.0, -12.0, 0.0),
        palpate::device::Encoder::geared(16_384.0, 12.0, 0.0),
    ],
    ..palpate::device::presets::WOODEN_HAPTICS_2016
};

/// The limits of its motors and joints; the board's loop watches the supply.
pub const PROTECTION: palpate::device::Protection<3> = palpate::device::presets::WOODEN_HAPTICS_2016_PROTECTION;

/// The homing reference: the arm held still in its calibration pose (first link upright, second level).
pub const REFERENCE: Option<palpate::device::Reference<3>> =
    Some(palpate::device::Reference::Pose(DEVICE.angles_at_zero()));

/// Which of the board's encoder inputs and motor outputs each joint is on.
pub const WIRING: palpate::commission::Wiring<3> = palpate::commission::Wiring::STRAIGHT;
