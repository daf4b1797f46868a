//! Bodies on the host: the truth in double precision, and which features claim a probe.

mod claims;
mod truth;

pub use claims::{Claims, claims};
pub use truth::{BodyOracle, Truth};
