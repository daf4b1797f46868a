//! Flash for a body from a host, and for what commissioning found: the second bank, which can be written while the
//! program is read from the first. There is no RAM to spare for two more bodies.

#[cfg(feature = "accept")]
compile_error!("an image that is accepted takes no host's orders: one feature or the other");

mod damage;
mod flash;

use palpate::device::{SerialArm, ZeroOf};
use palpate::wire::Upload;
use palpate_bench::{Idle, Uploads as _};
use palpate_cortex::HandOver;
use palpate_shelf::{Found, Keeping, Kept, KeptCalibration, Region};
use stm32g4xx_hal::stm32::FLASH;

use self::flash::{BODY_BYTES, Bank2, START};
use crate::body::DEVICE;

/// Faces and edges of some 60 patches: more RAM for them would be less for the code of the tick.
const FACES: usize = 64;
const EDGES: usize = 160;

/// Where the body lies that is kept.
pub type Shelf = Kept<FACES, EDGES>;

/// For the slot of the scene.
// SAFETY: of the chip's second bank, which nothing of this program lies in (`regions/hosted.x`) and only `Bank2`
// writes.
pub static SHELF: Shelf = Kept::new(unsafe { Region::new(START as *const u32, BODY_BYTES) });

type End = Keeping<Bank2, FACES, EDGES>;

type Calibration = KeptCalibration<Bank2, SerialArm, 3>;

/// Main's ends on their way to where they are used.
static FOUND: HandOver<End> = HandOver::new();
static CALIBRATION: HandOver<Calibration> = HandOver::new();

/// Looks for a body that was kept, and for a calibration: before the loop is made, which is made with the one and feels
/// the other from the first tick on. A chip that was set to one bank keeps none. Words that the power went in the
/// middle of are no body, and are erased; and no calibration, which is said.
pub fn find(flash: FLASH, homed_by: Option<ZeroOf>) -> Option<Found<SerialArm, 3>> {
    let [bodies, calibration] = Bank2::try_new(flash)?;
    let ((kept, found), is_damaged) = damage::watched(|| Calibration::find(calibration, &DEVICE, homed_by));
    let (kept, found) = if is_damaged { kept.damaged() } else { (kept, found) };
    CALIBRATION.give(kept);
    let (end, is_damaged) = damage::watched(|| SHELF.main(bodies, &mut || ()));
    // What was found wrong is said by what is kept: nothing. What cannot be erased is not looked at again.
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

impl Ends {
    /// What the host is told that there is.
    pub fn offer<'a>(&'a self, mut idle: Idle<'a>) -> Idle<'a> {
        if let Some(flash) = &self.0 {
            idle = idle.keeping(flash);
        }
        match &self.1 {
            Some(flash) => idle.calibrating(flash),
            None => idle,
        }
    }
}
