//! Device, settings and body of this board: the file to change first. The build chooses the body (`--body`).

use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Device, Protection, SerialArm};
use palpate::math::vec3;
use palpate::servo::Settings;

/// The device. One of your own is a constant like this one; start from the preset that is nearest.
pub static DEVICE: Device<SerialArm, 3> = WOODEN_HAPTICS_2016;

/// The limits of its motors and joints; the board's loop watches the supply.
pub const PROTECTION: Protection<3> = WOODEN_HAPTICS_2016_PROTECTION;

/// 4 kHz and 600 N/m are well inside what the device takes.
pub const SETTINGS: Settings = Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.2,
    body_origin_m: vec3(-0.05, -0.05, -0.06),
};

/// The body: `cargo palpate firmware --board stm32g4 --body MODEL build --release` puts another one here.
pub mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

#[cfg(not(feature = "host"))]
palpate_bench::arm!(tables::Surface = tables::SURFACE, DEVICE, SETTINGS, PROTECTION);
