//! The errors between a host and a device, each with its cause.

use palpate::body::FileError;
use palpate::servo::Fault;
use palpate::wire::Refused;
use std::io;
use std::time::Duration;
use thiserror::Error;

/// Why a call failed.
#[derive(Debug, Error)]
pub enum Error {
    /// The port is not there, or another program's.
    #[error("cannot open the serial port {port}")]
    Open {
        /// Its name.
        port: String,
        /// The operating system's error.
        #[source]
        cause: serialport::Error,
    },
    /// The line broke: unplugged, closed at the other end.
    #[error("{line}: the line broke")]
    Line {
        /// Which.
        line: String,
        /// The operating system's error.
        #[source]
        cause: io::Error,
    },
    /// The device says nothing, or nothing any more.
    #[error("{line}: the device has been silent for {:.2} s: is it on, and on this line?", waited.as_secs_f64())]
    Silent {
        /// Which line.
        line: String,
        /// For how long.
        waited: Duration,
    },
    /// Something speaks there, but no frame of it can be read.
    #[error("{line}: {bytes} bytes came and no frame among them: another baud rate, or no such device")]
    Garbled {
        /// Which line.
        line: String,
        /// Bytes received.
        bytes: u64,
    },
    /// The device speaks another version.
    #[error("{line}: the device speaks version {device} of the protocol, this program version {host}")]
    Protocol {
        /// Which line.
        line: String,
        /// The device's version.
        device: u16,
        /// This crate's.
        host: u16,
    },
    /// The device has been reset: it feels what it was built with, where that was. [`crate::Device::greet`] goes on.
    #[error("{line}: the device was reset; call `greet()` to start a new session")]
    BeganAnew {
        /// Which line.
        line: String,
    },
    /// The device is in commissioning mode (`palpate commission`): it renders nothing until it is reset.
    #[error("{line}: the device is in commissioning mode, and feels nothing until it is reset")]
    SetUp {
        /// Which line.
        line: String,
    },
    /// The device has refused it; nothing has changed.
    #[error("{asked} was refused by the device: {reason}")]
    Refused {
        /// The request.
        asked: &'static str,
        /// The device's reason.
        reason: Refused,
    },
    /// The body that is built in has no memory for another one.
    #[error("body {body} cannot be replaced: no memory for another is built in with it; upload to another body")]
    Fixed {
        /// Which.
        body: u8,
    },
    /// No answer came. It may have been done or not.
    #[error("{asked}, number {number}: no answer in {tries} tries; whether it was done is not known")]
    Lost {
        /// The request.
        asked: &'static str,
        /// The order's number.
        number: u16,
        /// How often it was sent.
        tries: u32,
    },
    /// The bytes to upload are not a valid body file; nothing was sent.
    #[error("not a valid body file")]
    Body(#[from] FileError),
    /// The body does not fit into the device's memory; nothing was sent.
    #[error(
        "the body takes {bytes} bytes, {faces} faces and {edges} edges, and the device has room for {room} bytes, \
         {most_faces} faces and {most_edges} edges"
    )]
    TooLarge {
        /// Of the body.
        bytes: usize,
        /// Of the body.
        faces: usize,
        /// Of the body.
        edges: usize,
        /// Bytes, as the device says.
        room: u32,
        /// Faces, as the device says.
        most_faces: u16,
        /// Edges, as the device says.
        most_edges: u16,
    },
    /// The device does not say that it has stopped. Take its supply away.
    #[error("{line}: stop was sent {tries} times, and the device does not say that it has stopped: press its own stop")]
    NotStopped {
        /// Which line.
        line: String,
        /// How often.
        tries: u32,
    },
    /// The device is stopped by a fault that no word of a host's takes back.
    #[error("the device stays stopped: {0}")]
    Fault(Fault),
}
