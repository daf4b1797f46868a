//! AS5047P sensors at the other end of a bus: a model that minds its data sheet's times, and whose failures a test plants.

use embedded_hal::digital::{ErrorType as PinErrorType, OutputPin};
use palpate_bench::sensors::{Angles, Bounded, Controller};
use palpate_bench::{Counter, CycleDelay};
use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

/// Half a clock of 8 MHz, the bus's, ns.
const CLOCKS: f64 = 16.0 * 125.0;
/// Data sheet: time to power up, ns.
const POWER_UP: f64 = 10e6;

/// One sensor.
#[derive(Clone, Debug)]
pub struct Chip {
    /// The shaft's angle, 0 to 16,383.
    pub angle: u16,
    /// The field at the chip, as a fraction of the one that needs half of the gain; 0 without a magnet.
    pub field: f64,
    /// The angle does not change any more, whatever the shaft does.
    pub is_frozen: bool,
    /// Frames to come whose command arrives damaged.
    pub deaf: u32,
    /// When it answers, cycles.
    pub ready_at: u64,
    /// It has its supply, and its wires are whole.
    pub is_there: bool,
    /// Level of its data line while nobody drives it: it is pulled, or broken on the side of a level.
    pub silence: u16,
    /// The measured angle.
    measured: u16,
    /// The answer in the next frame.
    answer: u16,
    error: bool,
    selected: bool,
    risen: Option<u64>,
    fallen: u64,
}

impl Chip {
    /// Data sheet, DIAAGC: gain in bits 7 to 0, bit 8 settled, bit 10 field too strong (gain 0), bit 11 too weak (gain
    /// 255).
    fn diagnostics(&self) -> u16 {
        let gain = (128.0 / self.field).min(255.0) as u16;
        0x0100 | gain | if gain == 0 { 1 << 10 } else { 0 } | if gain == 255 { 1 << 11 } else { 0 }
    }
}

/// The sensors, their bus and the core's counter.
#[derive(Debug)]
pub struct Table {
    /// The core's counter.
    pub cycles: u64,
    /// Of the counter, Hz.
    frequency: f64,
    /// Cycles of a look at the counter.
    look: u64,
    /// The sensors.
    pub chips: Vec<Chip>,
    /// Whether the bus's controller reports the end of a frame.
    pub finishes: bool,
    last_clock: u64,
    /// Frames so far.
    pub frames: u32,
    /// The shortest time of a select line so far, ns: high, from its fall to the first clock, from the last to its rise.
    pub least: [f64; 3],
}

impl Table {
    fn nanoseconds(&self, cycles: u64) -> f64 {
        cycles as f64 * 1e9 / self.frequency
    }

    fn fall(&mut self, joint: usize) {
        let now = self.cycles;
        if let Some(risen) = self.chips[joint].risen {
            self.least[0] = self.least[0].min(self.nanoseconds(now - risen));
        }
        (self.chips[joint].selected, self.chips[joint].fallen) = (true, now);
    }

    fn rise(&mut self, joint: usize) {
        let now = self.cycles;
        if self.chips[joint].selected {
            self.least[2] = self.least[2].min(self.nanoseconds(now - self.last_clock));
        }
        (self.chips[joint].selected, self.chips[joint].risen) = (false, Some(now));
    }

    fn exchange(&mut self, command: u16) -> u16 {
        self.frames += 1;
        let selected: Vec<usize> = (0..self.chips.len()).filter(|joint| self.chips[*joint].selected).collect();
        let [joint] = selected[..] else { panic!("{selected:?} are selected at once") };
        let set_up = self.nanoseconds(self.cycles - self.chips[joint].fallen);
        self.least[1] = self.least[1].min(set_up);
        self.cycles += (CLOCKS * self.frequency / 1e9).ceil() as u64;
        self.last_clock = self.cycles;
        let now = self.cycles;
        let chip = &mut self.chips[joint];
        if !chip.is_there || now < chip.ready_at {
            return chip.silence;
        }
        if !chip.is_frozen {
            chip.measured = chip.angle;
        }
        let answer = chip.answer | if chip.error { 1 << 14 } else { 0 };
        let is_whole = chip.deaf == 0 && command.count_ones().is_multiple_of(2);
        chip.deaf = chip.deaf.saturating_sub(1);
        chip.error |= !is_whole;
        chip.answer = match command & 0x3fff {
            0x3fff => chip.measured,
            0x3ffc => chip.diagnostics(),
            0x0001 => {
                if is_whole {
                    chip.error = false;
                }
                0
            }
            other => panic!("{other:#x} is no address"),
        };
        answer | ((answer.count_ones() % 2) as u16) << 15
    }
}

/// The table, shared by bus, lines and counter.
pub type SharedTable = Rc<RefCell<Table>>;

/// The bus.
#[derive(Debug)]
pub struct Bus(SharedTable);

impl Controller for Bus {
    fn exchange(&mut self, frame: [u8; 2]) -> Option<[u8; 2]> {
        let mut table = self.0.borrow_mut();
        let answer = table.exchange(u16::from_be_bytes(frame)).to_be_bytes();
        table.finishes.then_some(answer)
    }
}

/// A sensor's select line.
#[derive(Debug)]
pub struct Select(SharedTable, usize);

impl PinErrorType for Select {
    type Error = Infallible;
}

impl OutputPin for Select {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().fall(self.1);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.borrow_mut().rise(self.1);
        Ok(())
    }
}

/// The core's counter.
#[derive(Clone, Debug)]
pub struct Cycles(SharedTable);

impl Counter for Cycles {
    fn now(&self) -> u32 {
        let mut table = self.0.borrow_mut();
        table.cycles += table.look;
        // The lower 32 bits: it wraps.
        table.cycles as u32
    }
}

/// The boards' driver on that bus.
pub type Joints<const JOINTS: usize = 3> = Angles<Bounded<Bus>, Select, CycleDelay<Cycles>, JOINTS>;

/// Sensors at rest at angle zero that were just switched on, and their driver on a core of `frequency` Hz, to
/// which a look at its counter takes `look` cycles.
pub fn table<const JOINTS: usize>(frequency: u32, look: u64) -> (SharedTable, Joints<JOINTS>) {
    let chip = Chip {
        angle: 0,
        field: 1.0,
        is_frozen: false,
        deaf: 0,
        ready_at: (POWER_UP * f64::from(frequency) / 1e9) as u64,
        is_there: true,
        silence: u16::MAX,
        measured: 0,
        answer: 0,
        error: true,
        selected: false,
        risen: None,
        fallen: 0,
    };
    let shared = Rc::new(RefCell::new(Table {
        cycles: 0,
        frequency: f64::from(frequency),
        look,
        chips: vec![chip; JOINTS],
        finishes: true,
        last_clock: 0,
        frames: 0,
        least: [f64::INFINITY; 3],
    }));
    let selects = core::array::from_fn(|joint| Select(Rc::clone(&shared), joint));
    let delay = CycleDelay::new(Cycles(Rc::clone(&shared)), frequency);
    let joints = Angles::new(Bounded(Bus(Rc::clone(&shared))), selects, delay, [4_096; JOINTS]);
    (shared, joints)
}
