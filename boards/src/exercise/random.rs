//! Seeded numbers, the same on every machine.

/// Marsaglia's xorshift with shifts 13, 17 and 5 ("Xorshift RNGs", 2003).
#[derive(Clone, Copy, Debug)]
pub struct Random(u32);

impl Random {
    /// A sequence; a seed of 0 would stay 0 and is taken for 1.
    pub const fn new(seed: u32) -> Self {
        Self(if seed == 0 { 1 } else { seed })
    }

    /// The next number from 0 to `count` − 1, near enough evenly; 0 if there is none.
    pub fn below(&mut self, count: u32) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        // The high half of the product: no division.
        ((u64::from(self.0) * u64::from(count)) >> 32) as u32
    }
}
