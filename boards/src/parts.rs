//! A board that is made of embedded-hal's parts.

use crate::sensors::{BadFrame, Sensors};
use crate::{Board, Counter, Drives, EnableInput, Lines, NotObeyed, Panel, Passive, Supply};
use embedded_hal::digital::{InputPin, OutputPin, PinState};
use palpate::device::drive::Field;
use palpate::device::{Counts, Duty};

/// The timer that raises ticks.
pub trait Timer {
    /// Takes the timer's interrupt back.
    fn acknowledge(&mut self);
}

/// A board's parts.
#[derive(Debug)]
pub struct Parts<C, I, S, D, E, T, R, V, L, const AMPLIFIERS: usize> {
    /// Times the ticks.
    pub counter: C,
    /// Raises them.
    pub timer: I,
    /// The joints' sensors, started.
    pub sensors: S,
    /// The motors' drives, released.
    pub drives: D,
    /// The person's side.
    pub lines: Lines<E, T, R, V, AMPLIFIERS>,
    /// The light, on while high.
    pub light: L,
}

impl<C, I, S, D, E, T, R, V, L, const JOINTS: usize, const AMPLIFIERS: usize> Passive<JOINTS>
    for Parts<C, I, S, D, E, T, R, V, L, AMPLIFIERS>
where
    C: Counter,
    I: Timer,
    S: Sensors<JOINTS>,
    D: Drives<JOINTS>,
    E: EnableInput,
    T: InputPin,
    R: InputPin,
    V: Supply,
    L: OutputPin,
{
    #[inline]
    fn now(&self) -> u32 {
        self.counter.now()
    }

    #[inline]
    fn acknowledge(&mut self) {
        self.timer.acknowledge();
    }

    #[inline]
    fn panel(&mut self) -> Panel {
        self.lines.read()
    }

    #[inline]
    fn read(&mut self) -> Result<[Counts; JOINTS], BadFrame> {
        self.sensors.read()
    }

    #[inline]
    fn marks(&mut self) -> [Option<Counts>; JOINTS] {
        self.sensors.marks()
    }

    #[inline]
    fn gains(&self) -> [u8; JOINTS] {
        self.sensors.gains()
    }

    #[inline]
    fn release(&mut self) -> Result<(), NotObeyed> {
        self.drives.release()
    }

    #[inline]
    fn reads_enabled(&self) -> bool {
        self.drives.reads_enabled()
    }

    #[inline]
    fn show(&mut self, lit: bool) {
        // An LED failure is ignored.
        let _ = self.light.set_state(PinState::from(lit));
    }
}

impl<C, I, S, D, E, T, R, V, L, const JOINTS: usize, const AMPLIFIERS: usize> Board<JOINTS>
    for Parts<C, I, S, D, E, T, R, V, L, AMPLIFIERS>
where
    Self: Passive<JOINTS>,
    D: Drives<JOINTS>,
{
    #[inline]
    fn aim(&mut self, fields: [Field; JOINTS]) {
        self.drives.aim(fields);
    }

    #[inline]
    fn drive(&mut self, duties: [Duty; JOINTS]) -> Result<(), NotObeyed> {
        self.drives.apply(duties)
    }
}
