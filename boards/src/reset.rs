//! Why the chip was reset: its flags, and a memo that outlives a reset.

use palpate::servo::ResetReason;

/// A memo for after the next reset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Cause {
    /// The loop was running.
    Running = 1,
    /// It panicked.
    Panic = 2,
    /// An exception, an NMI or an interrupt that nobody waits for came.
    Exception = 3,
}

/// Two words in memory that a reset leaves alone and that power-on fills with anything: the second is the complement of
/// the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Memo(pub [u32; 2]);

const MARK: u32 = 0x70a1_9a00;

impl Memo {
    /// Says nothing: written as soon as it was read, lest it be believed twice.
    pub const EMPTY: Self = Self([0; 2]);

    /// The memo of a cause.
    pub const fn new(cause: Cause) -> Self {
        let word = MARK | cause as u32;
        Self([word, !word])
    }

    /// Its cause, if it is a memo.
    pub const fn cause(self) -> Option<Cause> {
        let [word, complement] = self.0;
        if word != !complement || word & !0xff != MARK {
            return None;
        }
        match word & 0xff {
            1 => Some(Cause::Running),
            2 => Some(Cause::Panic),
            3 => Some(Cause::Exception),
            _ => None,
        }
    }
}

/// The chip's flags, as far as it has them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ResetFlags {
    /// The supply came up: at power-on, or after a brown-out that the chip cannot tell from it.
    pub power: bool,
    /// A brown-out for sure.
    pub brown_out: bool,
    /// A watchdog, or a core that locked up.
    pub watchdog: bool,
    /// A tool that resets by way of the watchdog left its mark.
    pub tool: bool,
    /// The program asked for it, or a debugger.
    pub software: bool,
    /// The reset pin. Many chips raise it along with every other.
    pub pin: bool,
}

impl ResetFlags {
    /// The reason. Where the supply came up and the memo is still there, it was away for too short a time to be
    /// switched off: a brown-out. (A switch that is flicked off and on within the moment in which memory fades looks
    /// the same, and is acknowledged the same way.)
    pub const fn reason(self, memo: Memo) -> ResetReason {
        let cause = memo.cause();
        if self.tool {
            ResetReason::Tool
        } else if self.watchdog {
            match cause {
                Some(Cause::Panic) => ResetReason::Panic,
                Some(Cause::Exception) => ResetReason::Exception,
                Some(Cause::Running) | None => ResetReason::Watchdog,
            }
        } else if self.brown_out || (self.power && cause.is_some()) {
            ResetReason::BrownOut
        } else if self.power {
            ResetReason::PowerOn
        } else if self.software {
            ResetReason::Software
        } else if self.pin {
            ResetReason::Pin
        } else {
            ResetReason::Unknown
        }
    }
}
