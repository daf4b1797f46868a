//! Flash for a body from a host, and for what commissioning found: the second bank, which can be written while the
//! program is read from the first. There is no RAM to spare for two more bodies.

#[cfg(feature = "accept")]
compile_error!("an image that is accepted takes no host's orders: one feature or the other");

use palpate::body::{Body, TickLimit};
use palpate::commission::{Gains, Wiring};
use palpate::device::Device;
use palpate::scene::Slot;
use palpate::wire::Upload;
use palpate_bench::cortex::HandOver;
use palpate_bench::store::{Built, Found, Keeping, Kept, KeptCalibration, Region};
use palpate_bench::{ArmServo, Felt, Idle, Offers, OneSlot, Uploads as _, arm_servo, one_slot};
use palpate_stm32g4::flash::{BODY_BYTES, Bank2, START, watched};
use static_cell::StaticCell;
use stm32g4xx_hal::stm32::FLASH;

use crate::body::own::{DEVICE, Mechanism, PROTECTION, REFERENCE, WIRING};
use crate::body::{EFFORT, SAFETY, SETTINGS, tables};

/// Faces and edges of some 60 patches: more RAM for them would be less for the code of the tick.
const FACES: usize = 64;
const EDGES: usize = 160;

/// Where the body lies that is kept.
type Store = Kept<FACES, EDGES>;

// SAFETY: of the chip's second bank, which nothing of this program lies in (`regions/hosted.x`) and only `Bank2`
// writes.
static STORE: Store = Kept::with_effort(unsafe { Region::new(START as *const u32, BODY_BYTES) }, EFFORT);

/// With code for every kind of patch, as a host's body may have any. One patch alone is no body: choose a model of one.
#[allow(long_running_const_eval)]
static BUILT_IN: Body = tables::BODY.with_effort(EFFORT).fitted(TickLimit::BENCH);
static SLOT: Slot<Store> = Slot::exchangeable(&BUILT_IN, &STORE);
static SCENE: OneSlot<Store> = one_slot(&SLOT, &DEVICE, &SETTINGS);

/// A configuration that is refused does not compile.
const SERVO: ArmServo<OneSlot<Store>, Mechanism> = arm_servo(&DEVICE, &SCENE, SETTINGS, PROTECTION, REFERENCE, SAFETY);

/// The servo on the device as commissioning found it: in RAM, made at each start.
pub struct This {
    servo: ArmServo<OneSlot<Store>, Mechanism>,
    wiring: Wiring<3>,
    is_miscalibrated: bool,
}

impl Felt<3> for This {
    type Surface = OneSlot<Store>;
    type Mechanism = Mechanism;
    type Guard = palpate::servo::Guarded<3>;

    #[inline(always)]
    fn servo(&self) -> &ArmServo<OneSlot<Store>, Mechanism> {
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

type End = Keeping<Bank2, FACES, EDGES>;

type Calibration = KeptCalibration<Bank2, Mechanism, 3>;

/// Main's ends on their way to where they are used.
static FOUND: HandOver<End> = HandOver::new();
static CALIBRATION: HandOver<Calibration> = HandOver::new();

/// Looks for a body that was kept, and for a calibration: before the loop is made, which is made with the one and feels
/// the other from the first tick on. Without either, the device is as it was built. A chip that was set to one bank
/// keeps none. Words that the power went in the middle of are no body, and are erased; and no calibration, which is
/// reported.
///
/// # Panics
/// The second time.
pub fn find(flash: FLASH) -> This {
    static FOUND_DEVICE: StaticCell<Device<Mechanism, 3>> = StaticCell::new();

    let built = Found { device: DEVICE, wiring: WIRING, is_miscalibrated: false };
    let Found { device, wiring, is_miscalibrated } = kept(flash).unwrap_or(built);
    This { servo: SERVO.calibrated(FOUND_DEVICE.init(device)), wiring, is_miscalibrated }
}

fn kept(flash: FLASH) -> Option<Found<Mechanism, 3>> {
    let [bodies, calibration] = Bank2::try_new(flash)?;
    let built = Built { device: &DEVICE, wiring: WIRING, homed_by: SERVO.zero_of(), gains: Gains::of(&DEVICE) };
    let ((kept, found), is_damaged) = watched(|| Calibration::find(calibration, built));
    let (kept, found) = if is_damaged { kept.damaged() } else { (kept, found) };
    CALIBRATION.give(kept);
    let (end, is_damaged) = watched(|| STORE.main(bodies, &mut || ()));
    // A damaged body is reported as none. One that cannot be erased is not looked at again.
    if let Some((end, _)) = end
        && (!is_damaged || end.put(&Upload::Begin { bytes: 0 }, &mut || ()).is_ok())
    {
        FOUND.give(end);
    }
    Some(found)
}

/// Main's ends of both.
pub struct Ends(Option<End>, Option<Calibration>);

/// Main's ends, once.
pub fn ends() -> Ends {
    Ends(FOUND.take(), CALIBRATION.take())
}

impl Offers for Ends {
    fn offer<'a>(&'a self, mut idle: Idle<'a>) -> Idle<'a> {
        if let Some(flash) = &self.0 {
            idle = idle.keeping(flash);
        }
        match &self.1 {
            Some(flash) => idle.calibrating(flash),
            None => idle,
        }
    }
}
