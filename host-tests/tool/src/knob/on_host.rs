//! The loop of the boards, compiled for the host, at a simulated dial.

use super::{JOG, KnobServo, MODULATION, PROTECTION, SEARCH, SETTINGS, device, servo};
use crate::commission::{Hands, Line};
use anyhow::bail;
use palpate::device::drive::Field;
use palpate::device::{Counts, Dial, Duty, ElectricalAngle};
use palpate::servo::{Guarded, Heartbeat, Knob, ResetReason};
use palpate::wire::Record;
use palpate::wire::telemetry::Queue;
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Bench, Board, Felt, Idle, Mailbox, NotObeyed, Panel, Passive, Port, Settings, Watchdog};
use palpate_sim::plant::DialSettings;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Of the simulated board's counter, Hz.
const CLOCK: u32 = 100_000_000;
/// Ticks that the device runs while the line is looked at: two milliseconds.
const TICKS: u32 = 8;
/// Bytes that a line of 500,000 baud carries in a tick, either way, with time to spare.
const BYTES: u32 = 16;

/// The simulated dial, and the button beside it.
#[derive(Debug)]
pub struct KnobWorld {
    /// The dial.
    pub dial: palpate_sim::plant::Dial,
    /// The enable button is pressed.
    pub enable: bool,
}

/// The same, for a board and for the hands at it.
#[derive(Clone, Debug)]
pub struct SharedKnob(Arc<Mutex<KnobWorld>>);

impl SharedKnob {
    /// A dial at rest.
    pub fn new(settings: DialSettings) -> Self {
        let dial = palpate_sim::plant::Dial::new(settings, f64::from(SETTINGS.rate_hz));
        Self(Arc::new(Mutex::new(KnobWorld { dial, enable: false })))
    }

    /// What it is now.
    pub fn world(&self) -> MutexGuard<'_, KnobWorld> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Hands for SharedKnob {
    fn place(&mut self, _: [f64; 3]) -> anyhow::Result<()> {
        bail!("a knob has no joints to put anywhere")
    }

    fn pose(&mut self, _: [f64; 3]) -> anyhow::Result<()> {
        bail!("a knob is homed by its field")
    }

    fn pass(&mut self, _: usize, _: [f64; 3]) -> anyhow::Result<()> {
        bail!("a knob is homed by its field")
    }

    fn rest(&mut self, _: usize, _: f64) -> anyhow::Result<()> {
        bail!("a knob rests by itself")
    }

    fn pull(&mut self, _: [f64; 3]) -> anyhow::Result<f64> {
        bail!("a knob has no probe to hang a weight at")
    }

    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        self.world().enable = pressed;
        Ok(())
    }
}

struct This(KnobServo);

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Guarded<1>;

    fn servo(&self) -> &KnobServo {
        &self.0
    }
}

struct SimulatedBoard {
    knob: SharedKnob,
    aim: Option<ElectricalAngle>,
    widths: Option<[f64; 3]>,
}

impl Board<1> for SimulatedBoard {
    fn aim(&mut self, [field]: [ElectricalAngle; 1]) {
        self.aim = Some(field);
    }

    /// As the stage of the boards does it ([`palpate::device::drive::ThreePhase`]).
    fn drive(&mut self, [duty]: [Duty; 1]) -> Result<(), NotObeyed> {
        let angle = self.aim.ok_or(NotObeyed)?;
        self.widths = Some(MODULATION.widths(Field { angle, duty }).map(f64::from));
        Ok(())
    }
}

impl Passive<1> for SimulatedBoard {
    fn now(&self) -> u32 {
        0
    }

    fn acknowledge(&mut self) {}

    fn panel(&mut self) -> Panel {
        Panel { enable: self.knob.world().enable, stop: false, ready: true, supply: None }
    }

    fn read(&mut self) -> Result<[Counts; 1], BadFrame> {
        self.knob.world().dial.counts().map(|counts| [Counts(counts)]).ok_or(BadFrame::Absent)
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        (self.aim, self.widths) = (None, None);
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}

/// The serial port, both ends.
#[derive(Default)]
struct Bytes {
    to_device: VecDeque<u8>,
    from_device: Vec<u8>,
}

impl Port for Bytes {
    fn send(&mut self, byte: u8) -> bool {
        self.from_device.push(byte);
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.to_device.pop_front()
    }
}

struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}
}

/// A line to the knob's loop in this very program.
pub struct KnobLine {
    bench: Bench<'static, This, SimulatedBoard, 1>,
    idle: Idle<'static>,
    bytes: Bytes,
}

impl KnobLine {
    /// The knob's loop, without a map, at this dial.
    pub fn new(knob: &SharedKnob) -> Self {
        // They live as long as the program, as a board's statics do.
        let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
        let queue: &'static mut Queue<Record, 16> = Box::leak(Box::new(Queue::new()));
        let servo = servo(Box::leak(Box::new(device(None))), SEARCH, PROTECTION);
        let board = SimulatedBoard { knob: knob.clone(), aim: None, widths: None };
        let (producer, records) = queue.split();
        let settings = Settings { jog: Some(JOG), ..Settings::new(CLOCK) };
        let bench = Bench::new(This(servo), board, &settings, ResetReason::PowerOn, producer, mailbox);
        let idle = Idle::new(mailbox, records, Heartbeat::default());
        Self { bench, idle, bytes: Bytes::default() }
    }
}

impl Line for KnobLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.bytes.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            self.bench.tick();
            let board = self.bench.board();
            board.knob.world().dial.advance(board.widths);
            for _ in 0..BYTES {
                self.idle.step(&mut self.bytes, &mut NoWatchdog);
            }
        }
        Ok(std::mem::take(&mut self.bytes.from_device))
    }
}
