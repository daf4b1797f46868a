//! A board in this program: the world at its pins, both ends of its serial port, and the boards' loop between them.

use palpate::device::drive::Field;
use palpate::device::{Counts, Duty};
use palpate::servo::{Heartbeat, ResetReason};
use palpate::wire::Record;
use palpate::wire::telemetry::Queue;
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Bench, Board, Felt, Idle, Mailbox, NotObeyed, Panel, Passive, Port, Settings, Watchdog};
use std::collections::VecDeque;

/// Frequency of the simulated boards' counter, Hz.
pub const CLOCK_HZ: u32 = 100_000_000;

/// The world at a board's pins.
pub trait AtPins<const JOINTS: usize> {
    /// Enable, stop, ready and supply.
    fn panel(&mut self) -> Panel;

    /// Encoder counts.
    ///
    /// # Errors
    /// Sensors that do not answer.
    fn counts(&mut self) -> Result<[Counts; JOINTS], BadFrame>;

    /// Counts that were caught at index marks since the last call.
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        [None; JOINTS]
    }

    /// One servo period under these duties, with motor fields at these angles; without duties the stages are off.
    fn advance(&mut self, fields: Option<[Field; JOINTS]>, duties: Option<[Duty; JOINTS]>);
}

/// A board whose pins are a simulated world's.
pub struct Pins<W, const JOINTS: usize> {
    /// The world.
    pub world: W,
    fields: Option<[Field; JOINTS]>,
    /// Duties of the stages; `None` while they are off.
    pub duties: Option<[Duty; JOINTS]>,
    /// Its counter, which a tick takes no time of.
    counter: u32,
}

impl<W, const JOINTS: usize> Pins<W, JOINTS> {
    const fn new(world: W) -> Self {
        Self { world, fields: None, duties: None, counter: 0 }
    }
}

impl<W: AtPins<JOINTS>, const JOINTS: usize> Board<JOINTS> for Pins<W, JOINTS> {
    fn aim(&mut self, fields: [Field; JOINTS]) {
        self.fields = Some(fields);
    }

    fn drive(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        self.duties = Some(duties);
        Ok(())
    }
}

impl<W: AtPins<JOINTS>, const JOINTS: usize> Passive<JOINTS> for Pins<W, JOINTS> {
    fn now(&self) -> u32 {
        self.counter
    }

    fn acknowledge(&mut self) {}

    fn panel(&mut self) -> Panel {
        self.world.panel()
    }

    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        self.world.counts()
    }

    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        self.world.marks()
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        (self.fields, self.duties) = (None, None);
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}

/// Both ends of a board's serial port; every byte is there at once.
#[derive(Debug, Default)]
pub struct Wire {
    /// Bytes on their way to the device.
    pub to_device: VecDeque<u8>,
    /// Bytes that the device sent.
    pub from_device: Vec<u8>,
}

impl Port for Wire {
    fn send(&mut self, byte: u8) -> bool {
        self.from_device.push(byte);
        true
    }

    fn receive(&mut self) -> Option<u8> {
        self.to_device.pop_front()
    }
}

/// A watchdog that never resets anything.
#[derive(Clone, Copy, Debug)]
pub struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}
}

/// One servo period of a device, whatever its mechanism.
pub trait Ticks {
    /// A tick of the loop, then a period of the world.
    fn tick(&mut self);
}

impl<F: Felt<JOINTS>, W: AtPins<JOINTS>, const JOINTS: usize> Ticks for Bench<'static, F, Pins<W, JOINTS>, JOINTS> {
    fn tick(&mut self) {
        Bench::tick(self);
        let period = CLOCK_HZ as f32 / self.felt().servo().settings().rate_hz;
        let Pins { world, fields, duties, counter } = self.board();
        world.advance(*fields, *duties);
        *counter = counter.wrapping_add(period as u32);
    }
}

impl Ticks for Box<dyn Ticks> {
    fn tick(&mut self) {
        (**self).tick();
    }
}

/// The boards' loop over a world.
pub type SimulatedBench<F, W, const JOINTS: usize> = Bench<'static, F, Pins<W, JOINTS>, JOINTS>;

/// A board that runs: its tick, and the rest of its program over the serial port.
pub struct SimulatedBoard<B> {
    /// The tick.
    pub bench: B,
    /// The rest of the program.
    pub idle: Idle<'static>,
    /// The serial port.
    pub wire: Wire,
}

impl<F: Felt<JOINTS>, W: AtPins<JOINTS>, const JOINTS: usize> SimulatedBoard<SimulatedBench<F, W, JOINTS>> {
    /// A board before its first tick. Its mailbox and queue live as long as the program, as a board's statics do.
    pub fn new(felt: F, world: W, settings: &Settings, reset: ResetReason) -> Self {
        let mailbox: &'static Mailbox = Box::leak(Box::new(Mailbox::new()));
        let queue: &'static mut Queue<Record, 16> = Box::leak(Box::new(Queue::new()));
        let (producer, records) = queue.split();
        let bench = Bench::new(felt, Pins::new(world), settings, reset, producer, mailbox);
        Self { bench, idle: Idle::new(mailbox, records, Heartbeat::default()), wire: Wire::default() }
    }
}

impl<B: Ticks> SimulatedBoard<B> {
    /// One servo period, in which the line carries `bytes` either way.
    pub fn tick(&mut self, bytes: u32) {
        self.bench.tick();
        for _ in 0..bytes {
            self.idle.step(&mut self.wire, &mut NoWatchdog);
        }
    }
}
