//! The program's copies in RAM against their images in flash.

use core::hint::black_box;
use core::ptr::read_volatile;

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

/// The check of all copies, in turn. A word that changed in either place is found with the next pass.
#[derive(Debug)]
pub struct ProgramCheck<const COPIES: usize> {
    copies: [ProgramCopy; COPIES],
    copy: usize,
    at: usize,
}

impl<const COPIES: usize> ProgramCheck<COPIES> {
    /// The check of these copies.
    pub const fn new(copies: [ProgramCopy; COPIES]) -> Self {
        Self { copies, copy: 0, at: 0 }
    }

    /// The first pass, before anything is driven.
    pub fn all(&mut self) {
        while self.step() {}
    }

    /// A turn of main: compares a word; false after the last of all. A program that changed panics: the motors are off
    /// at once.
    pub fn step(&mut self) -> bool {
        let Some(&ProgramCopy { start, end, image }) = self.copies.get(self.copy) else {
            (self.copy, self.at) = (0, 0);
            return false;
        };
        let word = start.wrapping_add(self.at);
        if word >= end {
            (self.copy, self.at) = (self.copy + 1, 0);
            return true;
        }
        // SAFETY: within the copy and its image, as promised above.
        let is_same = unsafe { read_volatile(word) == read_volatile(image.wrapping_add(self.at)) };
        assert!(is_same, "the program in RAM differs from its image");
        self.at += 1;
        true
    }
}
