//! Frames between the device and a host.
//!
//! A frame is `COBS(postcard(message) · CRC-32) · 0x00`. [`frame`] packs and unpacks. In lockstep with a simulated
//! device [`Sensors`] goes to the device and [`Report`] comes back, one of each a tick; a device that runs by itself
//! takes [`HostMessage`]s and is [`DeviceMessage`] of: a [`Hello`] first, a [`Record`] now and then ([`telemetry`]), to a host that
//! speaks with it [`Answer`]s and [`View`]s, and while it is being set up a [`Reading`]; one that is being accepted
//! answers requests ([`acceptance`]).
//!
//! In lockstep the host sends the sensors of tick `n`, the device answers with the report of tick `n`, and only then
//! comes `n + 1`. A host that has nothing to say in a tick sends an empty frame, so that the device need not wait.

#![doc = include_str!("../../docs/reference/wire.md")]

pub mod acceptance;
mod dialogue;
pub mod frame;
#[cfg(feature = "defmt")]
pub mod log;
mod message;
mod report;
pub mod telemetry;
mod upload;
pub use dialogue::{Answer, Calibrated, DeviceMessage, Hello, KeepError, Marked, PROTOCOL, Refused, View};
pub use message::{HostMessage, Reading, Record, Report, Sensors, hold};
pub use upload::{CHUNK, Upload, UploadError};
