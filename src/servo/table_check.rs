//! The tables in flash are read over and over, whole before the first tick and then a word every second
//! tick, and their CRC compared.

use super::Surface;
use crate::body::TableCursor;
use crate::patch::crc32;

/// How far the check has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableCheck {
    /// The next word.
    pub place: TableCursor,
    /// The CRC so far.
    pub crc: u32,
    /// How often the whole table was found good.
    pub passes: u32,
    /// A word that is read, and not yet in the CRC.
    pub read: Option<u32>,
}

impl TableCheck {
    /// Reads one word more, or takes the last one into the CRC: some 40 instructions either way. False if the tables
    /// were read to their end and their CRC is not the expected one.
    #[inline]
    pub fn step<S: Surface>(&mut self, surface: &S, expected: u32) -> bool {
        if let Some(word) = self.read.take() {
            self.crc = crc32(self.crc, word);
            return true;
        }
        let found = surface.table_word(self.place);
        self.read = found;
        let Some(next) = self.place.after(found) else {
            let good = self.crc == expected;
            *self = Self { passes: self.passes.wrapping_add(u32::from(good)), ..Self::default() };
            return good;
        };
        self.place = next;
        true
    }

    /// CRC-32 of the tables as they lie in memory, read from their start to their end: before the first tick, for it
    /// takes time in proportion to their size.
    pub fn read<S: Surface>(surface: &S) -> u32 {
        let (mut place, mut crc) = (TableCursor::default(), 0);
        loop {
            let found = surface.table_word(place);
            if let Some(word) = found {
                crc = crc32(crc, word);
            }
            match place.after(found) {
                Some(next) => place = next,
                None => return crc,
            }
        }
    }

    /// Reads the tables once, as [`Self::read`] does. True if they are good.
    pub fn run<S: Surface>(&mut self, surface: &S, expected: u32) -> bool {
        let good = Self::read(surface) == expected;
        *self = Self { passes: self.passes.wrapping_add(u32::from(good)), ..Self::default() };
        good
    }
}
