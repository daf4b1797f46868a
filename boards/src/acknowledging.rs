//! Stop, pressed and let go of: what acknowledges a reset that is a fault.

use crate::Panel;

/// Seconds for which stop must be pressed, and then let go of, without a break: a hand does, noise does not.
const HELD: f32 = 0.05;

/// How far somebody has come with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Acknowledging {
    stage: Stage,
    /// Ticks in a row in which stop is where the next stage wants it.
    ticks: u32,
    /// And how many make that stage.
    held: u32,
    /// Whether enable was pressed meanwhile.
    was_enabled: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Stop has not been seen released since the reset: it was pressed before.
    NotYet,
    /// Stop was released.
    Released,
    /// Stop was pressed since.
    Pressed,
}

impl Acknowledging {
    /// Nothing pressed yet, in a loop of `rate` Hz.
    pub const fn new(rate: f32) -> Self {
        // The cast saturates.
        Self { stage: Stage::NotYet, ticks: 0, held: (HELD * rate) as u32, was_enabled: false }
    }

    /// A tick: whether the reset is acknowledged with it. Not while enable is pressed: that asks for force.
    #[inline]
    pub const fn next(&mut self, panel: &Panel) -> bool {
        let wants = matches!(self.stage, Stage::Released);
        if panel.stop != wants {
            (self.ticks, self.was_enabled) = (0, false);
            return false;
        }
        self.was_enabled |= panel.enable;
        self.ticks = self.ticks.saturating_add(1);
        if self.ticks < self.held {
            return false;
        }
        let is_acknowledged = matches!(self.stage, Stage::Pressed) && !self.was_enabled;
        self.stage = if wants { Stage::Pressed } else { Stage::Released };
        (self.ticks, self.was_enabled) = (0, false);
        is_acknowledged
    }
}
