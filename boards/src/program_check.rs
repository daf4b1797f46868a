//! The program's copies in RAM against their images in flash, word by word.

use thiserror::Error;

/// A copy of a part of the program in RAM, and the image that it was made of.
pub trait Copied {
    /// A word of the copy, and of its image; `None` past the end.
    fn words(&self, at: usize) -> Option<[u32; 2]>;
}

/// A word changed in either place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the program in RAM differs from its image")]
pub struct ProgramChanged;

/// The check of all copies, in turn. A word that changed in either place is found with the next pass.
#[derive(Debug)]
pub struct ProgramCheck<C, const COPIES: usize> {
    copies: [C; COPIES],
    copy: usize,
    at: usize,
}

impl<C: Copied, const COPIES: usize> ProgramCheck<C, COPIES> {
    /// The check of these copies.
    pub const fn new(copies: [C; COPIES]) -> Self {
        Self { copies, copy: 0, at: 0 }
    }

    /// A turn of main: compares a word; false after the last of all.
    ///
    /// # Errors
    /// The program changed.
    #[inline]
    pub fn step(&mut self) -> Result<bool, ProgramChanged> {
        let Some(copy) = self.copies.get(self.copy) else {
            (self.copy, self.at) = (0, 0);
            return Ok(false);
        };
        let Some([word, image]) = copy.words(self.at) else {
            (self.copy, self.at) = (self.copy + 1, 0);
            return Ok(true);
        };
        self.at += 1;
        if word == image { Ok(true) } else { Err(ProgramChanged) }
    }
}
