//! A few words that pass between the interrupt and main, whole or not at all.

use core::sync::atomic::{AtomicU32, Ordering, fence};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A place for the newest letter; one that nobody took is lost to the next.
///
/// One side writes, the other reads, and on one core one of them is the interrupt. Where the interrupt reads, it may
/// find main in the middle of writing, which an odd stamp says; where it writes, main finds that the stamp has moved
/// while it read. Either way the reader takes nothing, and looks again later: nobody waits.
#[derive(Debug)]
pub struct Letter<const WORDS: usize> {
    stamp: AtomicU32,
    taken: AtomicU32,
    words: [AtomicU32; WORDS],
}

impl<const WORDS: usize> Letter<WORDS> {
    /// None yet.
    pub const fn new() -> Self {
        Self { stamp: AtomicU32::new(0), taken: AtomicU32::new(0), words: [const { AtomicU32::new(0) }; WORDS] }
    }

    /// Writes one.
    pub fn put(&self, words: [u32; WORDS]) {
        let stamp = self.stamp.load(Ordering::Relaxed);
        self.stamp.store(stamp.wrapping_add(1), Ordering::Relaxed);
        fence(Ordering::Release);
        for (place, word) in self.words.iter().zip(words) {
            place.store(word, Ordering::Relaxed);
        }
        self.stamp.store(stamp.wrapping_add(2), Ordering::Release);
    }

    /// The newest one, unless it was taken before or is being written.
    pub fn take(&self) -> Option<[u32; WORDS]> {
        let stamp = self.stamp.load(Ordering::Acquire);
        if stamp & 1 == 1 || stamp == self.taken.load(Ordering::Relaxed) {
            return None;
        }
        let mut words = [0; WORDS];
        for (word, place) in words.iter_mut().zip(&self.words) {
            *word = place.load(Ordering::Relaxed);
        }
        fence(Ordering::Acquire);
        if self.stamp.load(Ordering::Relaxed) != stamp {
            return None;
        }
        self.taken.store(stamp, Ordering::Relaxed);
        Some(words)
    }

    /// Writes a message that fits; one that does not is lost.
    pub fn put_message(&self, message: &impl Serialize) {
        let mut bytes = [[0; 4]; WORDS];
        if postcard::to_slice(message, bytes.as_flattened_mut()).is_ok() {
            self.put(bytes.map(u32::from_le_bytes));
        }
    }

    /// The newest message, as [`Self::take`] has it.
    pub fn take_message<M: DeserializeOwned>(&self) -> Option<M> {
        let bytes = self.take()?.map(u32::to_le_bytes);
        postcard::from_bytes(bytes.as_flattened()).ok()
    }
}
