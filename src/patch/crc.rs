//! The checksum of the tables.

/// CRC-32 (ISO-HDLC, reflected `0xEDB8_8320`) of one more little-endian word; start with 0.
pub const fn crc32(crc: u32, word: u32) -> u32 {
    crc32_of(crc32_with(crc, word))
}

/// The first half of [`crc32`]: a CRC and a word in one number.
#[inline(always)]
pub(crate) const fn crc32_with(crc: u32, word: u32) -> u32 {
    !crc ^ word
}

/// The second half of [`crc32`].
#[inline(always)]
pub(crate) const fn crc32_of(crc_with_word: u32) -> u32 {
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
    let mut crc = crc_with_word;
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
