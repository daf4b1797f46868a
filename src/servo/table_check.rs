//! The tables in flash are read over and over, whole before the first tick and then a word a tick, and their CRC compared.

use super::Surface;
use crate::body::TableCursor;

/// How far the check has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableCheck {
    /// The next word.
    pub place: TableCursor,
    /// The CRC so far.
    pub crc: u32,
    /// How often the whole table was found good.
    pub passes: u32,
}

impl TableCheck {
    /// Reads one word more, some 60 instructions. False if the tables were read to their end and their CRC is not the expected one.
    #[inline]
    pub fn step<S: Surface>(&mut self, surface: &S, expected: u32) -> bool {
        let found = surface.table_word(self.place);
        if let Some(word) = found {
            self.crc = crc32(self.crc, word);
        }
        let Some(next) = self.place.after(found) else {
            let good = self.crc == expected;
            *self = Self { passes: self.passes.wrapping_add(u32::from(good)), ..Self::default() };
            return good;
        };
        self.place = next;
        true
    }

    /// Reads the tables once, from their start to their end: before the first tick, for it takes as long as they are. Whether they are good.
    pub fn run<S: Surface>(&mut self, surface: &S, expected: u32) -> bool {
        *self = Self { passes: self.passes, ..Self::default() };
        let before = self.passes;
        while self.step(surface, expected) {
            if self.passes != before {
                return true;
            }
        }
        false
    }
}

/// CRC-32 (ISO-HDLC, reflected `0xEDB8_8320`) of one more little-endian word; begin with 0.
pub const fn crc32(crc: u32, word: u32) -> u32 {
    const TABLE: [u32; 16] = {
        let mut table = [0; 16];
        let mut index = 0;
        while index < 16 {
            let mut entry = index as u32;
            let mut bit = 0;
            while bit < 4 {
                entry = if entry & 1 == 1 { (entry >> 1) ^ 0xEDB8_8320 } else { entry >> 1 };
                bit += 1;
            }
            table[index] = entry;
            index += 1;
        }
        table
    };
    let mut crc = !crc ^ word;
    let mut nibble = 0;
    while nibble < 8 {
        crc = (crc >> 4) ^ TABLE[(crc & 15) as usize];
        nibble += 1;
    }
    !crc
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crc_is_the_common_one() {
        // "12345678" as two little-endian words; the catalogue's check string less its last digit, by any CRC-32 tool.
        let crc = crc32(crc32(0, u32::from_le_bytes(*b"1234")), u32::from_le_bytes(*b"5678"));
        assert_eq!(crc, 0x9AE0_DAAF);
    }
}
