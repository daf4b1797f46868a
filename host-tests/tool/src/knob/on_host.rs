//! The loop of the boards, compiled for the host, at a simulated dial.

use crate::commission::{Hands, Line};
use anyhow::bail;
use palpate_sim::knob::{KnobFlash, SharedKnob, SimulatedKnob};

/// Ticks that the device runs while the line is looked at: two milliseconds.
const TICKS: u32 = 8;
/// Bytes that a line of 500,000 baud carries in a tick, either way, with time to spare.
const BYTES: u32 = 16;

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

/// A line to the knob's loop in this very program.
pub struct KnobLine {
    device: SimulatedKnob,
    knob: SharedKnob,
}

impl KnobLine {
    /// The knob's loop, without a map, at this dial.
    pub fn new(knob: &SharedKnob) -> Self {
        Self { device: SimulatedKnob::new(knob, Box::leak(Box::new(KnobFlash::new()))), knob: knob.clone() }
    }
}

impl Line for KnobLine {
    fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
        self.device.board.wire.to_device.extend(bytes);
        Ok(())
    }

    fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
        for _ in 0..TICKS {
            self.device.board.tick(BYTES);
        }
        Ok(std::mem::take(&mut self.device.board.wire.from_device))
    }

    fn press(&mut self, pressed: bool) -> anyhow::Result<bool> {
        self.knob.world().enable = pressed;
        Ok(true)
    }
}
