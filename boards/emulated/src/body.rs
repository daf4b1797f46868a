//! What is felt and how: tables and settings in flash, chosen when the image is built (see `build.rs`).

use palpate::patch::SplinePatch;
use palpate::servo::Servo;
use palpate::track::Controller;

/// The baked body.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// The settings of the loop, and its device.
mod settings {
    include!(env!("PALPATE_SETTINGS_FILE"));
}

pub use settings::{SAFETY, SETTINGS};
pub use tables::PATCHES as BODY;

/// Everything the servo knows, in flash.
pub static SERVO: Servo<'static, SplinePatch, settings::Mechanism, 3> =
    Servo::new(&settings::DEVICE, &tables::PATCHES[0], Controller::CERTIFIED, SETTINGS).safety(SAFETY);
