//! The memo that outlives a reset, in memory.

use crate::Memo;
use core::sync::atomic::{AtomicU32, Ordering};

/// Two words of memory that the start-up code leaves alone (`.uninit`).
pub struct MemoCell([AtomicU32; 2]);

impl MemoCell {
    /// Its place; whatever is written here is not put there.
    pub const fn new() -> Self {
        Self([AtomicU32::new(0), AtomicU32::new(0)])
    }

    /// Its content.
    pub fn read(&self) -> Memo {
        Memo([self.0[0].load(Ordering::Relaxed), self.0[1].load(Ordering::Relaxed)])
    }

    /// Says this after the next reset.
    pub fn write(&self, Memo(words): Memo) {
        self.0[0].store(words[0], Ordering::Relaxed);
        self.0[1].store(words[1], Ordering::Relaxed);
    }
}

impl Default for MemoCell {
    fn default() -> Self {
        Self::new()
    }
}
