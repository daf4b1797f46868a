//! Frames between the device and a host.
//!
//! A frame is `COBS(postcard(message) · CRC-32) · 0x00`. [`frame`] packs and unpacks. In lockstep with a simulated
//! device [`Sensors`] goes to the device and [`Report`] comes back, one of each a tick. A standalone device takes
//! [`HostMessage`]s and sends [`DeviceMessage`]s: a [`Hello`] first and a [`Record`] now and then ([`telemetry`]);
//! [`Answer`]s and [`View`]s to a host that sends commands; [`Reading`]s in commissioning mode. A device in acceptance
//! answers requests ([`acceptance`]).
//!
//! In lockstep the host sends the sensors of tick `n`, the device answers with the report of tick `n`, and only then
//! comes `n + 1`. A host without a message in a tick sends an empty frame, so that the device need not wait.

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
pub use dialogue::{
    Answer, Calibrated, DIALS_HZ, DeviceMessage, Dial, Hello, KeepError, KeptFeel, MODES_HZ, Marked, Modes, PROTOCOL,
    Refused, View,
};
pub use message::{HostMessage, Reading, Record, Report, Sensors, WristSensors, hold};
pub use upload::{CHUNK, Upload, UploadError};
