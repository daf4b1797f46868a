//! An emulated board with the boards' loop over a scene in it: the simulated arm is at its pins, this program at its
//! port.

use crate::firmware::{Board, Emulator, Link as _, Program, Progress};
use palpate::wire::Sensors;
use palpate_link::Line;
use palpate_sim::plant::{HandSettings, Plant, PlantSettings};
use palpate_sim::simulated::Hand;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Of the image, Hz.
const RATE: u32 = 4_000;
/// Ticks that the device runs before the line is looked at anew: a millisecond.
const TICKS: u32 = 4;
/// How long a byte may take on its way: emulated time stands still meanwhile.
const WAIT: Duration = Duration::from_micros(200);
/// Where the middle of the workspace is in the image's scene, metres, and where the hand is.
const MIDDLE: [f64; 3] = [0.03, 0.02, 0.015];
const ABOVE: [f64; 3] = [0.03, 0.02, 0.045];

/// A line to an emulated board.
pub struct Emulated {
    pins: Emulator,
    port: TcpStream,
    plant: Plant,
    hand: Hand,
    tick: u32,
    began: Instant,
    /// Its image, which the emulator may still be reading.
    _program: Program,
}

impl Emulated {
    /// Starts a board whose scene is two capped boxes side by side.
    ///
    /// # Errors
    /// What is missing, or an emulator that does not start.
    pub fn start(board: Board) -> anyhow::Result<Self> {
        let program = Program::prepare(board, "link", &["link"], &Progress::new())?;
        let (pins, port) = program.start_with_telemetry()?;
        port.set_read_timeout(Some(WAIT))?;
        let hand = Hand::at(ABOVE, MIDDLE);
        let path = Box::new(hand.clone());
        let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), HandSettings::default(), path, f64::from(RATE))?;
        Ok(Self { pins, port, plant, hand, tick: 0, began: Instant::now(), _program: program })
    }

    /// Whoever stands at it.
    pub fn hand(&self) -> Hand {
        self.hand.clone()
    }

    fn tick(&mut self) -> io::Result<()> {
        let sensors = Sensors { tick: self.tick, counts: self.plant.counts(), enable: self.hand.is_enabling() };
        let report = self.pins.exchange(&sensors).map_err(io::Error::other)?;
        self.plant.advance(report.duties);
        self.tick = self.tick.wrapping_add(1);
        Ok(())
    }

    fn passed(&self) -> Duration {
        Duration::from_secs(1) * self.tick / RATE
    }
}

impl Line for Emulated {
    fn name(&self) -> String {
        "the emulated board".to_owned()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.port.write_all(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let until = self.passed() + wait;
        loop {
            match self.port.read(buffer) {
                Ok(came) if came > 0 => return Ok(came),
                Ok(_) => return Err(ErrorKind::UnexpectedEof.into()),
                Err(error) if matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock) => {}
                Err(error) => return Err(error),
            }
            let is_over = self.passed() >= until;
            if is_over && !wait.is_zero() {
                return Ok(0);
            }
            for _ in 0..TICKS {
                self.tick()?;
            }
            // What comes of it is there the next time. No faster than the clock on the wall.
            std::thread::sleep((self.began + self.passed()).saturating_duration_since(Instant::now()));
            if wait.is_zero() {
                return Ok(0);
            }
        }
    }

    fn now(&self) -> Instant {
        self.began + self.passed()
    }
}
