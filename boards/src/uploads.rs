//! Bodies that come over the line.

use palpate::wire::{Upload, UploadError};

/// Memory for a body that comes over the line: RAM, while another is rendered, or flash, while the motors are off. Main
/// writes it, and checks what came, which takes as long as it takes; the tick goes on meanwhile.
pub trait Uploads {
    /// Bytes of a body's file, and its faces and edges, at most.
    fn room(&self) -> (u32, u16, u16);

    /// Takes a part of a file; [`Upload::Keep`] is not for here, but comes as [`Upload::Begin`] to the memory that is
    /// flash. The last part has it checked, which takes some 125 instructions a word of it; `pause` is called
    /// regularly meanwhile: it feeds the watchdog.
    ///
    /// # Errors
    /// The fault of the file. The previous upload stands until another starts.
    fn put(&self, part: &Upload, pause: &mut dyn FnMut()) -> Result<(), UploadError>;

    /// The CRC-32 at the end of the file that is kept here without power; 0 where none is.
    fn kept(&self) -> u32 {
        0
    }
}
