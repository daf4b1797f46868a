//! Two body stores for one slot: RAM and flash.

use palpate::body::Body;
use palpate::scene::BodyStore;

/// Which of the two a bank is of.
const OTHER: u8 = 1 << 7;

/// Bodies of either; what waits in the first is taken first.
#[derive(Clone, Copy, Debug)]
pub struct Both<'a, A, B>(
    /// The first, of at most 128 banks.
    pub &'a A,
    /// The other, of at most 128 banks.
    pub &'a B,
);

impl<A: BodyStore, B: BodyStore> BodyStore for Both<'_, A, B> {
    fn take(&self) -> Option<u8> {
        self.0.take().or_else(|| self.1.take().map(|bank| bank | OTHER))
    }

    #[inline]
    fn body(&self, bank: u8) -> Option<&Body<'_>> {
        if bank & OTHER == 0 { self.0.body(bank) } else { self.1.body(bank & !OTHER) }
    }

    fn leave(&self, bank: u8) {
        if bank & OTHER == 0 {
            self.0.leave(bank);
        } else {
            self.1.leave(bank & !OTHER);
        }
    }
}
