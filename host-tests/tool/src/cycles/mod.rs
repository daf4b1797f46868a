//! Estimated cycles of the hot path on cores that the emulator does not time: each instruction that was executed, in
//! its order, through a stated model of the core.
//!
//! An estimate, not a measurement: the emulator executes the right instructions but models no pipeline. The result is a
//! range that should contain the cycles of a real core with code and tables in memory without wait states.

mod model;
mod trace;

pub use model::{Core, Cycles};
pub use trace::{TraceError, estimate};

use crate::spread::Spread;

/// A function of the program that counts, and what a call of it is called.
#[derive(Clone, Copy, Debug)]
pub struct Root {
    /// The function.
    pub function: &'static str,
    /// Name of a call in the table.
    pub title: &'static str,
    /// Number of first calls to skip.
    pub skip: usize,
    /// Number of calls to follow.
    pub take: usize,
}

/// The functions of the program that counts are not inlined; the library's may be.
const EVALUATE: &str = "palpate_emulated::budget::evaluation::evaluate";

/// The whole tick of a loop.
pub const SERVO: Root =
    Root { function: "palpate_emulated::budget::servo::tick", title: "servo tick", skip: 0, take: 20_000 };

/// Called in a tick of a soft body in contact, and in no other.
const PUSH: &str = "palpate::servo::soft::SoftBody::press";

/// Loops that have an image of their own: its feature, and what a tick is called; on the foam box where that is soft.
pub const LOOPS: [(&str, &str); 6] = [
    ("counted", "servo tick, protected"),
    ("folded", "servo tick, folded back"),
    ("smooth", "servo tick, smooth"),
    ("soft", "servo tick, 1 mode"),
    ("soft-four", "servo tick, 4 modes"),
    ("soft-eight", "servo tick, 8 modes"),
];

/// The estimated calls. The program first evaluates patches of degree 1 to 5, polynomial, then rational.
pub const ROOTS: [Root; 5] = [
    Root { function: EVALUATE, title: "evaluation, degree (2, 2)", skip: 1, take: 1 },
    Root { function: EVALUATE, title: "evaluation, degree (3, 3)", skip: 2, take: 1 },
    Root { function: "palpate_emulated::budget::step::step", title: "step on one patch", skip: 0, take: 20_000 },
    Root {
        function: "palpate_emulated::budget::closest::tick",
        title: "closest point of a body",
        skip: 0,
        take: 5_000,
    },
    SERVO,
];

/// Instructions and cycles of the calls of a root.
#[derive(Clone, Debug, Default)]
pub struct Calls {
    /// Instructions executed in each call.
    pub instructions: Vec<u32>,
    /// Cycles of each call, at the lower and the upper end of the range.
    pub cycles: [Vec<u32>; 2],
    /// Whether a soft body pushed back in it.
    pub is_pushed: Vec<bool>,
}

impl Calls {
    /// The calls in which a soft body pushed back, or those in which none did.
    #[must_use]
    pub fn which(&self, pushed: bool) -> Self {
        let of = |values: &[u32]| {
            values.iter().zip(&self.is_pushed).filter(|(_, is)| **is == pushed).map(|(value, _)| *value).collect()
        };
        let [low, high] = &self.cycles;
        Self {
            instructions: of(&self.instructions),
            cycles: [of(low), of(high)],
            is_pushed: self.is_pushed.iter().copied().filter(|is| *is == pushed).collect(),
        }
    }
}

/// A figure of the table: median and maximum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Figure {
    /// The lower median.
    pub median: u32,
    /// The maximum.
    pub worst: u32,
}

impl Figure {
    /// Of at least one value.
    pub fn of(values: &[u32]) -> Option<Self> {
        Spread::of(values).map(|Spread { median, worst, .. }| Self { median, worst })
    }
}
