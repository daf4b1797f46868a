//! What is felt and how: tables and settings in flash, chosen when the image is built (see `build.rs`).

use palpate::patch::SplinePatch;
use palpate::servo::{Input, Servo, ServoState};
use palpate::track::Controller;

use crate::planted;

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

/// One tick of the servo: a function of its own, so that what is proved of the image and what is counted is all of it and
/// nothing else.
#[inline(never)]
pub fn tick(state: &mut ServoState<3>, input: Input<3>) {
    planted::fault(state);
    SERVO.tick(state, input);
}
