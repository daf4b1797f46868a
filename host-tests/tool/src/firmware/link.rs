//! The host's side of the link: sensors to the device, reports back.

use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::{Report, Sensors, WristSensors};
use std::io;
use std::time::Duration;
use thiserror::Error;

/// Why there is no report.
#[derive(Debug, Error)]
pub enum LinkError {
    /// Nothing came in time.
    #[error("no report from the device within {0:?}")]
    Silent(Duration),
    /// The frame is not a report.
    #[error("a damaged frame came from the device")]
    Damaged,
    /// The report is of another tick than the sensors.
    #[error("the device reported tick {reported} where tick {expected} was due")]
    OutOfStep {
        /// The tick that was sent.
        expected: u32,
        /// The tick that came back.
        reported: u32,
    },
    /// The device is gone.
    #[error("the emulator ended ({status}) {output}")]
    Ended {
        /// How it ended.
        status: String,
        /// Its output.
        output: String,
    },
    /// The line itself failed.
    #[error("the line to the device: {0}")]
    Io(#[from] io::Error),
}

/// A device at the other end of a line, in lockstep: one frame of sensors out, one report back, a tick.
pub trait Link {
    /// Sends bytes as they are. For whole frames use [`Self::send`].
    ///
    /// # Errors
    /// If the line is broken.
    fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), LinkError>;

    /// Says nothing in this tick: the device gets no sensors and reports a lost frame.
    ///
    /// # Errors
    /// If the line is broken.
    fn stay_silent(&mut self) -> Result<(), LinkError>;

    /// The next report. Waits for a bounded time.
    ///
    /// # Errors
    /// If none came, or something else.
    fn receive(&mut self) -> Result<Report, LinkError>;

    /// Which joints the polarity check has seen to follow their motors; `None` where there is none or it is not known.
    fn joints_seen(&self) -> Option<[bool; 3]> {
        None
    }

    /// Contacts released so far ([`palpate::servo::ServoState::contacts_lost`]); `None` where reports do not carry it.
    fn contacts_lost(&self) -> Option<u32> {
        None
    }

    /// Sends a frame of sensors.
    ///
    /// # Errors
    /// If the line is broken.
    fn send(&mut self, sensors: &Sensors) -> Result<(), LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = frame::pack(sensors, &mut buffer).map_err(io::Error::other)?;
        self.send_bytes(frame)
    }

    /// One tick of a device with a wrist.
    ///
    /// # Errors
    /// If there is no such report.
    fn exchange_with_wrist(&mut self, sensors: &WristSensors) -> Result<Report, LinkError> {
        let mut buffer = [0; MAX_FRAME];
        let frame = frame::pack(sensors, &mut buffer).map_err(io::Error::other)?;
        self.send_bytes(frame)?;
        of_tick(sensors.arm.tick, self.receive()?)
    }

    /// One tick: sensors out, report back, of the same tick.
    ///
    /// # Errors
    /// If there is no such report.
    fn exchange(&mut self, sensors: &Sensors) -> Result<Report, LinkError> {
        self.send(sensors)?;
        of_tick(sensors.tick, self.receive()?)
    }
}

fn of_tick(expected: u32, report: Report) -> Result<Report, LinkError> {
    if report.tick == expected { Ok(report) } else { Err(LinkError::OutOfStep { expected, reported: report.tick }) }
}
