//! Memory for bodies that come over the line while others are felt.
//!
//! A [`Bodies`] has two banks: main writes and checks a body in one while the tick feels that of the other. A bank goes
//! from hand to hand by one word: main's, while it is written; nobody's, once its body was checked; the tick's, once
//! it was taken; main's again, once the tick has taken another. Nobody waits for anybody.
//!
//! Main and the tick are one each: [`Bodies::main`] hands out main's end once, and the tick's is for the one
//! [`palpate::scene::Slot`] that has it. This is a crate of its own because it is the only code between main and the
//! tick that the compiler cannot check.

#![no_std]

mod bank;

use bank::Bank;
use core::cell::Cell;
use core::sync::atomic::{AtomicBool, Ordering};
use palpate::body::{Body, FileError};
use palpate::scene::Shelf;
use palpate::wire::{CHUNK, Upload, UploadError};
use palpate_bench::Uploads;

/// Two banks for bodies of at most so many words (four bytes), faces and edges. A `static`.
pub struct Bodies<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    banks: [Bank<WORDS, FACES, EDGES>; 2],
    /// Whether main's end was handed out.
    is_written: AtomicBool,
}

/// Main's end.
pub struct Writing<const WORDS: usize, const FACES: usize, const EDGES: usize> {
    bodies: &'static Bodies<WORDS, FACES, EDGES>,
    begun: Cell<Option<Begun>>,
}

/// A body on its way.
#[derive(Clone, Copy, Debug)]
struct Begun {
    /// The bank it comes into.
    bank: usize,
    /// Its length.
    bytes: u32,
    /// How many of them have come.
    came: u32,
    /// Whether it was checked, and is there to be taken.
    is_checked: bool,
}

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Bodies<WORDS, FACES, EDGES> {
    /// Nothing in it.
    pub const fn new() -> Self {
        Self { banks: [const { Bank::new() }; 2], is_written: AtomicBool::new(false) }
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

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Shelf for Bodies<WORDS, FACES, EDGES> {
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

impl<const WORDS: usize, const FACES: usize, const EDGES: usize> Uploads for Writing<WORDS, FACES, EDGES> {
    fn room(&self) -> (u32, u16, u16) {
        ((WORDS * 4) as u32, FACES as u16, EDGES as u16)
    }

    fn put(&self, part: &Upload) -> Result<(), UploadError> {
        let banks = &self.bodies.banks;
        match *part {
            Upload::Begin { bytes } => {
                self.begun.set(None);
                let room = self.room().0;
                if bytes > room {
                    return Err(UploadError::TooLong { room });
                }
                // Both, so that a body that waits in the other is not taken in its place later on.
                let bank =
                    [0, 1].into_iter().fold(None, |free, bank| if banks[bank].reclaim() { Some(bank) } else { free });
                let bank = bank.ok_or(UploadError::Busy)?;
                self.begun.set(Some(Begun { bank, bytes, came: 0, is_checked: false }));
                Ok(())
            }
            Upload::Bytes { at, bytes } => {
                let begun = self.begun.get().ok_or(UploadError::NotBegun)?;
                // The same part twice: its answer was lost.
                if at > begun.came || at >= begun.bytes || !at.is_multiple_of(CHUNK as u32) {
                    return Err(UploadError::Order { at: begun.came });
                }
                let length = (begun.bytes - at).min(CHUNK as u32);
                let came = bytes.as_flattened().get(..length as usize).unwrap_or(&[]);
                // SAFETY: this is main's end, which is there once and cannot be shared: `Cell` is not `Sync`.
                let is_written = unsafe { banks[begun.bank].write(at as usize, came) };
                if !is_written {
                    return Err(UploadError::Busy);
                }
                self.begun.set(Some(Begun { came: begun.came.max(at + length), ..begun }));
                Ok(())
            }
            Upload::End => {
                let begun = self.begun.get().ok_or(UploadError::NotBegun)?;
                if begun.came < begun.bytes {
                    return Err(UploadError::Order { at: begun.came });
                }
                // Said twice: the answer was lost.
                if begun.is_checked {
                    return Ok(());
                }
                // SAFETY: as above.
                unsafe { banks[begun.bank].check(begun.bytes as usize) }.map_err(|wrong| match wrong {
                    FileError::Room { .. } => UploadError::TooMany,
                    _ => UploadError::NoBody,
                })?;
                self.begun.set(Some(Begun { is_checked: true, ..begun }));
                Ok(())
            }
        }
    }
}
