//! The paper's first-order laws, its limits of performance, and pairs of patches (Theorem 2).
//!
//! Nothing here runs in a loop with [`Controller::SecondOrder`](super::Controller::SecondOrder), the default: these are
//! for comparison with the paper, and for pairs of patches.

mod feed_forward;
mod first_order;
mod integrator;
mod laws;
mod limits;
mod pair;

pub use first_order::{FirstOrder, FirstOrderError};
pub use laws::{FeedForward, Gain, Integrator, Law};
pub use limits::PerformanceLimits;
pub use pair::{CommonNormalStep, CommonNormalTracker, PairStep, PairTracker, PairWitness};
