//! Bodies that come over the line.

use palpate::wire::{Upload, UploadError};

/// Memory for a body that comes over the line while another is felt. Main writes it, and checks what came, which takes
/// as long as it takes; the tick goes on meanwhile.
pub trait Uploads {
    /// Bytes of a body's file, and its faces and edges, at most.
    fn room(&self) -> (u32, u16, u16);

    /// Takes a part of a file. The last part has it checked, which takes some 130 instructions a word of it in one go:
    /// a watchdog and a link's timeout have to be longer than that, beside the ticks that go on meanwhile.
    ///
    /// # Errors
    /// What is wrong with it. What was uploaded before stands, until another is begun.
    fn put(&self, part: &Upload) -> Result<(), UploadError>;
}
