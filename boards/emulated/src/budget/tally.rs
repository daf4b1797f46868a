//! The median and the worst of many counts, without keeping them all.

use semihosting::println;

/// Counts above this are all in the last bin.
const BINS: usize = 4_096;

/// Instructions of a bin: ticks of a soft body, of many bodies, of a tool with a shape and of a core without floats are
/// longer than there are bins.
const WIDTH: u32 = if cfg!(any(board = "m0", board = "riscv-imc", feature = "tool")) {
    32
} else if cfg!(any(feature = "soft", all(feature = "scene", target_arch = "riscv32"))) {
    4
} else {
    1
};

/// How often each count came.
pub struct Tally {
    times: [u32; BINS],
    largest: u32,
    total: u32,
}

impl Default for Tally {
    fn default() -> Self {
        Self::new()
    }
}

impl Tally {
    /// Nothing counted yet.
    pub const fn new() -> Self {
        Self { times: [0; BINS], largest: 0, total: 0 }
    }

    /// One more count.
    pub fn add(&mut self, instructions: u32) {
        let bin = ((instructions / WIDTH) as usize).min(BINS - 1);
        self.times[bin] += 1;
        self.largest = self.largest.max(instructions);
        self.total += 1;
    }

    /// The lower median; 0 of nothing.
    pub fn median(&self) -> u32 {
        let mut below = 0;
        for (bin, times) in self.times.iter().enumerate() {
            below += times;
            if 2 * below >= self.total && below > 0 {
                return bin as u32 * WIDTH;
            }
        }
        0
    }

    /// The same for one part of a figure.
    pub fn print_as(&self, of: &str, part: &str) {
        if self.total > 0 {
            println!("\"{of}, {part}, median\" = {}", self.median());
            println!("\"{of}, {part}, worst\" = {}", self.largest);
        }
    }

    /// Prints median and worst under this name. A figure that nothing reached is not printed: the host misses it.
    pub fn print(&self, name: &str) {
        if self.total > 0 {
            println!("\"{name}, median\" = {}", self.median());
            println!("\"{name}, worst\" = {}", self.largest);
        }
    }
}
