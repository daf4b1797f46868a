//! What is felt, on which device, and how: the file to change first.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Device, SerialArm};
use palpate::math::vec3;
use palpate::servo::{Servo, Settings};
use palpate::track::Controller;

/// The body: `cargo palpate bake MODEL.toml --out body.rs`.
#[path = "../../bodies/table1c.rs"]
mod table;

/// The device. One of your own is a constant like this one; start from the preset that is nearest.
static DEVICE: Device<SerialArm, 3> = WOODEN_HAPTICS_2016;

/// 4 kHz and 600 N/m are well inside what the device takes.
pub const SETTINGS: Settings = Settings {
    rate: 4_000.0,
    stiffness: 600.0,
    damping: 2.0,
    max_force: 5.0,
    velocity_corner: 200.0,
    soft_start: 0.2,
    body_origin: vec3(-0.05, -0.05, -0.06),
};

/// Everything the servo knows. No host watches: the device runs by itself. The table is checked at boot and over and
/// over.
pub static SERVO: Servo<'static, table::Surface, SerialArm, 3> =
    Servo::new(&DEVICE, table::SURFACE, Controller::SECOND_ORDER, SETTINGS);
