//! Flash for one body, which stays without power.

use super::bank::Bank;
use super::incoming::{Incoming, refusal};
use crate::Uploads;
use core::cell::{Cell, RefCell};
use core::hint::black_box;
use embedded_storage::nor_flash::NorFlash;
use palpate::body::{Body, Effort, FileError};
use palpate::scene::BodyStore;
use palpate::wire::{CHUNK, Upload, UploadError};
use portable_atomic::{AtomicBool, Ordering};

/// A part of a chip's flash, or of what stands in for it, that is read where it lies.
#[derive(Clone, Copy, Debug)]
pub struct Region {
    start: *const u32,
    bytes: usize,
}

// SAFETY: it is looked at only by main, which alone has it written, or through a bank that is not main's.
unsafe impl Sync for Region {}

impl Region {
    /// `bytes` from `start` on.
    ///
    /// # Safety
    /// They are there to be read for as long as the program runs, whenever the [`NorFlash`] that writes them is not at
    /// work, and only a [`Keeping`] of this region has it at work.
    pub const unsafe fn new(start: *const u32, bytes: usize) -> Self {
        Self { start, bytes }
    }

    /// The first of its bytes, as they are now; fewer, if it is no longer than that.
    ///
    /// # Safety
    /// Nobody writes them while the slice lives.
    unsafe fn first(&self, bytes: usize) -> &'static [u8] {
        // Written behind the compiler's back since it was read last.
        let start = black_box(self.start);
        // SAFETY: as `new` and this function demand; any bytes are bytes.
        unsafe { core::slice::from_raw_parts(start.cast(), bytes.min(self.bytes)) }
    }
}

/// A bank whose file lies in flash, for a body of at most `FACES` and `EDGES`. A `static`.
pub struct Kept<const FACES: usize, const EDGES: usize> {
    bank: Bank<FACES, EDGES>,
    region: Region,
    /// Whether main's end was handed out.
    is_written: AtomicBool,
}

/// Main's end, with what writes the flash, whose first byte is the region's first.
pub struct Keeping<F, const FACES: usize, const EDGES: usize> {
    kept: &'static Kept<FACES, EDGES>,
    flash: RefCell<F>,
    begun: Cell<Option<Incoming>>,
    /// The file's first part, which is written last: until then there is no body, and of the rest nothing is read.
    head: Cell<[u8; CHUNK]>,
    /// The number of bytes of the region that are erased, or written since.
    erased: Cell<u32>,
    /// The CRC-32 of the file that is kept.
    crc: Cell<u32>,
}

impl<const FACES: usize, const EDGES: usize> Kept<FACES, EDGES> {
    /// Nothing known of what lies there.
    pub const fn new(region: Region) -> Self {
        Self::with_effort(region, Effort::BENCH)
    }

    /// The same for ticks of another effort.
    pub const fn with_effort(region: Region, effort: Effort) -> Self {
        Self { bank: Bank::new(effort), region, is_written: AtomicBool::new(false) }
    }

    /// Main's end, once, before the loop is made; and why what lies there is no body, if it is none. If it is one, it
    /// is rendered from the first tick on.
    pub fn main<F: NorFlash>(
        &'static self,
        flash: F,
        pause: &mut dyn FnMut(),
    ) -> Option<(Keeping<F, FACES, EDGES>, Result<(), FileError>)> {
        const { assert!(CHUNK.is_multiple_of(F::WRITE_SIZE), "a part of an upload is written whole") };
        let first = !self.is_written.swap(true, Ordering::Relaxed);
        first.then(|| {
            let keeping = Keeping {
                kept: self,
                flash: RefCell::new(flash),
                begun: Cell::new(None),
                head: Cell::new([0; CHUNK]),
                erased: Cell::new(0),
                crc: Cell::new(0),
            };
            let found = keeping.find(pause);
            (keeping, found)
        })
    }
}

impl<const FACES: usize, const EDGES: usize> BodyStore for Kept<FACES, EDGES> {
    fn take(&self) -> Option<u8> {
        self.bank.take().then_some(0)
    }

    #[inline]
    fn body(&self, _: u8) -> Option<&Body<'_>> {
        self.bank.body()
    }

    /// The stored body stays there, to be taken again.
    fn leave(&self, _: u8) {
        self.bank.put_down();
    }
}

impl<F: NorFlash, const FACES: usize, const EDGES: usize> Keeping<F, FACES, EDGES> {
    /// Looks for a body that was kept.
    fn find(&self, pause: &mut dyn FnMut()) -> Result<(), FileError> {
        // SAFETY: this is main's end, which is there once and cannot be shared; nothing is written now.
        let head = unsafe { self.kept.region.first(12) };
        // Magic, version, length: docs/reference/body-file.md.
        let length = head.get(8..).and_then(<[u8]>::first_chunk).map_or(0, |bytes| u32::from_le_bytes(*bytes));
        self.check(length, pause)
    }

    /// Checks what lies in the region's first bytes.
    fn check(&self, bytes: u32, pause: &mut dyn FnMut()) -> Result<(), FileError> {
        // SAFETY: as above; the region is written again only once the bank is main's.
        let file = unsafe { self.kept.region.first(bytes as usize) };
        // SAFETY: this is main's end; the feeding of a watchdog does not come here.
        unsafe { self.kept.bank.check(file, pause) }?;
        self.crc.set(file.last_chunk().map_or(0, |crc| u32::from_le_bytes(*crc)));
        Ok(())
    }

    /// Writes a part that was not written yet, erasing what it needs; says whether it is there.
    fn write(&self, at: u32, bytes: &[u8]) -> Option<()> {
        let mut flash = self.flash.try_borrow_mut().ok()?;
        let end = at.checked_add(bytes.len() as u32)?;
        while self.erased.get() < end {
            let from = self.erased.get();
            let to = from.checked_add(F::ERASE_SIZE as u32)?;
            flash.erase(from, to).ok()?;
            self.erased.set(to);
        }
        flash.write(at, bytes).ok()
    }

    /// Whether the bytes lie there.
    fn lies(&self, at: u32, bytes: &[u8]) -> bool {
        // SAFETY: this is main's end: nobody writes them meanwhile.
        let all = unsafe { self.kept.region.first(self.kept.region.bytes) };
        all.get(at as usize..).and_then(|rest| rest.get(..bytes.len())) == Some(bytes)
    }

    /// Starts a file of `bytes`; none erases the stored body.
    fn begin(&self, bytes: u32) -> Result<(), UploadError> {
        self.begun.set(None);
        let incoming = Incoming::begin(bytes, self.room().0)?;
        // SAFETY: this is main's end, which is there once; the feeding of a watchdog does not come here.
        if !unsafe { self.kept.bank.reclaim() } {
            return Err(UploadError::Felt);
        }
        // The stored body is invalid from here on, whenever the power goes.
        self.crc.set(0);
        self.erased.set(0);
        self.erase_first()?;
        if bytes > 0 {
            self.begun.set(Some(incoming));
        }
        Ok(())
    }

    /// All `bytes` of a file have come.
    fn end(&self, bytes: u32, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        let head = self.head.get();
        if self.write(0, &head).is_none() || !self.lies(0, &head) {
            return Err(UploadError::Flash { at: 0 });
        }
        self.check(bytes, pause).map_err(|wrong| {
            // No body stays none. Where it cannot be erased it is refused at every start.
            let _ = self.erase_first();
            refusal(&wrong)
        })
    }

    fn erase_first(&self) -> Result<(), UploadError> {
        let flash = self.flash.try_borrow_mut();
        let is_erased = flash.is_ok_and(|mut flash| flash.erase(0, F::ERASE_SIZE as u32).is_ok());
        if !is_erased {
            return Err(UploadError::Flash { at: 0 });
        }
        self.erased.set(self.erased.get().max(F::ERASE_SIZE as u32));
        Ok(())
    }
}

impl<F: NorFlash, const FACES: usize, const EDGES: usize> Uploads for Keeping<F, FACES, EDGES> {
    fn room(&self) -> (u32, u16, u16) {
        let bytes = self.kept.region.bytes / F::ERASE_SIZE * F::ERASE_SIZE;
        (bytes as u32, FACES as u16, EDGES as u16)
    }

    fn put(&self, part: &Upload, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        match *part {
            Upload::Begin { bytes } | Upload::Keep { bytes } => self.begin(bytes),
            Upload::Bytes { at, bytes } => {
                let incoming = self.begun.get().ok_or(UploadError::NotBegun)?;
                let length = incoming.length(at)?;
                let bytes = bytes.as_flattened();
                if at == 0 {
                    self.head.set(bytes.try_into().unwrap_or([0; CHUNK]));
                } else {
                    // Flash takes a word once: a part that comes twice is compared.
                    let is_there = incoming.has(at) || self.write(at, bytes).is_some();
                    if !is_there || !self.lies(at, bytes) {
                        return Err(UploadError::Flash { at });
                    }
                }
                self.begun.set(Some(incoming.came(at, length)));
                Ok(())
            }
            Upload::End => {
                let incoming = self.begun.get().ok_or(UploadError::NotBegun)?;
                incoming.whole()?;
                if !incoming.is_checked {
                    // A failed end is final: nothing is written for a repeated end.
                    self.begun.set(None);
                    self.end(incoming.bytes, pause)?;
                    self.begun.set(Some(incoming.checked()));
                }
                Ok(())
            }
        }
    }

    fn kept(&self) -> u32 {
        self.crc.get()
    }
}
