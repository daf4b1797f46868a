//! A file on its way, part by part.

use palpate::body::FileError;
use palpate::wire::{CHUNK, UploadError};

/// How far it has come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Incoming {
    /// Its length.
    pub bytes: u32,
    /// How many of them have come.
    came: u32,
    /// Whether it was checked, and is there to be taken.
    pub is_checked: bool,
}

impl Incoming {
    pub const fn begin(bytes: u32, room: u32) -> Result<Self, UploadError> {
        if bytes > room {
            return Err(UploadError::TooLong { room });
        }
        Ok(Self { bytes, came: 0, is_checked: false })
    }

    /// How many bytes of a part at this place are the file's. The same part may come twice, for its answer may have
    /// been lost.
    pub fn length(&self, at: u32) -> Result<usize, UploadError> {
        if at > self.came || at >= self.bytes || !at.is_multiple_of(CHUNK as u32) {
            return Err(UploadError::Order { at: self.came });
        }
        Ok((self.bytes - at).min(CHUNK as u32) as usize)
    }

    /// Whether a part at this place has come before.
    pub const fn has(&self, at: u32) -> bool {
        at < self.came
    }

    /// A part of `length` bytes has come.
    pub fn came(self, at: u32, length: usize) -> Self {
        Self { came: self.came.max(at + length as u32), ..self }
    }

    /// It was checked.
    pub const fn checked(self) -> Self {
        Self { is_checked: true, ..self }
    }

    /// Whether all of it has come.
    pub const fn whole(&self) -> Result<(), UploadError> {
        if self.came < self.bytes { Err(UploadError::Order { at: self.came }) } else { Ok(()) }
    }
}

/// The error for a file that is no body.
pub(crate) const fn refusal(wrong: &FileError) -> UploadError {
    match wrong {
        FileError::BufferTooSmall { .. } => UploadError::TooMany,
        _ => UploadError::NoBody,
    }
}
