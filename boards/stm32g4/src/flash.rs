//! The second bank of the chip's flash, as the reference manual (RM0440, 3.3) wants it written: while the program, in
//! the first, goes on.

use core::ptr;
use core::sync::atomic::{AtomicBool, Ordering};
use cortex_m::interrupt;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use palpate_bench::cortex::bearing_nmi;
use stm32g4xx_hal::stm32::FLASH;
use stm32g4xx_hal::stm32::flash::RegisterBlock;

/// The start of the second of two banks.
pub const START: usize = 0x0804_0000;
/// Its bytes for a body, or for a knob's feel: all but the last page, which is for a calibration.
pub const BODY_BYTES: usize = 256 * 1024 - PAGE;

const PAGE: usize = 2_048;
const DOUBLE_WORD: usize = 8;

/// The keys that open the control register.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// Every flag of the status register that says what became of the last operation; written, it is cleared.
const FLAGS: u32 = 0xC3FB;
/// Those that say that it failed: all but the first, the end of an operation.
const ERRORS: u32 = FLAGS & !1;
/// So often the status is looked at: a page takes 25 ms at most, 4.2 million cycles, and a look some ten.
const LOOKS: u32 = 1_000_000;

/// Pages of the bank, in a row. Main has them all.
pub struct Bank2 {
    first: usize,
    bytes: usize,
}

/// Flash did not take it, or what was asked of it makes no sense.
#[derive(Clone, Copy, Debug)]
pub struct Refused(NorFlashErrorKind);

impl NorFlashError for Refused {
    fn kind(&self) -> NorFlashErrorKind {
        self.0
    }
}

const OTHER: Refused = Refused(NorFlashErrorKind::Other);

impl Bank2 {
    /// The bank's part for a body or a feel and that for a calibration, if the chip's option bytes have two banks and
    /// start the program in the first: else it would be the program's own bank.
    pub fn try_new(flash: FLASH) -> Option<[Self; 2]> {
        let options = flash.optr().read();
        let is_ours = options.dbank().is_dual_bank_mode() && options.bfb2().bit_is_clear();
        is_ours.then_some([Self { first: 0, bytes: BODY_BYTES }, Self { first: BODY_BYTES, bytes: PAGE }])
    }

    fn registers() -> &'static RegisterBlock {
        // SAFETY: the parts are made of the only owner there is, and used by main alone, one after the other.
        unsafe { &*FLASH::ptr() }
    }

    /// Waits until nothing is under way.
    fn wait() -> Result<(), Refused> {
        let is_done = (0..LOOKS).any(|_| Self::registers().sr().read().bsy().bit_is_clear());
        if is_done { Ok(()) } else { Err(OTHER) }
    }

    /// The outcome of an operation.
    fn outcome() -> Result<(), Refused> {
        Self::wait()?;
        if Self::registers().sr().read().bits() & ERRORS == 0 { Ok(()) } else { Err(OTHER) }
    }

    /// Does something with the control register open, and the data cache empty afterwards.
    fn with(work: impl FnOnce() -> Result<(), Refused>) -> Result<(), Refused> {
        Self::wait()?;
        // Off meanwhile: what it fetches while flash is written may be wrong. The tick waits for flash, with its motors
        // off.
        Self::registers().acr().modify(|_, w| w.dcen().clear_bit());
        // SAFETY: ones clear flags, the keys are the manual's.
        unsafe {
            Self::registers().sr().write(|w| w.bits(FLAGS));
            for key in KEYS {
                Self::registers().keyr().write(|w| w.bits(key));
            }
        }
        let done = work();
        Self::registers().cr().modify(|_, w| w.pg().clear_bit().per().clear_bit().lock().set_bit());
        // It is emptied only while it is off.
        Self::registers().acr().modify(|_, w| w.dcrst().set_bit());
        Self::registers().acr().modify(|_, w| w.dcrst().clear_bit());
        Self::registers().acr().modify(|_, w| w.dcen().set_bit());
        done
    }

    fn erase_page(page: u8) -> Result<(), Refused> {
        Self::with(|| {
            // SAFETY: a page of 128.
            Self::registers().cr().modify(|_, w| unsafe { w.per().set_bit().bker().set_bit().pnb().bits(page) });
            Self::registers().cr().modify(|_, w| w.strt().set_bit());
            Self::outcome()
        })
    }

    fn write_all(&self, offset: usize, bytes: &[u8]) -> Result<(), Refused> {
        Self::with(|| {
            Self::registers().cr().modify(|_, w| w.pg().set_bit());
            for (number, [low, high]) in bytes.as_chunks::<4>().0.as_chunks::<2>().0.iter().enumerate() {
                let place = (START + self.first + offset + number * DOUBLE_WORD) as *mut u32;
                // Both words of a double word, one right after the other.
                interrupt::free(|_| {
                    // SAFETY: within the second bank, where nothing else lies, at a multiple of eight.
                    unsafe {
                        ptr::write_volatile(place, u32::from_le_bytes(*low));
                        ptr::write_volatile(place.add(1), u32::from_le_bytes(*high));
                    }
                });
                Self::outcome()?;
            }
            Ok(())
        })
    }
}

/// Whether a range starts and ends on a boundary, within the bank.
fn check(offset: usize, bytes: usize, size: usize, capacity: usize) -> Result<(), Refused> {
    if !offset.is_multiple_of(size) || !bytes.is_multiple_of(size) {
        return Err(Refused(NorFlashErrorKind::NotAligned));
    }
    match offset.checked_add(bytes) {
        Some(end) if end <= capacity => Ok(()),
        _ => Err(Refused(NorFlashErrorKind::OutOfBounds)),
    }
}

impl ErrorType for Bank2 {
    type Error = Refused;
}

impl ReadNorFlash for Bank2 {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Refused> {
        check(offset as usize, bytes.len(), Self::READ_SIZE, self.bytes)?;
        for (number, byte) in bytes.iter_mut().enumerate() {
            // SAFETY: within the second bank.
            *byte = unsafe { ptr::read_volatile((START + self.first + offset as usize + number) as *const u8) };
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes
    }
}

impl NorFlash for Bank2 {
    const WRITE_SIZE: usize = DOUBLE_WORD;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Refused> {
        let [from, to] = [from, to].map(|offset| offset as usize);
        check(from, to.saturating_sub(from), PAGE, self.bytes)?;
        // The cast is right: there are 128.
        ((self.first + from) / PAGE..(self.first + to) / PAGE).try_for_each(|page| Self::erase_page(page as u8))
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Refused> {
        check(offset as usize, bytes.len(), DOUBLE_WORD, self.bytes)?;
        self.write_all(offset as usize, bytes)
    }
}

/// Whether a word of the second bank could not be read: the power went while it was written or erased.
static DAMAGED: AtomicBool = AtomicBool::new(false);

/// Does something in which such words may be read, and says whether any was. For main, before there are ticks.
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
