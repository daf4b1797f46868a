//! What the controller is compared with, in double precision: closest points by Newton's method, which needs second
//! derivatives and a start near the answer.

mod error_kinematics;
mod newton;
mod projected;

pub use error_kinematics::ErrorKinematics;
pub use newton::{Advance, Baseline, Errors, Method};
