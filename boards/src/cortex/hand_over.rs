//! The loop on its way from main, which makes it, to the interrupt, which owns it.

use core::cell::Cell;
use critical_section::Mutex;

/// The place where it lies meanwhile.
pub struct HandOver<T>(Mutex<Cell<Option<T>>>);

impl<T> HandOver<T> {
    /// Empty.
    pub const fn new() -> Self {
        Self(Mutex::new(Cell::new(None)))
    }

    /// Lays it there. The interrupt is unmasked after.
    pub fn give(&self, value: T) {
        critical_section::with(|section| self.0.borrow(section).set(Some(value)));
    }

    /// Takes it, at the first interrupt: from then on no lock is needed.
    pub fn take(&self) -> Option<T> {
        critical_section::with(|section| self.0.borrow(section).take())
    }
}

impl<T> Default for HandOver<T> {
    fn default() -> Self {
        Self::new()
    }
}
