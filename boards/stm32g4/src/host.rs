//! Flash for a body from a host: the second bank, which can be written while the program is read from the first. There
//! is no RAM to spare for two more.

mod damage;
mod flash;

use palpate::wire::Upload;
use palpate_bench::{Idle, Uploads as _};
use palpate_cortex::HandOver;
use palpate_shelf::{Keeping, Kept, Region};
use stm32g4xx_hal::stm32::FLASH;

use self::flash::{BANK_BYTES, Bank2, START};

/// Faces and edges of some 60 patches: more RAM for them would be less for the code of the tick.
const FACES: usize = 64;
const EDGES: usize = 160;

/// Where the body lies that is kept.
pub type Shelf = Kept<FACES, EDGES>;

/// For the slot of the scene.
// SAFETY: the chip's second bank, which nothing of this program lies in (`regions/hosted.x`) and only `Bank2` writes.
pub static SHELF: Shelf = Kept::new(unsafe { Region::new(START as *const u32, BANK_BYTES) });

type End = Keeping<Bank2, FACES, EDGES>;

/// Main's end on its way to where it is used.
static FOUND: HandOver<End> = HandOver::new();

/// Looks for a body that was kept: before the loop is made, which feels it from the first tick on. A chip that was set
/// to one bank keeps none. Words that the power went in the middle of are no body, and are erased.
pub fn find(flash: FLASH) {
    let Some(bank) = Bank2::try_new(flash) else { return };
    let (found, is_damaged) = damage::watched(|| SHELF.main(bank, &mut || ()));
    // What was found wrong is said by what is kept: nothing.
    let Some((end, _)) = found else { return };
    if is_damaged && end.put(&Upload::Begin { bytes: 0 }, &mut || ()).is_err() {
        // What cannot be erased is not looked at again.
        return;
    }
    FOUND.give(end);
}

/// Main's end of it.
pub struct Ends(Option<End>);

/// Main's end, once.
pub fn ends() -> Ends {
    Ends(FOUND.take())
}

impl Ends {
    /// What the host is told that there is.
    pub fn offer<'a>(&'a self, idle: Idle<'a>) -> Idle<'a> {
        match &self.0 {
            Some(flash) => idle.keeping(flash),
            None => idle,
        }
    }
}
