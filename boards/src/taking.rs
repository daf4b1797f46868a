//! Bodies on their way from the line into RAM or flash.

use crate::writing::Word;
use crate::{Mailbox, Uploads};
use palpate::wire::{Answer, Refused, Upload, UploadError};

/// Seconds without a part after which the motors are no longer held off for flash. A host that has died keeps nobody
/// from force.
const PATIENCE_S: f32 = 5.0;

/// Where the parts go that come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Into {
    Memory,
    Flash,
    /// The transfer was abandoned.
    Nowhere,
}

/// Main's side of it.
pub(crate) struct Taking<'a> {
    /// RAM.
    pub memory: Option<&'a dyn Uploads>,
    /// Flash.
    pub flash: Option<&'a dyn Uploads>,
    into: Into,
    /// A body that is to be kept, by its part's number and its bytes, until the tick says whether the motors are off.
    asked: Option<(u16, u32)>,
    /// The tick of the last part while the motors are held off.
    held: Option<u32>,
    /// [`PATIENCE_S`], ticks.
    patience: u32,
    /// The outcome of the last end in flash, which may be asked for again: its answer may have been lost.
    ended: Option<Result<(), UploadError>>,
}

impl<'a> Taking<'a> {
    pub const fn nothing() -> Self {
        Self { memory: None, flash: None, into: Into::Memory, asked: None, held: None, patience: 20_000, ended: None }
    }

    /// The loop's rate, Hz; before, 4 kHz.
    pub const fn wait_at(&mut self, rate: f32) {
        // The cast saturates.
        self.patience = (PATIENCE_S * rate) as u32;
    }

    pub fn kept(&self) -> u32 {
        self.flash.map_or(0, Uploads::kept)
    }

    /// A part; its answer, unless the tick has to be asked first.
    pub fn take(&mut self, number: u16, part: &Upload, mailbox: &Mailbox, pause: &mut dyn FnMut()) -> Option<Answer> {
        let put = match *part {
            Upload::Keep { .. } if self.flash.is_none() => Err(UploadError::NoFlash),
            // The tick is asked already: its answer is on its way.
            Upload::Keep { .. } if self.asked.is_some_and(|(asked, _)| asked == number) => return None,
            Upload::Keep { bytes } => {
                if self.held.is_some() {
                    self.begin_to_keep(bytes, mailbox, pause)
                } else {
                    self.asked = Some((number, bytes));
                    mailbox.writing().ask();
                    return None;
                }
            }
            Upload::Begin { .. } => {
                self.let_go(mailbox);
                self.into = Into::Memory;
                self.put(part, pause)
            }
            Upload::Bytes { .. } => self.put(part, pause),
            Upload::End => {
                let put = self.put(part, pause);
                if self.held.is_some() {
                    self.ended = Some(put);
                }
                // Whatever came of it, unless some of it is still to come.
                if !matches!(put, Err(UploadError::Order { .. })) {
                    self.let_go(mailbox);
                }
                put
            }
        };
        if self.held.is_some() {
            self.held = Some(mailbox.ticks());
        }
        Some(Answer { number, refused: put.err().map(Refused::Upload) })
    }

    /// Applies the tick's answer to a body that is to be stored. Ends abandoned transfers.
    pub fn wait(&mut self, mailbox: &Mailbox, pause: &mut dyn FnMut()) -> Option<Answer> {
        if let Some(last) = self.held
            && mailbox.ticks().wrapping_sub(last) > self.patience
        {
            self.let_go(mailbox);
            self.into = Into::Nowhere;
        }
        let (number, bytes) = self.asked?;
        let put = match mailbox.writing().word() {
            Word::Asked | Word::AskedInSetUp => return None,
            Word::Granted => {
                self.held = Some(mailbox.ticks());
                self.begin_to_keep(bytes, mailbox, pause)
            }
            refused => {
                mailbox.writing().end();
                Err(match refused {
                    Word::NotConfirmed => UploadError::NotConfirmed,
                    Word::Worn => UploadError::Worn,
                    _ => UploadError::Driven,
                })
            }
        };
        self.asked = None;
        Some(Answer { number, refused: put.err().map(Refused::Upload) })
    }

    fn begin_to_keep(&mut self, bytes: u32, mailbox: &Mailbox, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        (self.into, self.ended) = (Into::Flash, None);
        // An upload that was not taken must not be taken in its place.
        if let Some(memory) = self.memory {
            let _ = memory.put(&Upload::Begin { bytes: 0 }, pause);
        }
        let put = self.put(&Upload::Begin { bytes }, pause);
        if put.is_err() || bytes == 0 {
            self.let_go(mailbox);
        }
        put
    }

    fn put(&self, part: &Upload, pause: &mut dyn FnMut()) -> Result<(), UploadError> {
        match self.into {
            Into::Memory => self.memory.map_or(Err(UploadError::NoRoom), |memory| memory.put(part, pause)),
            // Never but while the tick holds the motors off.
            Into::Flash if self.held.is_some() => {
                self.flash.map_or(Err(UploadError::NoFlash), |flash| flash.put(part, pause))
            }
            Into::Flash if *part == Upload::End => self.ended.unwrap_or(Err(UploadError::NotBegun)),
            Into::Flash | Into::Nowhere => Err(UploadError::NotBegun),
        }
    }

    /// The motors need no longer be off.
    fn let_go(&mut self, mailbox: &Mailbox) {
        (self.held, self.asked) = (None, None);
        mailbox.writing().end();
    }
}
