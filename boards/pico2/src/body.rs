//! What is felt, on which device, and how: the file to change first.

use palpate::device::drive::{Feed, VoltageFeed};
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Device, Encoder, Homing, Reference, SerialArm};
use palpate::math::vec3;
use palpate::servo::{Servo, Settings};
use palpate::track::Controller;
use palpate_bench::Felt;

/// The body: `cargo palpate firmware --board pico2 --body MODEL build --release` puts another one here.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// A motor's bridge: Maxon RE30 for 24 V, 0.611 Ω by its data sheet and 0.1 Ω for the bridge, which is ours to guess.
const fn feed(ratio: f32) -> Feed {
    Feed::Voltage(VoltageFeed {
        supply: 24.0,
        resistance: 0.711,
        torque_constant: 0.0259,
        current_at_full: 3.0,
        ratio,
        back_emf_share: 0.8,
    })
}

/// The device: the preset, with 14-bit angle sensors on the motors' shafts and bridges that give a voltage.
pub static DEVICE: Device<SerialArm, 3> = Device {
    encoders: [
        Encoder::geared(16_384.0, -16.0, 0.0),
        Encoder::geared(16_384.0, -12.0, 0.0),
        Encoder::geared(16_384.0, 12.0, 0.0),
    ],
    feeds: [feed(16.0), feed(-12.0), feed(12.0)],
    ..WOODEN_HAPTICS_2016
};

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

/// Where the counts are zero is where the arm is held still for a tenth of a second while the button is down, in its
/// calibration pose (first link upright, second level); ten seconds of a shaking hand are refused.
const HOMING: Homing<3> =
    Homing::new(DEVICE.encoders, Reference::Pose(WOODEN_HAPTICS_2016.angles_at_zero()), 400, 4, 40_000).when_asked();

/// Everything the servo knows. No host watches: the device runs by itself. The table is checked at boot and over and
/// over.
static SERVO: Servo<'static, tables::Surface, SerialArm, 3> =
    Servo::new(&DEVICE, tables::SURFACE, Controller::SECOND_ORDER, SETTINGS).homing(HOMING);

/// What the loop feels.
pub struct This;

impl Felt<3> for This {
    type Surface = tables::Surface;
    type Mechanism = SerialArm;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, tables::Surface, SerialArm, 3> {
        &SERVO
    }
}
