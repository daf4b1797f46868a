//! Words of the second bank that cannot be read: the power went while they were written or erased.

use core::sync::atomic::{AtomicBool, Ordering};
use palpate_cortex::bearing_nmi;
use stm32g4xx_hal::stm32::FLASH;

/// Whether such a word was met.
static DAMAGED: AtomicBool = AtomicBool::new(false);

/// Does something in which such words may be read, and says whether any was.
pub fn watched<T>(work: impl FnOnce() -> T) -> (T, bool) {
    let done = bearing_nmi(is_damage, work);
    (done, DAMAGED.swap(false, Ordering::SeqCst))
}

/// The chip tells of a word whose checksum is beyond mending by an NMI (RM0440, 3.3.4). Any other one is a stop.
fn is_damage() -> bool {
    // SAFETY: reads a register, and clears a flag by writing it as one.
    let flash = unsafe { &*FLASH::ptr() };
    let eccr = flash.eccr().read();
    let is_word = eccr.eccd().bit_is_set() && eccr.bk_ecc().bit_is_set();
    if is_word {
        DAMAGED.store(true, Ordering::SeqCst);
        flash.eccr().modify(|_, w| w.eccd().set_bit());
    }
    is_word
}
