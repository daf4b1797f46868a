//! The lines of the person's side, read so that whatever breaks stops.

use crate::Panel;
use embedded_hal::digital::InputPin;

/// Measures the motors' supply.
pub trait Supply {
    /// The supply, V; `None` if it cannot be measured.
    fn volts(&mut self) -> Option<f32>;
}

/// Two resistors that divide the supply for a converter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divider {
    volts_per_count: f32,
}

impl Divider {
    /// A converter that reads `counts` at `full` volts, behind a resistor to the supply and one to ground, Ω.
    pub const fn new(counts: u16, full: f32, to_supply: f32, to_ground: f32) -> Self {
        Self { volts_per_count: full * (to_supply + to_ground) / to_ground / counts as f32 }
    }

    /// The supply, V, of a reading.
    #[inline]
    pub fn volts(self, reading: u16) -> f32 {
        f32::from(reading) * self.volts_per_count
    }
}

/// A board that does not measure the supply.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoSupply;

impl Supply for NoSupply {
    fn volts(&mut self) -> Option<f32> {
        None
    }
}

/// The lines, and the level that each has where its wire is broken:
///
/// | line | wired | says | broken |
/// |---|---|---|---|
/// | enable | a button, open unless pressed; pulled to the other level | pressed at `enable_level` | released |
/// | stop | a contact to ground that opens when pressed; pulled up | pressed at high | pressed |
/// | ready | given or pulled up by the amplifier from its own supply; pulled down | ready at high | not ready |
///
/// A pin that cannot be read is a broken wire.
#[derive(Debug)]
pub struct Lines<E, T, R, V, const AMPLIFIERS: usize> {
    /// The enable button.
    pub enable: E,
    /// Its level while it is pressed.
    pub enable_level: bool,
    /// The stop button.
    pub stop: T,
    /// One from each amplifier.
    pub ready: [R; AMPLIFIERS],
    /// The motors' supply.
    pub supply: V,
}

impl<E: InputPin, T: InputPin, R: InputPin, V: Supply, const AMPLIFIERS: usize> Lines<E, T, R, V, AMPLIFIERS> {
    /// Their levels now.
    #[inline]
    pub fn read(&mut self) -> Panel {
        let level = self.enable.is_high().unwrap_or(!self.enable_level);
        let mut ready = true;
        for line in &mut self.ready {
            ready &= line.is_high().unwrap_or(false);
        }
        Panel {
            enable: level == self.enable_level,
            stop: self.stop.is_high().unwrap_or(true),
            ready,
            supply: self.supply.volts(),
        }
    }
}
