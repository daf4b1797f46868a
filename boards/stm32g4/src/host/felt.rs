//! The servo of a board that a host may order about, on the device as commissioning found it: in RAM, made at each
//! start.

#[path = "../../../hosted.rs"]
#[allow(dead_code)]
mod hosted;

use palpate::commission::Wiring;
use palpate::device::{Device, SerialArm, ZeroOf};
use palpate::servo::{Guarded, Servo};
use palpate_bench::Felt;
use palpate_shelf::Found;
use static_cell::StaticCell;

use self::hosted::{Surface, built as servo};
use crate::body::DEVICE;

/// What the loop feels.
pub struct This {
    servo: Servo<'static, Surface, SerialArm, 3, Guarded<3>>,
    wiring: Wiring<3>,
    is_miscalibrated: bool,
}

/// What the zeroes of a calibration have to be of.
pub fn homed_by() -> Option<ZeroOf> {
    servo().zero_of()
}

static FOUND: StaticCell<Device<SerialArm, 3>> = StaticCell::new();

/// On the device that was found in flash; as it was built, where nothing is. Once.
///
/// # Panics
/// The second time.
pub fn on(found: Option<Found<SerialArm, 3>>) -> This {
    let built = Found { device: DEVICE, wiring: Wiring::STRAIGHT, is_miscalibrated: false };
    let Found { device, wiring, is_miscalibrated } = found.unwrap_or(built);
    This { servo: servo().calibrated(FOUND.init(device)), wiring, is_miscalibrated }
}

impl Felt<3> for This {
    type Surface = Surface;
    type Mechanism = SerialArm;
    type Guard = Guarded<3>;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Surface, SerialArm, 3, Guarded<3>> {
        &self.servo
    }

    #[inline(always)]
    fn wiring(&self) -> Wiring<3> {
        self.wiring
    }

    #[inline(always)]
    fn is_miscalibrated(&self) -> bool {
        self.is_miscalibrated
    }
}
