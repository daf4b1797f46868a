//! Flash is written only while the tick keeps the motors off.

use core::sync::atomic::{AtomicU32, Ordering};

/// Main asks, the tick answers, main says when it is done. Only main writes [`Word::Free`] and [`Word::Asked`], only
/// the tick, which main cannot interrupt, makes of the second one of the others.
#[derive(Debug)]
pub(crate) struct Writing(AtomicU32);

/// What was said last.
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
}

impl Writing {
    pub const fn new() -> Self {
        Self(AtomicU32::new(Word::Free as u32))
    }

    pub fn word(&self) -> Word {
        // What is written after the grant is written after it.
        match self.0.load(Ordering::Acquire) {
            1 => Word::Asked,
            2 => Word::Granted,
            3 => Word::Denied,
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

    /// Main is done, or no longer wants to.
    pub fn end(&self) {
        self.0.store(Word::Free as u32, Ordering::Release);
    }

    /// The tick's answer, if it is asked; and whether the motors have to stay off.
    #[inline]
    pub fn answer(&self, is_quiet: bool) -> bool {
        let word = self.word();
        if word != Word::Asked {
            return word == Word::Granted;
        }
        let answer = if is_quiet { Word::Granted } else { Word::Denied };
        self.0.store(answer as u32, Ordering::Relaxed);
        is_quiet
    }
}
