//! Exact curves and surfaces as polynomials within a tolerance.

mod curve;
mod least_squares;
mod patch;

pub use curve::{FittedCurve, fit_curve};
pub use patch::fit_patch;
