//! Ground truth for palpate, in double precision and by independent means: the oracle, surfaces whose truth is known by
//! construction, baselines of the controller, and golden points.

pub mod baselines;
pub mod body_oracle;
pub mod closest;
pub mod dunes;
pub mod generate;
pub mod locating;
pub mod lower_bound;
pub mod measured;
pub mod oracle;
pub mod rides;

/// The code in the documents: compiled and run with the doctests.
#[cfg(doctest)]
mod documents {
    #[doc = include_str!("../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../docs/howto/your-device.md")]
    struct YourDevice;
    #[doc = include_str!("../../../docs/howto/tool.md")]
    struct ShapedTool;
}
