//! Bodies that come over the line.

use palpate::wire::{Upload, UploadError};

/// Memory for a body that comes over the line while another is felt. Main writes it, and checks what came, which takes
/// as long as it takes; the tick goes on meanwhile.
pub trait Uploads {
    /// Bytes of a body's file, and its faces and edges, at most.
    fn room(&self) -> (u32, u16, u16);

    /// Takes a part of a file.
    ///
    /// # Errors
    /// What is wrong with it. What was uploaded before stands, until another is begun.
    fn put(&self, part: &Upload) -> Result<(), UploadError>;
}
