//! Numbers from a seed, the same on every machine.

use rand::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// A seeded source of numbers.
#[derive(Clone, Debug)]
pub(crate) struct Random(Pcg64);

impl Random {
    /// The source of a seed.
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// A number in `[low, high)`, evenly spread. 53 bits of our own, so that the sequence does not hang on another
    /// library's choice.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64)
    }
}
