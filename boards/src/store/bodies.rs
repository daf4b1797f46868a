//! RAM for bodies: two banks, one for main and one for the tick.

use super::bank::Bank;
use super::incoming::{Incoming, refusal};
use crate::Uploads;
use core::cell::{Cell, UnsafeCell};
use palpate::body::{Body, Effort};
use palpate::scene::BodyStore;
use palpate::wire::{Upload, UploadError};
use portable_atomic::{AtomicBool, Ordering};

/// Two banks for bodies of at most `WORDS` words (four bytes), `FACES` and `EDGES`. A `static`.
pub struct Bodies<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    banks: [Bank<FACES, EDGES>; 2],
    files: [Words<WORDS>; 2],
    /// Whether main's end was handed out.
    is_written: AtomicBool,
}

/// Where a file lies.
struct Words<const WORDS: usize>(UnsafeCell<[u32; WORDS]>);

// SAFETY: written only while main holds the bank of the same number, and there is one main (`Bodies::main`); read only
// while it is not main's.
unsafe impl<const WORDS: usize> Sync for Words<WORDS> {}

/// Main's end.
pub struct Writing<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    bodies: &'static Bodies<WORDS, FACES, EDGES>,
    /// The bank that a body comes into.
    begun: Cell<Option<(usize, Incoming)>>,
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Bodies<WORDS, FACES, EDGES> {
    /// Nothing in it.
    pub const fn new() -> Self {
        Self::with_effort(Effort::BENCH)
    }

    /// The same for ticks of another effort.
    pub const fn with_effort(effort: Effort) -> Self {
        Self {
            banks: [Bank::new(effort), Bank::new(effort)],
            files: [const { Words(UnsafeCell::new([0; WORDS])) }; 2],
            is_written: AtomicBool::new(false),
        }
    }

    /// Main's end, once.
    pub fn main(&'static self) -> Option<Writing<WORDS, FACES, EDGES>> {
        let first = !self.is_written.swap(true, Ordering::Relaxed);
        first.then_some(Writing { bodies: self, begun: Cell::new(None) })
    }
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Default for Bodies<WORDS, FACES, EDGES> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> BodyStore for Bodies<WORDS, FACES, EDGES> {
    fn take(&self) -> Option<u8> {
        (0..).zip(&self.banks).find(|(_, bank)| bank.take()).map(|(index, _)| index)
    }

    #[inline]
    fn body(&self, bank: u8) -> Option<&Body<'_>> {
        self.banks.get(usize::from(bank))?.body()
    }

    fn leave(&self, bank: u8) {
        if let Some(bank) = self.banks.get(usize::from(bank)) {
            bank.leave();
        }
    }
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Writing<WORDS, FACES, EDGES> {
    /// Writes bytes at a place of a bank's file; false where they do not fit, or the bank is not main's.
    fn write(&self, bank: usize, at: usize, bytes: &[u8]) -> bool {
        if !self.bodies.banks[bank].is_mains() {
            return false;
        }
        // SAFETY: main holds the bank, and this is main's end, which is there once and cannot be shared (`Cell` is not
        // `Sync`): nobody else looks at the words.
        let words = unsafe { &mut *self.bodies.files[bank].0.get() };
        let buffer = bytemuck::cast_slice_mut::<u32, u8>(words);
        let Some(place) = at.checked_add(bytes.len()).and_then(|end| buffer.get_mut(at..end)) else { return false };
        place.copy_from_slice(bytes);
        true
    }

    /// Whether no reference to its file is left in a bank, for tests. `false` while it is not main's.
    #[doc(hidden)]
    pub fn is_vacant(&self, bank: u8) -> bool {
        // SAFETY: this is main's end, which is there once; the feeding of a watchdog does not come here.
        self.bodies.banks.get(usize::from(bank)).is_some_and(|bank| unsafe { bank.is_vacant() })
    }

    /// Checks the file of a bank.
    fn check(&self, bank: usize, bytes: u32, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        if !self.bodies.banks[bank].is_mains() {
            return Err(UploadError::Busy);
        }
        // SAFETY: main holds the bank and is here; it writes the words no more until the bank is its own again.
        let words: &'static [u32; WORDS] = unsafe { &*self.bodies.files[bank].0.get() };
        let file = bytemuck::cast_slice::<u32, u8>(words).get(..bytes as usize).ok_or(UploadError::NoBody)?;
        // SAFETY: as above; the feeding of a watchdog does not come here.
        unsafe { self.bodies.banks[bank].check(file, pause) }.map_err(|wrong| refusal(&wrong))
    }
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Uploads for Writing<WORDS, FACES, EDGES> {
    fn room(&self) -> (u32, u16, u16) {
        ((WORDS * 4) as u32, FACES as u16, EDGES as u16)
    }

    fn put(&self, part: &Upload, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        let banks = &self.bodies.banks;
        match *part {
            Upload::Begin { bytes } | Upload::Keep { bytes } => {
                self.begun.set(None);
                let incoming = Incoming::begin(bytes, self.room().0)?;
                // Both, so that a body that waits in the other is not taken in its place later on.
                let bank = [0, 1].into_iter().fold(None, |free, bank| {
                    // SAFETY: this is main's end, which is there once; the feeding of a watchdog does not come here.
                    if unsafe { banks[bank].reclaim() } { Some(bank) } else { free }
                });
                self.begun.set(Some((bank.ok_or(UploadError::Busy)?, incoming)));
                Ok(())
            }
            Upload::Bytes { at, bytes } => {
                let (bank, incoming) = self.begun.get().ok_or(UploadError::NotBegun)?;
                let length = incoming.length(at)?;
                if !self.write(bank, at as usize, bytes.as_flattened().get(..length).unwrap_or(&[])) {
                    return Err(UploadError::Busy);
                }
                self.begun.set(Some((bank, incoming.came(at, length))));
                Ok(())
            }
            Upload::End => {
                let (bank, incoming) = self.begun.get().ok_or(UploadError::NotBegun)?;
                incoming.whole()?;
                // Said twice: the answer was lost.
                if !incoming.is_checked {
                    self.check(bank, incoming.bytes, pause)?;
                    self.begun.set(Some((bank, incoming.checked())));
                }
                Ok(())
            }
        }
    }
}
