//! The lines of the person's side, read so that whatever breaks stops.

use crate::Panel;
use crate::interlock::ticks;
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

/// A reading of the enable input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pressed {
    /// Force is requested.
    pub is_pressed: bool,
    /// Its two channels differ: it is not pressed then.
    pub disagrees: bool,
}

/// The enable input.
pub trait EnableInput {
    /// Reads every pin of it. Once a tick.
    fn read(&mut self) -> Pressed;
}

/// A button with one contact.
#[derive(Debug)]
pub struct OneChannel<P> {
    /// Its pin.
    pub pin: P,
    /// The level while it is pressed.
    pub pressed_level: bool,
}

impl<P: InputPin> OneChannel<P> {
    #[inline]
    fn is_pressed(&mut self) -> bool {
        self.pin.is_high().unwrap_or(!self.pressed_level) == self.pressed_level
    }
}

impl<P: InputPin> EnableInput for OneChannel<P> {
    #[inline]
    fn read(&mut self) -> Pressed {
        Pressed { is_pressed: self.is_pressed(), disagrees: false }
    }
}

/// Seconds for which two contacts of a button may differ: they do not close in the same moment. Safety relays allow as
/// much.
const DISCREPANCY_S: f32 = 0.5;

/// A button with two contacts, as ISO 13849-1 wants of category 3: force needs both, so one that is welded or shorted
/// cannot ask for it. Contacts that differ for longer than half a second disagree until both have been seen released.
#[derive(Debug)]
pub struct TwoChannels<A, B> {
    first: OneChannel<A>,
    second: OneChannel<B>,
    /// Ticks in a row in which they differed.
    apart: u32,
    max_apart: u32,
    disagrees: bool,
}

impl<A, B> TwoChannels<A, B> {
    /// These contacts, in a loop of `rate` Hz.
    pub const fn new(first: OneChannel<A>, second: OneChannel<B>, rate: f32) -> Self {
        Self { first, second, apart: 0, max_apart: ticks(DISCREPANCY_S, rate), disagrees: false }
    }
}

impl<A: InputPin, B: InputPin> EnableInput for TwoChannels<A, B> {
    #[inline]
    fn read(&mut self) -> Pressed {
        let both = [self.first.is_pressed(), self.second.is_pressed()];
        self.apart = if both[0] == both[1] { 0 } else { self.apart.saturating_add(1) };
        self.disagrees = self.apart > self.max_apart || (self.disagrees && both != [false; 2]);
        Pressed { is_pressed: both == [true; 2] && !self.disagrees, disagrees: self.disagrees }
    }
}

/// The lines, and the level that each has where its wire is broken:
///
/// | line | wired | says | broken |
/// |---|---|---|---|
/// | enable | a button, open unless pressed; pulled to the other level | pressed at `pressed_level` | released |
/// | stop | a contact to ground that opens when pressed; pulled up | pressed at high | pressed |
/// | ready | given or pulled up by the amplifier from its own supply; pulled down | ready at high | not ready |
///
/// A pin that cannot be read is a broken wire.
#[derive(Debug)]
pub struct Lines<E, T, R, V, const AMPLIFIERS: usize> {
    /// The enable button: [`OneChannel`] or [`TwoChannels`].
    pub enable: E,
    /// The stop button.
    pub stop: T,
    /// One from each amplifier.
    pub ready: [R; AMPLIFIERS],
    /// The motors' supply.
    pub supply: V,
}

impl<E: EnableInput, T: InputPin, R: InputPin, V: Supply, const AMPLIFIERS: usize> Lines<E, T, R, V, AMPLIFIERS> {
    /// Their levels now.
    #[inline]
    pub fn read(&mut self) -> Panel {
        let enable = self.enable.read();
        let mut ready = true;
        for line in &mut self.ready {
            ready &= line.is_high().unwrap_or(false);
        }
        Panel {
            enable: enable.is_pressed,
            enable_disagrees: enable.disagrees,
            stop: self.stop.is_high().unwrap_or(true),
            ready,
            supply: self.supply.volts(),
        }
    }
}
