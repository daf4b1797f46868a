//! The knob on an emulated board: the sensor comes in a frame, the widths of three phases go out in one.

/// The cogging of the simulated motor, as it was recorded.
mod cogging {
    include!("../knob_cogging.rs");
}

use palpate::commission::Wiring;
use palpate::device::Duty;
use palpate::device::drive::Field;
use palpate::device::sensor::Frozen;
use palpate::device::{Counts, Device, Dial};
use palpate::render::Feel;
use palpate::servo::{Deadline, Event, Guarded, Input, Knob};
use palpate::wire::Sensors;
use palpate::wire::frame::{self, MAX_FRAME, Received};

use crate::board::Board;
use crate::link::Link;
use crate::pins::Pins;
use crate::timer::{CHIP_INSTRUCTIONS_PER_SECOND, InstructionCounter};
pub use palpate_bench::knob::SETTINGS;
use palpate_bench::knob::{
    KnobServo, KnobState, MODULATION, SEARCH, TOLD_OF_SUPPLY, device, duties, report, servo, widths,
};
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Board as BenchBoard, Felt, NotObeyed, Panel, Passive};

/// Ticks in a row without any frame after which the host is taken for gone and the emulator ends.
const SILENT_TICKS: u32 = 5;

static DEVICE: Device<Dial, 1> = device(if cfg!(feature = "uncompensated") { None } else { cogging::COGGING });
/// Everything the loop knows, in flash.
pub static SERVO: KnobServo = servo(&DEVICE, SEARCH, TOLD_OF_SUPPLY);

const DEADLINE: Deadline = Deadline::of_period(CHIP_INSTRUCTIONS_PER_SECOND as f32, SETTINGS.rate_hz);

/// One tick of the knob, which is also counted: the loop, and the widths of the three phases.
#[inline(never)]
pub fn tick(state: &mut KnobState, input: Input<1>) -> Option<[f32; 3]> {
    let _ = SERVO.tick(state, input);
    widths(&SERVO, state, &MODULATION)
}

/// The loop of the knob over a link.
pub struct KnobLoop<L> {
    link: L,
    state: KnobState,
    frozen: Frozen,
    counter: InstructionCounter,
    silent_ticks: u32,
}

impl<L: Link> KnobLoop<L> {
    /// A loop before its first tick.
    pub fn new(board: &Board, link: L, counter: InstructionCounter) -> Self {
        Self { link, state: SERVO.start_after(board.reset_reason()), frozen: Frozen::AS5047P, counter, silent_ticks: 0 }
    }

    /// One tick.
    pub fn tick(&mut self) {
        let input = self.input();
        let state = &mut self.state;
        let (mut given, instructions) = self.counter.count(|| tick(state, input));
        if DEADLINE.overrun(0, instructions) {
            SERVO.note(state, Event::Overrun);
            given = widths(&SERVO, state, &MODULATION);
        }
        let mut buffer = [0; MAX_FRAME];
        if let Ok(frame) = frame::pack(&report(state, given, instructions), &mut buffer) {
            self.link.send(frame);
        }
        if self.silent_ticks >= SILENT_TICKS {
            semihosting::process::exit(0);
        }
    }

    /// The host's frame for this tick: the first count is the dial's, the second which feel is chosen, the third the
    /// supply's millivolts.
    fn input(&mut self) -> Input<1> {
        let received = self.link.receive();
        self.silent_ticks = if received.is_none() { self.silent_ticks + 1 } else { 0 };
        match received {
            Some(Received::Message(Sensors { tick, counts: [counts, feel, supply], enable }))
                if tick == self.state.ticks() =>
            {
                SERVO.note(&mut self.state, Event::Chosen { index: feel as u8 });
                SERVO.note(&mut self.state, Event::Supply { millivolts: supply as u32 });
                if self.frozen.is_frozen(counts as u32) {
                    return Input::Frozen;
                }
                Input::Sensors { counts: [Counts(counts)], enable }
            }
            Some(Received::Damaged) => Input::Damaged,
            Some(Received::Message(_) | Received::Empty) | None => Input::Lost,
        }
    }
}

/// The servo of the boards' loop.
pub struct This;

impl This {
    /// Whether the knob bears a feel that was kept.
    pub fn bears(feel: &Feel) -> bool {
        SERVO.restore(&mut SERVO.start(), *feel).is_ok()
    }
}

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Guarded<1>;

    #[inline(always)]
    fn servo(&self) -> &KnobServo {
        &SERVO
    }

    #[inline(always)]
    fn wiring(&self) -> Wiring<1> {
        Wiring::STRAIGHT
    }
}

/// The pins of a knob, as far as a link carries them.
pub struct KnobPins<L> {
    pins: Pins<L>,
    frozen: Frozen,
    field: Field,
}

impl<L: Link> KnobPins<L> {
    /// Pins at rest.
    pub fn new(board: &Board, link: L) -> Self {
        let mut pins = Pins::new(board, link);
        pins.duties = duties(None);
        Self { pins, frozen: Frozen::AS5047P, field: Field::default() }
    }

    /// Tells the host the widths of the motor's phases from this tick on.
    pub fn report(&mut self) {
        self.pins.report();
    }
}

impl<L: Link> BenchBoard<1> for KnobPins<L> {
    fn aim(&mut self, [field]: [Field; 1]) {
        self.field = field;
    }

    fn drive(&mut self, [duty]: [Duty; 1]) -> Result<(), NotObeyed> {
        self.pins.duties = duties(Some(MODULATION.widths(self.field, duty)));
        Ok(())
    }
}

impl<L: Link> Passive<1> for KnobPins<L> {
    fn now(&self) -> u32 {
        self.pins.counter()
    }

    fn acknowledge(&mut self) {}

    fn panel(&mut self) -> Panel {
        let panel = self.pins.listen();
        let supply = self.pins.sensors.map(|sensors| sensors.counts[2] as f32 / 1e3);
        Panel { supply, ..panel }
    }

    fn read(&mut self) -> Result<[Counts; 1], BadFrame> {
        let Some(Sensors { counts: [counts, ..], .. }) = self.pins.sensors else { return Err(BadFrame::Absent) };
        if self.frozen.is_frozen(counts as u32) { Err(BadFrame::Frozen) } else { Ok([Counts(counts)]) }
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        self.pins.duties = duties(None);
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}
