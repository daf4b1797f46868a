//! What passes between the interrupt and main.

use core::sync::atomic::{AtomicU32, Ordering};
use palpate::wire::Command;

/// A `static` of the board: the ticks done, for the watchdog, and the commands that came.
#[derive(Debug)]
pub struct Mailbox {
    ticks: AtomicU32,
    commands: AtomicU32,
}

/// Commands that came since they were looked at last. Each means the same once or twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Commands(u32);

impl Mailbox {
    /// Empty.
    pub const fn new() -> Self {
        Self { ticks: AtomicU32::new(0), commands: AtomicU32::new(0) }
    }

    pub(crate) fn tell_ticks(&self, ticks: u32) {
        self.ticks.store(ticks, Ordering::Relaxed);
    }

    pub(crate) fn ticks(&self) -> u32 {
        self.ticks.load(Ordering::Relaxed)
    }

    pub(crate) fn put(&self, command: Command) {
        self.commands.fetch_or(bit(command), Ordering::Relaxed);
    }

    pub(crate) fn take(&self) -> Commands {
        Commands(self.commands.swap(0, Ordering::Relaxed))
    }
}

impl Default for Mailbox {
    fn default() -> Self {
        Self::new()
    }
}

impl Commands {
    pub const fn has(self, command: Command) -> bool {
        self.0 & bit(command) != 0
    }
}

const fn bit(command: Command) -> u32 {
    1 << command as u32
}
