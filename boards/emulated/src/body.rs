//! What is felt and how: tables and settings in flash, chosen when the image is built (see `build.rs`).

use palpate::body::{Body, Edge, Face, Spoke, Vertex};
use palpate::servo::{self, Input, Servo, ServoState};
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

pub use settings::{DEVICE, SETTINGS};

/// What the loop keeps between two ticks.
pub type State = ServoState<3, <tables::Surface as servo::Surface>::Witness>;

// What the host counts of each record when it reports a table's bytes.
const _: () = assert!(size_of::<Face>() == 228 && size_of::<Edge>() == 52 && size_of::<Vertex>() == 32);
const _: () = assert!(size_of::<Spoke>() == 16 && size_of::<Body>() == 76);

/// Everything the servo knows, in flash.
pub static SERVO: Servo<'static, tables::Surface, settings::Mechanism, 3> =
    Servo::new(&DEVICE, tables::SURFACE, Controller::SECOND_ORDER, SETTINGS).safety(settings::SAFETY);

/// One tick of the servo: a function of its own, so that what is proved of the image and what is counted is all of it
/// and nothing else.
#[inline(never)]
pub fn tick(state: &mut State, input: Input<3>) {
    planted::fault(state);
    SERVO.tick(state, input);
}
