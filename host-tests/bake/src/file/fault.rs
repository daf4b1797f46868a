//! Why there is no file.

use crate::body::TableFault;
use palpate::body::FileError;
use thiserror::Error;

/// Why there is no file, or none that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FileFault {
    /// The library refuses the file.
    #[error(transparent)]
    File(#[from] FileError),
    /// The library refuses the tables.
    #[error(transparent)]
    Table(#[from] TableFault),
    /// The notes are not what they should be.
    #[error("the notes for the host (section NOTE) are malformed at byte {at}")]
    Notes {
        /// Where, from the section's first byte.
        at: usize,
    },
    /// A weight of a face is not positive: it is no NURBS patch.
    #[error("face {face} has a weight that is not positive")]
    Weight {
        /// The face.
        face: usize,
    },
    /// Beyond what a file can hold.
    #[error("the tables are too large for a file: {bytes} bytes")]
    TooLarge {
        /// How many bytes there would be.
        bytes: usize,
    },
}
