//! The truth to compare with, in double precision and by other means than the library's: basis functions instead of
//! stored polynomials, many starts and Newton's method instead of the controller.

mod basis;
mod closest;
pub mod golden;
mod point;

pub use closest::{ClosestPoint, Oracle};
pub use point::OraclePoint;
