//! Flash for a feel of a knob that a host has set.

use crate::Mailbox;
use crate::writing::Word;
use palpate::render::Feel;
use palpate::wire::{Answer, KeepError, KeptFeel, Refused};

/// Flash for one feel. Main writes it, while the tick holds the motors off.
pub trait Feels {
    /// The outcome for the stored one at the last reset.
    fn in_use(&self) -> KeptFeel;

    /// Keeps a feel, or forgets the one that is kept; used from the next reset on.
    ///
    /// # Errors
    /// Flash that fails.
    fn keep(&self, feel: Option<&Feel>) -> Result<(), KeepError>;
}

/// Main's side of it.
pub(crate) struct FeelKeeping<'a> {
    /// Where it is kept.
    pub flash: Option<&'a dyn Feels>,
    /// The newest that was set.
    set: Option<Feel>,
    /// The request that waits for the tick's permission to write.
    asked: Option<(u16, bool)>,
    /// The answer to the last one: it is not written again where it comes again, because the answer was lost.
    last: Option<Answer>,
}

impl FeelKeeping<'_> {
    pub const fn nothing() -> Self {
        Self { flash: None, set: None, asked: None, last: None }
    }

    /// Whether something waits for the tick.
    pub const fn is_asked(&self) -> bool {
        self.asked.is_some()
    }

    pub fn kept(&self) -> KeptFeel {
        self.flash.map_or(KeptFeel::None, Feels::in_use)
    }

    /// Another host counts from the start.
    pub const fn forget_answer(&mut self) {
        self.last = None;
    }

    /// A request that came; its answer, unless the tick has to be asked first.
    pub fn take(&mut self, number: u16, keeps: bool, mailbox: &Mailbox) -> Option<Answer> {
        if let Some(last) = self.last.filter(|last| last.number == number) {
            return Some(last);
        }
        self.set = mailbox.take_feel().or(self.set);
        if self.flash.is_none() {
            return Some(answer(number, Err(KeepError::NoFlash)));
        }
        if keeps && self.set.is_none() {
            return Some(answer(number, Err(KeepError::NoFeel)));
        }
        // Something else that is being kept has the word.
        if mailbox.writing().word() != Word::Free {
            return Some(Answer { number, refused: Some(Refused::Busy) });
        }
        self.asked = Some((number, keeps));
        mailbox.writing().ask();
        None
    }

    /// Applies the tick's answer. Written here at once, whole: nobody is waited for while the motors are held off.
    pub fn wait(&mut self, mailbox: &Mailbox) -> Option<Answer> {
        let (number, keeps) = self.asked?;
        let kept = match mailbox.writing().word() {
            Word::Asked | Word::AskedInSetUp => return None,
            Word::Granted => {
                let feel = self.set.filter(|_| keeps);
                self.flash.map_or(Err(KeepError::NoFlash), |flash| flash.keep(feel.as_ref()))
            }
            Word::NotConfirmed => Err(KeepError::NotConfirmed),
            Word::Worn => Err(KeepError::Worn),
            Word::NotSetUp | Word::Denied | Word::Free => Err(KeepError::Driven),
        };
        mailbox.writing().end();
        self.asked = None;
        self.last = Some(answer(number, kept));
        self.last
    }
}

fn answer(number: u16, kept: Result<(), KeepError>) -> Answer {
    Answer { number, refused: kept.err().map(Refused::Feel) }
}
