//! Messages between the interrupt and main.

use crate::letter::Letter;
use crate::writing::Writing;
use palpate::commission::Jog;
use palpate::render::Feel;
use palpate::scene::Command;
use palpate::wire::{Answer, Dial, Marked, Modes, Reading, View};
use portable_atomic::{AtomicU32, Ordering};

/// A `static` of the board: the ticks done, for the watchdog; the commands that came; what a device that is being set
/// up reads.
#[derive(Debug)]
pub struct Mailbox {
    ticks: AtomicU32,
    commands: AtomicU32,
    jog: Letter<3>,
    reading: Letter<8>,
    marked: Letter<5>,
    /// An order and its number, in 64 bytes: the longest takes 61.
    order: Letter<16>,
    /// Its outcome: the longest takes 15 bytes.
    answer: Letter<4>,
    /// The longest takes 53 bytes.
    view: Letter<14>,
    /// The longest takes 33 bytes.
    dial: Letter<9>,
    /// The longest takes 38 bytes.
    modes: Letter<10>,
    /// The feel that a host has set: the longest takes 127 bytes.
    feel: Letter<32>,
    /// Whether a view is asked for.
    looks: AtomicU32,
    /// Whether flash may be written.
    writing: Writing,
}

/// Commands that came since they were looked at last. Each means the same once or twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Commands(u32);

/// A command that means the same once or twice, by its bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Plain {
    Alive = 1 << 0,
    Stop = 1 << 1,
    Acknowledge = 1 << 2,
    SetUp = 1 << 3,
}

impl Mailbox {
    /// Empty.
    pub const fn new() -> Self {
        Self {
            ticks: AtomicU32::new(0),
            commands: AtomicU32::new(0),
            jog: Letter::new(),
            reading: Letter::new(),
            marked: Letter::new(),
            order: Letter::new(),
            answer: Letter::new(),
            view: Letter::new(),
            dial: Letter::new(),
            modes: Letter::new(),
            feel: Letter::new(),
            looks: AtomicU32::new(0),
            writing: Writing::new(),
        }
    }

    pub(crate) fn tell_ticks(&self, ticks: u32) {
        self.ticks.store(ticks, Ordering::Relaxed);
    }

    pub(crate) fn ticks(&self) -> u32 {
        self.ticks.load(Ordering::Relaxed)
    }

    pub(crate) fn put(&self, plain: Plain) {
        self.commands.fetch_or(plain as u32, Ordering::Relaxed);
    }

    pub(crate) fn put_both(&self, one: Plain, other: Plain) {
        self.commands.fetch_or(one as u32 | other as u32, Ordering::Relaxed);
    }

    pub(crate) fn put_jog(&self, jog: Jog) {
        let Jog { number, key, motor, duty } = jog;
        self.jog.put([number, key, u32::from(motor) | u32::from(duty as u16) << 16]);
    }

    /// An order on its way to the tick, which answers it.
    pub(crate) fn put_order(&self, number: u16, order: &Command) {
        self.order.put_message(&(number, order));
    }

    pub(crate) fn take_order(&self) -> Option<(u16, Command)> {
        self.order.take_message()
    }

    pub(crate) fn put_answer(&self, answer: Answer) {
        self.answer.put_message(&answer);
    }

    pub(crate) fn take_answer(&self) -> Option<Answer> {
        self.answer.take_message()
    }

    /// Asks for a view of the loop as it is after the next tick.
    pub(crate) fn look(&self) {
        self.looks.store(1, Ordering::Relaxed);
    }

    /// Whether a view is asked for; asked once, it is not any more.
    pub(crate) fn is_looked_at(&self) -> bool {
        self.looks.load(Ordering::Relaxed) != 0 && self.looks.swap(0, Ordering::Relaxed) != 0
    }

    pub(crate) const fn writing(&self) -> &Writing {
        &self.writing
    }

    pub(crate) fn tell_view(&self, view: &View) {
        self.view.put_message(view);
    }

    pub(crate) fn take_view(&self) -> Option<View> {
        self.view.take_message()
    }

    pub(crate) fn tell_modes(&self, modes: &Modes) {
        self.modes.put_message(modes);
    }

    pub(crate) fn take_modes(&self) -> Option<Modes> {
        self.modes.take_message()
    }

    pub(crate) fn tell_dial(&self, dial: &Dial) {
        self.dial.put_message(dial);
    }

    pub(crate) fn take_dial(&self) -> Option<Dial> {
        self.dial.take_message()
    }

    pub(crate) fn tell_feel(&self, feel: &Feel) {
        self.feel.put_message(feel);
    }

    pub(crate) fn take_feel(&self) -> Option<Feel> {
        self.feel.take_message()
    }

    /// Chooses a feel of a table of at most 255 ([`palpate::servo::Event::Chosen`]). Call it from
    /// one place only.
    pub fn choose(&self, index: u8) {
        self.commands.fetch_and(!(0xff << CHOSEN_SHIFT), Ordering::Relaxed);
        self.commands.fetch_or(CHOSEN | u32::from(index) << CHOSEN_SHIFT, Ordering::Relaxed);
    }

    pub(crate) fn take(&self) -> Commands {
        Commands(self.commands.swap(0, Ordering::Relaxed))
    }

    /// The newest jog since the last one taken.
    pub(crate) fn take_jog(&self) -> Option<Jog> {
        let [number, key, push] = self.jog.take()?;
        Some(Jog { number, key, motor: push as u8, duty: (push >> 16) as i16 })
    }

    pub(crate) fn tell_marked(&self, marked: &Marked) {
        let ([a, b, c], [x, y, z]) = (marked.counts.map(|count| count as u32), marked.passes.map(u32::from));
        self.marked.put([a, b, c, x | y << 16, z]);
    }

    /// The newest marks, unless they were taken before.
    pub(crate) fn take_marked(&self) -> Option<Marked> {
        let [a, b, c, first, z] = self.marked.take()?;
        let passes = [first, first >> 16, z].map(|passes| passes as u16);
        Some(Marked { counts: [a, b, c].map(|count| count as i32), passes })
    }

    pub(crate) fn tell_reading(&self, reading: &Reading) {
        let Reading { tick, number, counts: [a, b, c], duties, live, enable, refusal, hold } = *reading;
        let [x, y, z] = duties.map(|duty| u32::from(duty as u16));
        let flags = u32::from(live) | u32::from(enable) << 1 | u32::from(refusal) << 8 | u32::from(hold) << 16;
        self.reading.put([tick, number, a as u32, b as u32, c as u32, x | y << 16, z, flags]);
    }

    /// The newest reading, unless it was taken before.
    pub(crate) fn take_reading(&self) -> Option<Reading> {
        let [tick, number, a, b, c, first, z, flags] = self.reading.take()?;
        Some(Reading {
            tick,
            number,
            counts: [a, b, c].map(|count| count as i32),
            duties: [first, first >> 16, z].map(|duty| duty as i16),
            live: flags & 1 != 0,
            enable: flags & 2 != 0,
            refusal: (flags >> 8) as u8,
            hold: (flags >> 16) as u8,
        })
    }
}

impl Default for Mailbox {
    fn default() -> Self {
        Self::new()
    }
}

impl Commands {
    pub const fn has(self, command: Plain) -> bool {
        self.0 & command as u32 != 0
    }

    /// The chosen index.
    pub const fn chosen(self) -> Option<u8> {
        if self.0 & CHOSEN != 0 { Some((self.0 >> CHOSEN_SHIFT) as u8) } else { None }
    }
}

/// Something was chosen, and where its number lies; the plain commands' bits are far below.
const CHOSEN: u32 = 1 << 31;
const CHOSEN_SHIFT: u32 = 16;
