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

    /// Somebody has chosen what is felt, of a table of at most 256 ([`palpate::servo::Event::Chosen`]). Call it from
    /// one place only.
    pub fn choose(&self, index: u8) {
        self.commands.fetch_and(!(0xff << CHOSEN_SHIFT), Ordering::Relaxed);
        self.commands.fetch_or(CHOSEN | u32::from(index) << CHOSEN_SHIFT, Ordering::Relaxed);
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

    /// What was chosen.
    pub const fn chosen(self) -> Option<u8> {
        if self.0 & CHOSEN != 0 { Some((self.0 >> CHOSEN_SHIFT) as u8) } else { None }
    }
}

/// Something was chosen, and where its number lies; the commands' own bits are far below.
const CHOSEN: u32 = 1 << 31;
const CHOSEN_SHIFT: u32 = 16;

const fn bit(command: Command) -> u32 {
    1 << command as u32
}
