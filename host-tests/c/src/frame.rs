//! Packing a message, without a panic that the compiler could not rule out.
//!
//! `palpate::wire::frame::pack` writes the same bytes; the COBS encoder that it takes indexes its buffer, and so leaves
//! a branch to a panic that is never taken. Here a message goes in plain, and is framed in a second pass.

use crc::{CRC_32_ISO_HDLC, Crc, Table};
use palpate_core::wire::Report;
use palpate_core::wire::frame::{DELIMITER, MAX_FRAME};

static CHECKSUM: Crc<u32, Table<1>> = Crc::<u32, Table<1>>::new(&CRC_32_ISO_HDLC);

/// Bytes that a COBS code byte stands for, itself included.
const LONGEST_RUN: usize = 255;

/// Packs a report at the start of `buffer` and gives that part back; `None` if it does not fit.
pub fn pack<'a>(report: &Report, buffer: &'a mut [u8; MAX_FRAME]) -> Option<&'a [u8]> {
    let mut message = [0; MAX_FRAME];
    let length = postcard::to_slice(report, message.get_mut(..MAX_FRAME - 4)?).ok()?.len();
    let checksum = CHECKSUM.checksum(message.get(..length)?);
    *message.get_mut(length..)?.first_chunk_mut()? = checksum.to_le_bytes();
    let plain = message.get(..length + 4)?;
    // A code byte, then the bytes up to the next zero, which it stands for.
    let mut end = 0;
    for run in plain.split(|byte| *byte == DELIMITER) {
        let code = u8::try_from(run.len() + 1).ok().filter(|code| usize::from(*code) < LONGEST_RUN)?;
        *buffer.get_mut(end)? = code;
        for byte in run {
            end += 1;
            *buffer.get_mut(end)? = *byte;
        }
        end += 1;
    }
    *buffer.get_mut(end)? = DELIMITER;
    buffer.get(..=end)
}
