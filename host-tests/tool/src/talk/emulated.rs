//! An emulated board with the boards' loop over a scene in it: the simulated arm or knob is at its pins, a console at its
//! port.

use super::console::{Button, Press};
use crate::firmware::{Board, Emulator, Link as _, Program, Progress};
use palpate::wire::Sensors;
use palpate_link::Line;
use palpate_sim::knob::{SharedKnob, widths_of};
use palpate_sim::plant::{Fingers, HandSettings, Plant, PlantSettings};
use palpate_sim::simulated::Hand;
use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Of the image, Hz.
const RATE: u32 = 4_000;
/// Ticks that the device runs before the line is read again: a millisecond.
const TICKS: u32 = 4;
/// How long a byte may take on its way: emulated time stands still meanwhile.
const WAIT: Duration = Duration::from_micros(200);
/// Where the middle of the workspace is in the image's scene, metres, and where the hand is.
const MIDDLE: [f64; 3] = [0.03, 0.02, 0.015];
const ABOVE: [f64; 3] = [0.03, 0.02, 0.045];

/// A finger at a simulated knob, which can be reset, or an emulated one.
pub fn at_knob(knob: &SharedKnob, can_reset: bool) -> Button {
    let knob = knob.clone();
    Box::new(move |press| {
        let mut world = knob.world();
        let now = world.dial.time();
        world.enable = press == Press::Down;
        if press == Press::Reset {
            // The rotor is aligned without a hand on it.
            world.dial.hold(Fingers::NONE);
            (world.resets, world.turns_from) = (can_reset, now + 4.0);
            return can_reset;
        }
        // The device asks once it has seen the button released for long enough.
        world.confirms_at = (press == Press::Confirm).then_some(now + 0.3);
        true
    })
}

/// The world at its pins.
enum World {
    Arm(Box<Plant>, Hand),
    Knob(SharedKnob),
}

/// A line to an emulated board.
pub struct Emulated {
    pins: Emulator,
    port: TcpStream,
    world: World,
    tick: u32,
    began: Instant,
    /// Where the arm's probe is at each tick, m in the scene's frame, once that is kept.
    probes: Option<Vec<[f64; 3]>>,
    /// Its image, which the emulator may still be reading.
    _program: Program,
}

impl Emulated {
    /// Starts a board whose scene is two capped boxes side by side.
    ///
    /// # Errors
    /// A missing tool, or an emulator that does not start.
    pub fn start(board: Board) -> anyhow::Result<Self> {
        let hand = Hand::at(ABOVE, MIDDLE);
        let path = Box::new(hand.clone());
        let plant = Plant::new(&PlantSettings::wooden_haptics_2016(), HandSettings::default(), path, f64::from(RATE))?;
        Self::run(board, "link", &["link"], World::Arm(Box::new(plant), hand))
    }

    /// Starts a board with a knob.
    ///
    /// # Errors
    /// As [`Self::start`]'s.
    pub fn start_knob(board: Board, knob: &SharedKnob) -> anyhow::Result<Self> {
        Self::run(board, "knob_link", &["knob"], World::Knob(knob.clone()))
    }

    fn run(board: Board, program: &str, features: &[&str], world: World) -> anyhow::Result<Self> {
        let program = Program::prepare(board, program, features, &Progress::new())?;
        let (pins, port) = program.start_with_telemetry()?;
        port.set_read_timeout(Some(WAIT))?;
        Ok(Self { pins, port, world, tick: 0, began: Instant::now(), probes: None, _program: program })
    }

    /// The tick of the board that comes next, and where the simulated arm's probe was at each tick since the last call,
    /// m in the scene's frame; the first call starts to keep them.
    pub fn take_probes(&mut self) -> (u32, Vec<[f64; 3]>) {
        (self.tick, self.probes.replace(Vec::new()).unwrap_or_default())
    }

    /// The user's finger on its enable button.
    pub fn button(&self) -> Button {
        match &self.world {
            World::Arm(_, hand) => {
                let hand = hand.clone();
                Box::new(move |press| {
                    hand.enables(press == Press::Down);
                    press != Press::Reset
                })
            }
            World::Knob(knob) => at_knob(knob, false),
        }
    }

    fn tick(&mut self) -> io::Result<()> {
        if let (Some(probes), World::Arm(plant, _)) = (&mut self.probes, &self.world) {
            let position = plant.position();
            probes.push(core::array::from_fn(|axis| position[axis] + MIDDLE[axis]));
        }
        let (counts, enable) = match &self.world {
            World::Arm(plant, hand) => (plant.counts(), hand.is_enabling()),
            World::Knob(knob) => {
                let world = knob.world();
                let supply = (world.dial.supply_volts() * 1e3) as i32;
                // A sensor that does not answer is one that says what cannot be.
                ([world.dial.counts().unwrap_or(i32::MIN), 0, supply], world.enable)
            }
        };
        let sensors = Sensors { tick: self.tick, counts, enable };
        let report = self.pins.exchange(&sensors).map_err(io::Error::other)?;
        match &mut self.world {
            World::Arm(plant, _) => plant.advance(report.duties),
            World::Knob(knob) => {
                let mut world = knob.world();
                world.hand();
                world.dial.advance(widths_of(&report));
            }
        }
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
