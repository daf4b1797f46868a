//! The servo of a device that may have been calibrated: in RAM, made at each start.

use palpate::commission::Wiring;
use palpate::device::Device;
use palpate::servo::Servo;
use palpate_bench::Felt;
use palpate_bench::store::Found;
use static_cell::StaticCell;

use crate::body::{Chosen, Felt as Surface, Loop, Mechanism, SERVO};

static DEVICE: StaticCell<Device<Mechanism, 3>> = StaticCell::new();

/// The servo.
pub struct Measured {
    servo: Loop<Chosen>,
    wiring: Wiring<3>,
    is_miscalibrated: bool,
}

impl Measured {
    /// On the device that was found; `None` the second time.
    pub fn try_new(found: Found<Mechanism, 3>) -> Option<Self> {
        let device: &'static Device<Mechanism, 3> = DEVICE.try_init(found.device)?;
        let Found { wiring, is_miscalibrated, .. } = found;
        Some(Self { servo: SERVO.calibrated(device), wiring, is_miscalibrated })
    }
}

impl Felt<3> for Measured {
    type Surface = Surface;
    type Mechanism = Mechanism;
    type Guard = Chosen;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Surface, Mechanism, 3, Chosen> {
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
