//! Frames between the device and a host.
//!
//! A frame is `COBS(postcard(message) · CRC-32) · 0x00`. [`frame`] packs and unpacks, [`Sensors`] goes to the device and
//! [`Report`] comes back; one of each a tick.
//!
//! In lockstep the host sends the sensors of tick `n`, the device answers with the report of tick `n`, and only then
//! comes `n + 1`. A host that has nothing to say in a tick sends an empty frame, so that the device need not wait.

pub mod frame;
mod message;
mod report;
pub use message::{Report, Sensors};
