//! Flash is written only while the tick keeps the motors off.

use core::sync::atomic::{AtomicU32, Ordering};

/// Main asks, the tick answers, main says when it is done. Only main writes [`Word::Free`] and what it asks, only the
/// tick, which main cannot interrupt, turns a request into one of the others.
#[derive(Debug)]
pub(crate) struct Writing(AtomicU32);

/// The last state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Word {
    /// Nothing is to be written.
    Free = 0,
    /// Main wants to write.
    Asked = 1,
    /// The motors are off, and stay so until main is done.
    Granted = 2,
    /// They are driven, or somebody asks for force.
    Denied = 3,
    /// Main wants to write what only a device that is being set up may.
    AskedInSetUp = 4,
    /// It is to be set up first.
    NotSetUp = 5,
    /// Nobody confirmed it.
    NotConfirmed = 6,
    /// It was written too often since the reset.
    Worn = 7,
}

impl Writing {
    pub const fn new() -> Self {
        Self(AtomicU32::new(Word::Free as u32))
    }

    pub fn word(&self) -> Word {
        // Writes after the grant stay after it.
        match self.0.load(Ordering::Acquire) {
            1 => Word::Asked,
            2 => Word::Granted,
            3 => Word::Denied,
            4 => Word::AskedInSetUp,
            5 => Word::NotSetUp,
            6 => Word::NotConfirmed,
            7 => Word::Worn,
            _ => Word::Free,
        }
    }

    /// Whether main may be writing.
    pub fn is_granted(&self) -> bool {
        self.word() == Word::Granted
    }

    /// Main wants to write.
    pub fn ask(&self) {
        self.0.store(Word::Asked as u32, Ordering::Relaxed);
    }

    /// Main wants to write what only a device that is being set up may.
    pub fn ask_in_set_up(&self) {
        self.0.store(Word::AskedInSetUp as u32, Ordering::Relaxed);
    }

    /// Main is done, or no longer wants to.
    pub fn end(&self) {
        self.0.store(Word::Free as u32, Ordering::Release);
    }

    /// The tick's answer.
    pub fn put(&self, answer: Word) {
        self.0.store(answer as u32, Ordering::Relaxed);
    }

    /// Why the tick refuses what main asks for; `None` if a person may confirm it.
    #[inline]
    pub fn refusal(&self, is_quiet: bool, is_set_up: bool) -> Option<Word> {
        match (self.word(), is_set_up) {
            _ if !is_quiet => Some(Word::Denied),
            (Word::Asked, true) => Some(Word::Denied),
            (Word::AskedInSetUp, false) => Some(Word::NotSetUp),
            _ => None,
        }
    }
}
