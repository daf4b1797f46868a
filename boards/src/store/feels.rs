//! Flash for a knob's feel.

use crate::Feels;
use core::cell::{Cell, RefCell};
use embedded_storage::nor_flash::NorFlash;
use palpate::patch::crc32;
use palpate::render::Feel;
use palpate::wire::{KeepError, KeptFeel};

/// Of a record: eight bytes of magic and CRC-32, then the feel as on the wire, then zeros.
const WORDS: usize = 34;
const BYTES: usize = 4 * WORDS;
/// Its first bytes, which are written last, as many as a chip of any kind writes at once.
const HEAD: usize = 8;
/// `PFL1`; another layout of a feel takes another number.
const MAGIC: u32 = u32::from_le_bytes(*b"PFL1");

/// One feel in the first page of some flash. Main's.
pub struct KeptFeels<F> {
    flash: RefCell<F>,
    in_use: Cell<KeptFeel>,
}

impl<F: NorFlash> KeptFeels<F> {
    /// Looks for a feel, before the loop is made.
    pub fn find(flash: F) -> (Self, Option<Feel>) {
        const { assert!(HEAD.is_multiple_of(F::WRITE_SIZE), "a head is written whole") };
        const { assert!(HEAD.is_multiple_of(F::READ_SIZE), "a record is read whole") };
        let kept = Self { flash: RefCell::new(flash), in_use: Cell::new(KeptFeel::None) };
        let found = kept.read();
        let feel = found.as_ref().and_then(of_words);
        kept.in_use.set(match (feel, found) {
            (Some(_), _) => KeptFeel::Used,
            (None, Some(words)) if words.iter().all(|word| *word == u32::MAX) => KeptFeel::None,
            _ => KeptFeel::Refused,
        });
        (kept, feel)
    }

    /// The loop did not take it, or the chip says that it could not read it.
    pub fn refused(&self) {
        self.in_use.set(KeptFeel::Refused);
    }

    fn read(&self) -> Option<[u32; WORDS]> {
        let mut bytes = [0; BYTES];
        self.flash.try_borrow_mut().ok()?.read(0, &mut bytes).ok()?;
        let mut words = [0; WORDS];
        for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
            *word = u32::from_le_bytes(*bytes);
        }
        Some(words)
    }

    /// Erases the page, and writes the record if there is one: its head last, so that it is there whole or not at all.
    fn write(&self, words: Option<&[u32; WORDS]>) -> Option<()> {
        let mut flash = self.flash.try_borrow_mut().ok()?;
        flash.erase(0, F::ERASE_SIZE as u32).ok()?;
        let Some(words) = words else { return Some(()) };
        let bytes = words.map(u32::to_le_bytes);
        let (head, rest) = bytes.as_flattened().split_at_checked(HEAD)?;
        flash.write(HEAD as u32, rest).ok()?;
        flash.write(0, head).ok()
    }
}

impl<F: NorFlash> Feels for KeptFeels<F> {
    fn in_use(&self) -> KeptFeel {
        self.in_use.get()
    }

    fn keep(&self, feel: Option<&Feel>) -> Result<(), KeepError> {
        let words = feel.map(|feel| to_words(feel).ok_or(KeepError::Flash)).transpose()?;
        self.write(words.as_ref()).ok_or(KeepError::Flash)?;
        let wanted = words.unwrap_or([u32::MAX; WORDS]);
        if self.read() == Some(wanted) { Ok(()) } else { Err(KeepError::Flash) }
    }
}

fn crc(words: &[u32; WORDS]) -> u32 {
    words.iter().skip(2).fold(0, |crc, word| crc32(crc, *word))
}

fn to_words(feel: &Feel) -> Option<[u32; WORDS]> {
    let mut bytes = [[0; 4]; WORDS];
    postcard::to_slice(feel, bytes.as_flattened_mut().get_mut(HEAD..)?).ok()?;
    let mut words = bytes.map(u32::from_le_bytes);
    let crc = crc(&words);
    (words[0], words[1]) = (MAGIC, crc);
    Some(words)
}

fn of_words(words: &[u32; WORDS]) -> Option<Feel> {
    let is_whole = words[0] == MAGIC && words[1] == crc(words);
    let bytes = words.map(u32::to_le_bytes);
    postcard::from_bytes(bytes.as_flattened().get(HEAD..)?).ok().filter(|_| is_whole)
}
