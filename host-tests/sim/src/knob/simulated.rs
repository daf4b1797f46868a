//! The loop of the boards, compiled for the host, at a simulated dial.

use super::{JOG, KnobServo, MODULATION, PROTECTION, SEARCH, SETTINGS, device, servo};
use crate::plant::{DialSettings, Fingers};
use crate::simulated::{AtPins, CLOCK_HZ, SimulatedBench, SimulatedBoard};
use palpate::commission::Wiring;
use palpate::device::drive::Field;
use palpate::device::{Counts, Dial, Duty};
use palpate::servo::{Guarded, Knob, ResetReason};
use palpate_bench::sensors::BadFrame;
use palpate_bench::store::{KeptFeels, PretendedFlash};
use palpate_bench::{Felt, Panel, Settings};
use palpate_link::Line;
use std::f64::consts::TAU;
use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The simulated dial, and the button beside it.
#[derive(Debug)]
pub struct KnobWorld {
    /// The dial.
    pub dial: crate::plant::Dial,
    /// The enable button is pressed.
    pub enable: bool,
    /// When a hand starts to turn the dial there and back, softly, s.
    pub turns_from: f64,
    /// The board is reset at its next tick.
    pub resets: bool,
    /// A hand confirms what the device asks for: from this time on it holds the button for 0.6 s.
    pub confirms_at: Option<f64>,
    /// Whole turns of the dial that its reported angle does not count.
    pub turns: i32,
    /// Where it is kept, for each tick: angle, rate and torque of the feel, angle and torque of the shaft; radians, s, N·m.
    /// Both angles without those turns.
    pub trace: Option<Vec<[f64; 5]>>,
}

/// The same, for a board and for the hands at it.
#[derive(Clone, Debug)]
pub struct SharedKnob(Arc<Mutex<KnobWorld>>);

impl SharedKnob {
    /// A dial at rest.
    pub fn new(settings: DialSettings) -> Self {
        let dial = crate::plant::Dial::new(settings, f64::from(SETTINGS.rate_hz));
        Self(Arc::new(Mutex::new(KnobWorld {
            dial,
            enable: false,
            turns_from: f64::INFINITY,
            resets: false,
            confirms_at: None,
            turns: 0,
            trace: None,
        })))
    }

    /// The current state of the simulated knob.
    pub fn world(&self) -> MutexGuard<'_, KnobWorld> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl KnobWorld {
    /// A hand that turns the dial by 60 degrees there and back in four seconds, softer than a detent, and holds the
    /// button to confirm.
    pub fn hand(&mut self) {
        if let Some(at) = self.confirms_at {
            self.enable = (at..at + 0.6).contains(&self.dial.time());
            self.confirms_at = self.confirms_at.filter(|at| self.dial.time() < at + 0.6);
        }
        if self.dial.time() >= self.turns_from {
            let phase = std::f64::consts::FRAC_PI_2 * self.dial.time();
            let (aim, rate) = (super::DIAL_ZERO + 1.05 * phase.sin(), 1.05 * std::f64::consts::FRAC_PI_2 * phase.cos());
            self.dial.hold(Fingers { stiffness: 0.2, damping: 2e-3, aim, rate });
        }
    }
}

/// The knob's loop at these pins.
pub struct This(KnobServo);

impl Felt<1> for This {
    type Surface = Knob;
    type Mechanism = Dial;
    type Guard = Guarded<1>;

    fn servo(&self) -> &KnobServo {
        &self.0
    }

    fn wiring(&self) -> Wiring<1> {
        Wiring::STRAIGHT
    }
}

impl AtPins<1> for SharedKnob {
    fn panel(&mut self) -> Panel {
        Panel { enable: self.world().enable, enable_disagrees: false, stop: false, ready: true, supply: None }
    }

    fn counts(&mut self) -> Result<[Counts; 1], BadFrame> {
        self.world().dial.counts().map(|counts| [Counts(counts)]).ok_or(BadFrame::Absent)
    }

    /// As the stage of the boards does it ([`palpate::device::drive::ThreePhase`]).
    fn advance(&mut self, fields: Option<[Field; 1]>, duties: Option<[Duty; 1]>) {
        let widths = fields.zip(duties).map(|([field], [duty])| MODULATION.widths(field, duty).map(f64::from));
        let mut world = self.world();
        world.hand();
        world.dial.advance(widths);
    }
}

/// A page of pretended flash, which a reset leaves alone.
pub type KnobFlash = PretendedFlash<512>;

/// The boards' knob in this program, with a hand at it and a host's line. Its time is its own.
pub struct SimulatedKnob {
    /// The board.
    pub board: SimulatedBoard<SimulatedBench<This, SharedKnob, 1>>,
    knob: SharedKnob,
    flash: &'static KnobFlash,
    ticks: u32,
    /// Whether the device asked for a person in the last tick.
    asked: bool,
    began: Instant,
    is_paced: bool,
}

impl SimulatedKnob {
    /// Bytes that a line of 500,000 baud carries in a tick, either way, with time to spare.
    const BYTES: u32 = 16;

    /// The knob's loop, without a map, at this dial, before its first tick, with this flash to keep a feel in.
    ///
    /// # Panics
    /// Flash that another knob has.
    pub fn new(knob: &SharedKnob, flash: &'static KnobFlash) -> Self {
        // It lives as long as the program, as a board's statics do.
        let servo = servo(Box::leak(Box::new(device(None))), SEARCH, PROTECTION);
        let settings = Settings { jog: Some(JOG), ..Settings::new(CLOCK_HZ) };
        let mut board = SimulatedBoard::new(This(servo), knob.clone(), &settings, ResetReason::PowerOn);
        let (kept, feel) = KeptFeels::find(flash.writer().expect("flash of its own"));
        if let Some(feel) = feel
            && board.bench.restore(feel).is_err()
        {
            kept.refused();
        }
        board.idle = board.idle.saying(SETTINGS.rate_hz, 0.0).keeping_feels(Box::leak(Box::new(kept)));
        Self { board, knob: knob.clone(), flash, ticks: 0, asked: false, began: Instant::now(), is_paced: false }
    }

    /// Limits the simulation to real time.
    #[must_use]
    pub fn paced(self) -> Self {
        Self { is_paced: true, ..self }
    }

    /// One servo period. A hand confirms what the device asks for: the button for 0.6 s.
    pub fn tick(&mut self) {
        if std::mem::take(&mut self.knob.world().resets) {
            let flash = Box::leak(Box::new(self.flash.after_reset()));
            let Self { ticks, began, is_paced, .. } = *self;
            *self = Self { ticks, began, is_paced, ..Self::new(&self.knob.clone(), flash) };
        }
        self.board.tick(Self::BYTES);
        self.ticks += 1;
        let state = self.board.bench.state();
        let felt = state.witness();
        let [angle, rate, torque] = [felt.angle().unwrap_or(f32::NAN), state.rates()[0], felt.torque()].map(f64::from);
        let mut world = self.knob.world();
        world.turns = felt.base();
        let shaft = [world.dial.angle() - TAU * f64::from(world.turns), world.dial.torque()];
        if let Some(trace) = &mut world.trace {
            trace.push([angle, rate, torque, shaft[0], shaft[1]]);
        }
        drop(world);
        let asks = self.board.bench.asks_to_confirm();
        if asks && !std::mem::replace(&mut self.asked, asks) {
            let mut world = self.knob.world();
            let now = world.dial.time();
            world.confirms_at.get_or_insert(now);
        }
        self.asked = asks;
    }

    fn passed(&self) -> Duration {
        Duration::from_secs(1) * self.ticks / SETTINGS.rate_hz as u32
    }
}

impl Line for SimulatedKnob {
    fn name(&self) -> String {
        "the simulated knob".to_owned()
    }

    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.board.wire.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self, buffer: &mut [u8], wait: Duration) -> io::Result<usize> {
        let began = self.passed();
        if wait.is_zero() && self.board.wire.from_device.is_empty() {
            self.tick();
            return Ok(0);
        }
        while self.board.wire.from_device.is_empty() && self.passed() - began < wait {
            self.tick();
        }
        if self.is_paced {
            std::thread::sleep((self.began + self.passed()).saturating_duration_since(Instant::now()));
        }
        let came = self.board.wire.from_device.len().min(buffer.len());
        for (place, byte) in buffer.iter_mut().zip(self.board.wire.from_device.drain(..came)) {
            *place = byte;
        }
        Ok(came)
    }

    fn now(&self) -> Instant {
        self.began + self.passed()
    }
}
