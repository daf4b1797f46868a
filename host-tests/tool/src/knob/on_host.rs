//! The loop of the boards, compiled for the host, at a simulated dial.

use super::{JOG, KnobServo, MODULATION, PROTECTION, SEARCH, SETTINGS, device, servo};
use crate::commission::{Hands, Line};
use anyhow::bail;
use palpate::commission::Wiring;
use palpate::device::drive::Field;
use palpate::device::{Counts, Dial, Duty, ElectricalAngle};
use palpate::servo::{Guarded, Knob, ResetReason};
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Felt, Panel, Settings};
use palpate_sim::plant::DialSettings;
use palpate_sim::simulated::{AtPins, CLOCK_HZ, SimulatedBench, SimulatedBoard};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

    /// The current state of the simulated knob.
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
    fn advance(&mut self, fields: Option<[ElectricalAngle; 1]>, duties: Option<[Duty; 1]>) {
        let field = fields.zip(duties).map(|([angle], [duty])| Field { angle, duty });
        self.world().dial.advance(field.map(|field| MODULATION.widths(field).map(f64::from)));
    }
}

/// A line to the knob's loop in this very program.
pub struct KnobLine {
    board: SimulatedBoard<SimulatedBench<This, SharedKnob, 1>>,
    knob: SharedKnob,
}

impl KnobLine {
    /// The knob's loop, without a map, at this dial.
    pub fn new(knob: &SharedKnob) -> Self {
        // It lives as long as the program, as a board's statics do.
        let servo = servo(Box::leak(Box::new(device(None))), SEARCH, PROTECTION);
        let settings = Settings { jog: Some(JOG), ..Settings::new(CLOCK_HZ) };
        let board = SimulatedBoard::new(This(servo), knob.clone(), &settings, ResetReason::PowerOn);
        Self { board, knob: knob.clone() }
    }
}

impl Line for KnobLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.board.wire.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            self.board.tick(BYTES);
        }
        Ok(std::mem::take(&mut self.board.wire.from_device))
    }

    fn press(&mut self, pressed: bool) -> anyhow::Result<bool> {
        self.knob.world().enable = pressed;
        Ok(true)
    }
}
