//! The loop's interface to a board.

use crate::sensors::BadFrame;
use palpate::device::drive::Field;
use palpate::device::{Counts, Duty};
use thiserror::Error;

/// The user's inputs in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Panel {
    /// Force is asked for.
    pub enable: bool,
    /// The two channels of the enable input differ ([`crate::TwoChannels`]).
    pub enable_disagrees: bool,
    /// Stop is pressed, or its wire is broken.
    pub stop: bool,
    /// Every amplifier says that it is ready.
    pub ready: bool,
    /// The motors' supply, V; `None` where it is not or cannot be measured.
    pub supply: Option<f32>,
}

/// A drive, or a pin of it, that failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("a drive did not follow its command")]
pub struct NotObeyed;

/// A board whose motors cannot be driven: through this alone nothing reaches a motor but the word to let go.
pub trait Passive<const JOINTS: usize> {
    /// The free-running counter: it rises, and wraps at 32 bits. No debugger stops it.
    fn now(&self) -> u32;

    /// Takes the timer's interrupt back, so that the next period can raise it again.
    fn acknowledge(&mut self);

    /// The user's inputs.
    fn panel(&mut self) -> Panel;

    /// The joints' counts.
    ///
    /// # Errors
    /// A frame that did not come, or that cannot be believed.
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame>;

    /// The counts at which the inputs' index marks were passed since this was asked last, after a good reading. None of
    /// a board whose inputs have no marks.
    #[inline]
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        [None; JOINTS]
    }

    /// The automatic gain of each magnetic sensor, 255 in a weak field; 0 of a sensor without one.
    #[inline]
    fn gains(&self) -> [u8; JOINTS] {
        [0; JOINTS]
    }

    /// Disables the drives. Tries every pin, whatever fails.
    ///
    /// # Errors
    /// A drive that failed.
    fn release(&mut self) -> Result<(), NotObeyed>;

    /// Whether the pin of a line that enables a drive reads as on, whatever was written to it; false where a board
    /// cannot read it. The loop asks in the tick after a release: a line that is on then is a fault of the drives,
    /// before the first force too.
    #[inline]
    fn reads_enabled(&self) -> bool {
        false
    }

    /// The light, on or off.
    fn show(&mut self, lit: bool);
}

/// A board, as the loop sees it.
pub trait Board<const JOINTS: usize>: Passive<JOINTS> {
    /// The fields of the motors for the duties that follow. A board whose motors have no phases takes no
    /// notice.
    fn aim(&mut self, _: [Field; JOINTS]) {}

    /// Enables the drives and gives them these duties.
    ///
    /// # Errors
    /// A drive that failed. The others have been set.
    fn drive(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed>;
}
