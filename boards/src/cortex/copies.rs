//! The program's copies in RAM and their images in flash, as they lie in memory.

use crate::program_check::{self, Copied};
use core::hint::black_box;
use core::ptr::read_volatile;

/// The check of the program's copies. A program that changed panics: the motors are off at once.
#[derive(Debug)]
pub struct ProgramCheck<const COPIES: usize>(program_check::ProgramCheck<ProgramCopy, COPIES>);

impl<const COPIES: usize> ProgramCheck<COPIES> {
    /// The check of these copies.
    pub const fn new(copies: [ProgramCopy; COPIES]) -> Self {
        Self(program_check::ProgramCheck::new(copies))
    }

    /// The first pass, before anything is driven.
    pub fn all(&mut self) {
        while self.step() {}
    }

    /// A turn of main: compares a word; false after the last of all.
    pub fn step(&mut self) -> bool {
        match self.0.step() {
            Ok(goes_on) => goes_on,
            Err(wrong) => panic!("{wrong}"),
        }
    }
}

/// A copy in RAM, and the image that it was made of.
#[derive(Clone, Copy, Debug)]
pub struct ProgramCopy {
    start: *const u32,
    end: *const u32,
    image: *const u32,
}

impl ProgramCopy {
    /// The words from `start` to `end`, and as many from `image` on.
    ///
    /// # Safety
    /// All of them can be read, and nothing writes to them.
    pub unsafe fn new(start: *const u32, end: *const u32, image: *const u32) -> Self {
        // The compiler must not take a linker's symbol for a variable of one word.
        let [start, end, image] = black_box([start, end, image]);
        Self { start, end, image }
    }
}

impl Copied for ProgramCopy {
    #[inline]
    fn words(&self, at: usize) -> Option<[u32; 2]> {
        let word = self.start.wrapping_add(at);
        // SAFETY: within the copy and its image, as promised above.
        (word < self.end).then(|| unsafe { [read_volatile(word), read_volatile(self.image.wrapping_add(at))] })
    }
}
