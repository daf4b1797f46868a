//! Frames between the device and a host.
//!
//! A frame is `COBS(postcard(message) · CRC-32) · 0x00`. [`frame`] packs and unpacks, [`Sensors`] goes to the device and
//! [`Report`] comes back; one of each a tick.

pub mod frame;
mod message;
mod report;
pub use message::{Report, Sensors};
