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
        /// The line.
        line: String,
        /// The operating system's error.
        #[source]
        cause: io::Error,
    },
    /// The device says nothing, or nothing any more.
    #[error("{line}: the device has been silent for {:.2} s: is it on, and on this line?", waited.as_secs_f64())]
    Silent {
        /// The line.
        line: String,
        /// The waiting time.
        waited: Duration,
    },
    /// Something speaks there, but no frame of it can be read.
    #[error("{line}: {bytes} bytes came and no frame among them: another baud rate, or no such device")]
    Garbled {
        /// The line.
        line: String,
        /// Bytes received.
        bytes: u64,
    },
    /// The device speaks another version.
    #[error("{line}: the device speaks version {device} of the protocol, this program version {host}")]
    Protocol {
        /// The line.
        line: String,
        /// The device's version.
        device: u16,
        /// This crate's.
        host: u16,
    },
    /// The device has been reset: it feels what it was built with, where that was. [`crate::Device::greet`] goes on.
    #[error("{line}: the device was reset; call `greet()` to start a new session")]
    BeganAnew {
        /// The line.
        line: String,
    },
    /// The device is in commissioning mode (`palpate commission`): it renders nothing until it is reset.
    #[error("{line}: the device is in commissioning mode, and feels nothing until it is reset")]
    SetUp {
        /// The line.
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
    /// No answer came. It may have been done or not.
    #[error("{asked}, number {number}: no answer in {tries} tries; whether it was done is not known")]
    Lost {
        /// The request.
        asked: &'static str,
        /// The order's number.
        number: u16,
        /// Number of transmissions.
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
        /// Bytes of the body.
        bytes: usize,
        /// Faces of the body.
        faces: usize,
        /// Edges of the body.
        edges: usize,
        /// Available bytes, according to the device.
        room: u32,
        /// Faces, as the device says.
        most_faces: u16,
        /// Edges, as the device says.
        most_edges: u16,
    },
    /// The device does not say that it has stopped. Take its supply away.
    #[error("{line}: stop was sent {tries} times, and the device does not say that it has stopped: press its own stop")]
    NotStopped {
        /// The line.
        line: String,
        /// Number of tries.
        tries: u32,
    },
    /// The device is stopped by a fault that the host cannot clear.
    #[error("the device stays stopped: {0}")]
    Fault(Fault),
}
