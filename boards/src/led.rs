//! The field of a motor with three phases, led round while it is jogged.

use palpate::device::{Duty, ElectricalAngle};

/// Ticks of an electrical turn, at least: a sixth of a turn a tick and more is no field that a rotor follows.
const MIN_TURN_TICKS: u32 = 64;

/// Where the field is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Led {
    turn_ticks: u32,
    /// Ticks that it was led on, less those that it was led back.
    ticks: i32,
}

impl Led {
    /// A field that takes this number of ticks for an electrical turn; `None` for fewer than 64.
    pub const fn try_new(turn_ticks: u32) -> Option<Self> {
        if turn_ticks >= MIN_TURN_TICKS { Some(Self { turn_ticks, ticks: 0 }) } else { None }
    }

    /// Leads it on for a tick, the way of the duty's sign. Without a duty it stands.
    pub const fn on(&mut self, Duty(duty): Duty) {
        self.ticks = self.ticks.wrapping_add(duty.signum() as i32);
    }

    /// How far it has been led, 65,536ths of an electrical turn.
    pub const fn gone(&self) -> i32 {
        // Below 2⁴⁷ before the division. The cast wraps, by whole electrical turns.
        ((self.ticks as i64) * 65_536).div_euclid(self.turn_ticks as i64) as i32
    }

    /// Where it is.
    pub const fn angle(&self) -> ElectricalAngle {
        ElectricalAngle(self.gone() as u16)
    }
}
