//! A body on its way into a device's memory.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Bytes of a body in one frame.
pub const CHUNK: usize = 64;

/// Part of a body file ([`crate::body::Body::from_bytes`]), in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Upload {
    /// Starts a file of this number of bytes; an earlier upload that was not taken is discarded.
    Begin {
        /// Its length.
        bytes: u32,
    },
    /// Bytes from this one on, a multiple of [`CHUNK`]; those beyond the file's end are zero. The same may come twice.
    Bytes {
        /// The first one's place.
        at: u32,
        /// Sixteen at a time.
        bytes: [[u8; 16]; CHUNK / 16],
    },
    /// All of it has come: it is checked, and ready to be taken ([`crate::scene::Command::Take`]).
    End,
    /// As [`Self::Begin`], but into the device's flash, where it stays without power and is rendered from the next
    /// reset on. From this message to [`Self::End`] the device keeps its motors off; it refuses while they are driven,
    /// or force is requested. The earlier stored body is erased. A file of zero bytes only erases, and needs no
    /// [`Self::End`].
    Keep {
        /// Its length.
        bytes: u32,
    },
}

/// Why a part of an upload is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum UploadError {
    /// No memory was set aside for bodies.
    #[error("this device has no memory for bodies")]
    NoRoom,
    /// More bytes than there is memory for.
    #[error("the body is larger than the device's {room} bytes")]
    TooLong {
        /// The available capacity.
        room: u32,
    },
    /// More faces or edges than there is memory for.
    #[error("the body has more faces or edges than the device has memory for")]
    TooMany,
    /// Both banks are in use: the last uploaded body has just been taken, and the one before still fades out.
    #[error("both banks are in use; try again in a moment")]
    Busy,
    /// A part that does not follow on the one before: the next byte wanted is this.
    #[error("the upload continues at byte {at}")]
    Order {
        /// The next byte's place.
        at: u32,
    },
    /// No upload was started.
    #[error("no upload was started")]
    NotBegun,
    /// The received bytes are no valid body: damaged, or of another version. The host's own check gives the details.
    #[error("damaged or unsupported body file")]
    NoBody,
    /// No flash was set aside for bodies.
    #[error("this device has no flash for bodies")]
    NoFlash,
    /// The motors are driven, or the enable input is held: flash is written only while they are off.
    #[error("flash is written only while the motors are off; release the enable input first")]
    Driven,
    /// The stored body is in use: replace it first ([`crate::scene::Command::PutBack`]).
    #[error("the body stored in flash is in use; put the built-in one back first")]
    Felt,
    /// The flash write failed verification.
    #[error("flash write error at byte {at}")]
    Flash {
        /// Where.
        at: u32,
    },
    /// Nobody held the enable button and released it.
    #[error("not confirmed at the device: hold the enable button for half a second, then release it")]
    NotConfirmed,
    /// Flash was written as often as it may be between two resets.
    #[error("flash was written too often since the last reset; reset the device")]
    Worn,
}
