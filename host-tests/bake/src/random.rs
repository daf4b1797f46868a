//! Numbers from a seed, the same on every machine.

use glam::DVec3;
use rand::{Rng as _, SeedableRng as _};
use rand_pcg::Pcg64;

/// A seeded source of numbers.
#[derive(Clone, Debug)]
pub struct Random(Pcg64);

impl Random {
    /// The source of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// A number in `[low, high)`, evenly spread. 53 bits of our own, so that the sequence does not hang on another
    /// library's choice.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A number in `[low, high)` whose logarithm is evenly spread.
    pub fn scale(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.0.next_u64() % end as u64) as usize
    }

    /// Whether something of this probability happens.
    pub fn happens(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }

    /// A direction, evenly spread over the sphere.
    pub fn direction(&mut self) -> DVec3 {
        let (turn, height) = (self.between(0.0, std::f64::consts::TAU), self.between(-1.0, 1.0));
        let radius = (1.0 - height * height).sqrt();
        DVec3::new(radius * turn.cos(), radius * turn.sin(), height)
    }

    /// Three orthonormal, right-handed axes.
    pub fn axes(&mut self) -> [DVec3; 3] {
        let first = self.direction();
        let second = first.any_orthonormal_vector();
        let turn = self.between(0.0, std::f64::consts::TAU);
        let second = second * turn.cos() + first.cross(second) * turn.sin();
        [first, second, first.cross(second)]
    }
}
