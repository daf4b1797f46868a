//! Flash for what commissioning found.

use crate::Mailbox;
use crate::writing::Word;
use palpate::commission::JointCalibration;
use palpate::wire::{Answer, Calibrated, KeepError, Refused};

/// Flash for one calibration. Main writes it, while the tick holds the motors off.
pub trait Calibrations {
    /// Which one the loop was made with.
    fn in_use(&self) -> Calibrated;

    /// Keeps a calibration, or forgets the one that is kept; used from the next reset on. It takes as long as a page of
    /// flash takes to be erased.
    ///
    /// # Errors
    /// A calibration that cannot be this device's, which leaves the stored one as it is; flash that fails.
    fn keep(&self, joints: Option<&[JointCalibration; 3]>) -> Result<(), KeepError>;
}

/// The request and its number.
type Asked = (u16, Option<[JointCalibration; 3]>);

/// Main's side of it.
pub(crate) struct Calibrating<'a> {
    /// Where it is kept.
    pub flash: Option<&'a dyn Calibrations>,
    /// The request that waits for the tick's permission to write.
    asked: Option<Asked>,
    /// The answer to the last one: it is not written again where it comes again, because the answer was lost.
    last: Option<Answer>,
}

impl<'a> Calibrating<'a> {
    pub const fn nothing() -> Self {
        Self { flash: None, asked: None, last: None }
    }

    /// Whether something waits for the tick.
    pub const fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    /// The answer that the one of this number was given, if it was the last.
    pub fn answered(&self, number: u16) -> Option<Answer> {
        self.last.filter(|last| last.number == number)
    }

    /// Another host counts from the start.
    pub const fn forget_answer(&mut self) {
        self.last = None;
    }

    /// A calibration that came; its answer, unless the tick has to be asked first.
    pub fn take(&mut self, (number, joints): Asked, mailbox: &Mailbox) -> Option<Answer> {
        if self.flash.is_none() {
            return Some(answer(number, Err(KeepError::NoFlash)));
        }
        // A body that is being kept has the word.
        if matches!(mailbox.writing().word(), Word::Asked | Word::Granted) {
            return Some(Answer { number, refused: Some(Refused::Busy) });
        }
        self.asked = Some((number, joints));
        mailbox.writing().ask_in_set_up();
        None
    }

    /// Applies the tick's answer. Written here at once, whole: nobody is waited for while the motors are held off.
    pub fn wait(&mut self, mailbox: &Mailbox) -> Option<Answer> {
        let (number, joints) = self.asked?;
        let kept = match mailbox.writing().word() {
            Word::AskedInSetUp => return None,
            Word::Granted => self.flash.map_or(Err(KeepError::NoFlash), |flash| flash.keep(joints.as_ref())),
            Word::NotSetUp => Err(KeepError::NotSetUp),
            Word::NotConfirmed => Err(KeepError::NotConfirmed),
            Word::Worn => Err(KeepError::Worn),
            Word::Denied | Word::Free | Word::Asked => Err(KeepError::Driven),
        };
        mailbox.writing().end();
        self.asked = None;
        self.last = Some(answer(number, kept));
        self.last
    }
}

fn answer(number: u16, kept: Result<(), KeepError>) -> Answer {
    Answer { number, refused: kept.err().map(Refused::Calibration) }
}
