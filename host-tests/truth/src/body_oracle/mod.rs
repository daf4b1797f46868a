//! Bodies on the host: the truth in double precision, and which features claim a probe.

mod claims;
mod truth;
mod winding;

pub use claims::{Claims, claims};
pub use truth::{BodyOracle, Truth};
pub use winding::{segment_distance, triangle_distance, winding_number};
