//! RAM with the rules of flash, where there is none to write: for emulated boards, simulated devices and tests.

use super::Region;
use core::fmt;
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash};
use portable_atomic::{AtomicBool, AtomicU32, Ordering};

/// As the STM32G4's: erased by 2 KB, written by double words, each once. A `static`.
pub struct PretendedFlash<const WORDS: usize> {
    words: [AtomicU32; WORDS],
    /// Whether its writer was handed out.
    is_written: AtomicBool,
}

/// Its writer.
pub struct Pretended<const WORDS: usize>(&'static PretendedFlash<WORDS>);

const PAGE: usize = 2_048;
const DOUBLE_WORD: usize = 8;

impl<const WORDS: usize> PretendedFlash<WORDS> {
    /// Erased.
    pub const fn new() -> Self {
        Self { words: [const { AtomicU32::new(u32::MAX) }; WORDS], is_written: AtomicBool::new(false) }
    }

    /// Another with the same content: as after a reset.
    #[must_use]
    pub fn after_reset(&self) -> Self {
        let words = core::array::from_fn(|index| AtomicU32::new(self.words[index].load(Ordering::Relaxed)));
        Self { words, is_written: AtomicBool::new(false) }
    }

    /// Where it is read. For one [`super::Kept`] at a time.
    pub const fn region(&'static self) -> Region {
        // SAFETY: a `static` of `WORDS * 4` bytes, which only its writer writes.
        unsafe { Region::new(self.words.as_ptr().cast(), WORDS * 4) }
    }

    /// Its writer, once.
    pub fn writer(&'static self) -> Option<Pretended<WORDS>> {
        (!self.is_written.swap(true, Ordering::Relaxed)).then_some(Pretended(self))
    }

    /// The words of `bytes` from `offset` on, if both are multiples of `size`.
    fn part(&self, offset: u32, bytes: usize, size: usize) -> Result<&[AtomicU32], Broken> {
        let offset = offset as usize;
        if !offset.is_multiple_of(size) || !bytes.is_multiple_of(size) {
            return Err(Broken(NorFlashErrorKind::NotAligned));
        }
        let part = self.words.get(offset / 4..).and_then(|rest| rest.get(..bytes / 4));
        part.ok_or(Broken(NorFlashErrorKind::OutOfBounds))
    }
}

impl<const WORDS: usize> fmt::Debug for PretendedFlash<WORDS> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("PretendedFlash").field("words", &WORDS).finish_non_exhaustive()
    }
}

impl<const WORDS: usize> Default for PretendedFlash<WORDS> {
    fn default() -> Self {
        Self::new()
    }
}

/// A rule of flash was broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Broken(NorFlashErrorKind);

impl NorFlashError for Broken {
    fn kind(&self) -> NorFlashErrorKind {
        self.0
    }
}

impl<const WORDS: usize> ErrorType for Pretended<WORDS> {
    type Error = Broken;
}

impl<const WORDS: usize> ReadNorFlash for Pretended<WORDS> {
    const READ_SIZE: usize = 4;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Broken> {
        let words = self.0.part(offset, bytes.len(), Self::READ_SIZE)?;
        for (bytes, word) in bytes.as_chunks_mut().0.iter_mut().zip(words) {
            *bytes = word.load(Ordering::Relaxed).to_le_bytes();
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        WORDS * 4
    }
}

impl<const WORDS: usize> NorFlash for Pretended<WORDS> {
    const WRITE_SIZE: usize = DOUBLE_WORD;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Broken> {
        for word in self.0.part(from, to.saturating_sub(from) as usize, PAGE)? {
            word.store(u32::MAX, Ordering::Relaxed);
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Broken> {
        let words = self.0.part(offset, bytes.len(), DOUBLE_WORD)?;
        // A double word has a checksum of its own: it is written once.
        if words.iter().any(|word| word.load(Ordering::Relaxed) != u32::MAX) {
            return Err(Broken(NorFlashErrorKind::Other));
        }
        for (word, bytes) in words.iter().zip(bytes.as_chunks().0) {
            word.store(u32::from_le_bytes(*bytes), Ordering::Relaxed);
        }
        Ok(())
    }
}
