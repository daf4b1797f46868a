//! Messages on their way out, over a port that is never waited for.

use crate::Port;
use palpate::wire::frame::{self, MAX_FRAME};
use serde::Serialize;

/// One message, as far as it is still to be sent.
#[derive(Debug)]
pub(crate) struct Outbox {
    buffer: [u8; MAX_FRAME],
    left: core::ops::Range<usize>,
}

impl Outbox {
    /// Empty.
    pub const fn new() -> Self {
        Self { buffer: [0; MAX_FRAME], left: 0..0 }
    }

    /// Whether the next message may be put in.
    pub const fn is_empty(&self) -> bool {
        self.left.start >= self.left.end
    }

    /// Puts a message in, in the place of whatever was there.
    pub fn put(&mut self, message: &impl Serialize) {
        let length = frame::pack(message, &mut self.buffer).map_or(0, |frame| frame.len());
        self.left = 0..length;
    }

    /// Sends a byte at most.
    pub fn step(&mut self, port: &mut impl Port) {
        if !self.is_empty()
            && let Some(byte) = self.buffer.get(self.left.start)
            && port.send(*byte)
        {
            self.left.start += 1;
        }
    }
}
