//! The servo of a board that feels by itself, from its device, its settings and the body that the build chose.

use palpate::device::{Homing, Reference, SerialArm};
use palpate::servo::{Guarded, Servo};
use palpate::track::Controller;
use palpate_bench::Felt;

use crate::body::{DEVICE, PROTECTION, SETTINGS};

/// The body: `cargo palpate firmware --board BOARD --body MODEL build --release` puts another one here.
mod tables {
    include!(env!("PALPATE_BODY_FILE"));
}

/// Where the counts are zero is where the arm is held still for a tenth of a second while the button is down, in its
/// calibration pose (first link upright, second level); ten seconds of a shaking hand are refused.
const HOMING: Homing<3> = Homing::new(
    DEVICE.encoders,
    Reference::Pose(DEVICE.angles_at_zero()),
    (0.1 * SETTINGS.rate_hz) as u32,
    4,
    (10.0 * SETTINGS.rate_hz) as u32,
)
.when_asked();

/// Everything the servo knows, with its device's protection. No host watches: the device runs by itself. The table is
/// checked at boot and over and over.
static SERVO: Servo<'static, tables::Surface, SerialArm, 3, Guarded<3>> =
    Servo::new(&DEVICE, tables::SURFACE, Controller::SECOND_ORDER, SETTINGS).protect(PROTECTION).homing(HOMING);

/// What the loop feels.
pub struct This;

impl Felt<3> for This {
    type Surface = tables::Surface;
    type Mechanism = SerialArm;
    type Guard = Guarded<3>;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, tables::Surface, SerialArm, 3, Guarded<3>> {
        &SERVO
    }
}
