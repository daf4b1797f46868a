//! The pins of a board on the bench, as far as a link carries them: a frame of sensors in, a report of duties out, a
//! tick.

use palpate::device::{Counts, Duty};
use palpate::wire::frame::{self, MAX_FRAME, Received};
use palpate::wire::{Report, Sensors};
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Board as BenchBoard, NotObeyed, Panel, Passive, Watchdog};

use crate::board::Board;
use crate::link::Link;
use crate::processor::Clock;

/// Ticks in a row without any frame after which the host is taken for gone and the emulator ends.
const SILENT_TICKS: u32 = 5;

/// The pins, a link to the simulated device.
pub struct Pins<L> {
    link: L,
    clock: Clock,
    /// The frame for this tick.
    pub(crate) sensors: Option<Sensors>,
    pub(crate) duties: [i16; 3],
    tick: u32,
    silent_ticks: u32,
}

impl<L: Link> Pins<L> {
    /// Pins at rest.
    pub fn new(board: &Board, link: L) -> Self {
        Self { link, clock: Clock::start(board), sensors: None, duties: [0; 3], tick: 0, silent_ticks: 0 }
    }

    /// Tells the host what the motors get from this tick on.
    pub fn report(&mut self) {
        let report = Report { tick: self.tick, duties: self.duties, ..Report::default() };
        let mut buffer = [0; MAX_FRAME];
        if let Ok(frame) = frame::pack(&report, &mut buffer) {
            self.link.send(frame);
        }
        self.tick = self.tick.wrapping_add(1);
        if self.silent_ticks >= SILENT_TICKS {
            semihosting::process::exit(0);
        }
    }
}

impl<L: Link> BenchBoard<3> for Pins<L> {
    fn drive(&mut self, duties: [Duty; 3]) -> Result<(), NotObeyed> {
        self.duties = duties.map(|Duty(duty)| duty);
        Ok(())
    }
}

impl<L: Link> Pins<L> {
    /// The board's counter.
    pub(crate) fn counter(&self) -> u32 {
        self.clock.now()
    }

    /// Takes the frame for this tick, and what the person's side says in it.
    pub(crate) fn listen(&mut self) -> Panel {
        let received = self.link.receive();
        self.silent_ticks = if received.is_none() { self.silent_ticks + 1 } else { 0 };
        self.sensors = match received {
            Some(Received::Message(sensors)) if sensors.tick == self.tick => Some(sensors),
            _ => None,
        };
        Panel {
            enable: self.sensors.is_some_and(|sensors| sensors.enable),
            enable_disagrees: false,
            stop: false,
            ready: true,
            supply: None,
        }
    }
}

impl<L: Link> Passive<3> for Pins<L> {
    fn now(&self) -> u32 {
        self.counter()
    }

    fn acknowledge(&mut self) {}

    fn panel(&mut self) -> Panel {
        self.listen()
    }

    fn read(&mut self) -> Result<[Counts; 3], BadFrame> {
        self.sensors.map(|sensors| sensors.counts.map(Counts)).ok_or(BadFrame::Absent)
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        self.duties = [0; 3];
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}

/// The emulator ends by itself once its host is gone.
pub struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}
}
