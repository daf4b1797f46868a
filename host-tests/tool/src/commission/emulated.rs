//! An emulated board with the loop of the boards in it: the simulated device is at its pins, this program at its port.

use super::{Line, World};
use crate::firmware::{Emulator, Link as _, Program};
use palpate::wire::Sensors;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Ticks that the device runs while the line is looked at: two milliseconds.
const TICKS: u32 = 8;
/// How long a byte may take on its way: emulated time stands still meanwhile.
const WAIT: Duration = Duration::from_micros(200);
/// The wait for messages that the board has not seen, times the square of their number, and its maximum: the 50 in which
/// a silent key counts as released take ten seconds.
const SETTLING: Duration = Duration::from_micros(250);
const MOST_SETTLING: Duration = Duration::from_millis(250);

/// A line to an emulated board.
pub struct EmulatedLine {
    pins: Emulator,
    port: TcpStream,
    world: Arc<Mutex<World>>,
    tick: u32,
    /// Its image, which the emulator may still be reading.
    program: Program,
}

impl EmulatedLine {
    /// Starts a board that runs the program `bench`: its pins by one link, its serial port by another.
    ///
    /// # Errors
    /// An emulator that does not start.
    pub fn start(program: Program, world: &Arc<Mutex<World>>) -> anyhow::Result<Self> {
        let (pins, port) = started(&program, &[])?;
        Ok(Self { pins, port, world: Arc::clone(world), tick: 0, program })
    }
}

/// A board with this in its flash.
fn started(program: &Program, flash: &[u8]) -> anyhow::Result<(Emulator, TcpStream)> {
    let (pins, port) = program.start_with_flash(flash)?;
    port.set_read_timeout(Some(WAIT))?;
    Ok((pins, port))
}

impl Line for EmulatedLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        Ok(self.port.write_all(bytes)?)
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            let sensors = {
                let world = self.world.lock().unwrap_or_else(PoisonError::into_inner);
                Sensors { tick: self.tick, counts: world.counts(), enable: world.enable }
            };
            let report = self.pins.exchange(&sensors)?;
            self.world.lock().unwrap_or_else(PoisonError::into_inner).advance(report.duties);
            self.tick = self.tick.wrapping_add(1);
        }
        let mut buffer = [0; 4096];
        match self.port.read(&mut buffer) {
            Ok(read) => Ok(buffer[..read].to_vec()),
            Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => Ok(Vec::new()),
            Err(error) => Err(error.into()),
        }
    }

    fn settle(&mut self, behind: u32) {
        std::thread::sleep((SETTLING * behind.saturating_mul(behind)).min(MOST_SETTLING));
    }

    fn press(&mut self, pressed: bool) -> anyhow::Result<bool> {
        self.world.lock().unwrap_or_else(PoisonError::into_inner).enable = pressed;
        Ok(true)
    }

    /// Another emulator, with the flash of the first.
    fn reset(&mut self) -> anyhow::Result<bool> {
        let flash = self.pins.flash()?;
        (self.pins, self.port) = started(&self.program, &flash)?;
        self.tick = 0;
        Ok(true)
    }
}
