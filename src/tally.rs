//! The work of a tick, in evaluations of tables, and its count on a host.
//!
//! With the feature `tally` each evaluation adds to a counter of its thread (`take`), for tests that compare ticks
//! with [`crate::body::Body::worst_tick`]. Without it, as on the target, nothing is compiled in.

/// Evaluations of a body's tables, by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TickWork {
    /// Points of patches, with their derivatives.
    pub patches: u32,
    /// Points of curves: edges and separators.
    pub curves: u32,
    /// Spokes of a vertex that a loop looks at.
    pub spokes: u32,
}

impl TickWork {
    /// One evaluation of each kind: the weights that count evaluations.
    pub const EACH: Self = Self { patches: 1, curves: 1, spokes: 1 };

    /// The sum of all kinds, each with its weight.
    #[must_use]
    pub const fn weighed(self, weights: Self) -> u32 {
        self.patches * weights.patches + self.curves * weights.curves + self.spokes * weights.spokes
    }

    /// Evaluations of any kind.
    #[must_use]
    pub const fn evaluations(self) -> u32 {
        self.weighed(Self::EACH)
    }

    /// The sum of two.
    pub(crate) const fn and(self, other: Self) -> Self {
        Self {
            patches: self.patches + other.patches,
            curves: self.curves + other.curves,
            spokes: self.spokes + other.spokes,
        }
    }
}

#[cfg(feature = "tally")]
mod counter {
    extern crate std;

    use super::TickWork;
    use core::cell::Cell;

    std::thread_local! {
        static WORK: Cell<TickWork> = const { Cell::new(TickWork { patches: 0, curves: 0, spokes: 0 }) };
    }

    pub fn add(work: TickWork) {
        WORK.set(WORK.get().and(work));
    }

    /// The evaluations of this thread since the last call.
    pub fn take() -> TickWork {
        WORK.take()
    }
}

#[cfg(feature = "tally")]
pub use counter::take;

/// Counts on a host; nothing on the target.
macro_rules! counted {
    ($name:ident, $kind:ident, $doc:literal) => {
        #[doc = $doc]
        #[inline(always)]
        pub(crate) fn $name() {
            #[cfg(feature = "tally")]
            counter::add(TickWork { $kind: 1, ..TickWork::default() });
        }
    };
}

counted!(patch, patches, "Counts the evaluation of a patch.");
counted!(curve, curves, "Counts the evaluation of a curve.");
counted!(spoke, spokes, "Counts a spoke that is looked at.");
