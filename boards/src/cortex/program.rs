//! The program of a board on the bench, once all is set up: the interrupt that ticks, and what runs below it.

use super::{Cycles, HandOver, ProgramCheck, core_id, fail};
use crate::accept::{Acceptance, Chip, Examiner};
use crate::{
    Bench, Board, ClocksDisagree, Felt, Idle, Mailbox, Offers, OptionBytes, Passive, Port, Settings, Watchdog,
    heartbeat,
};
use palpate::servo::ResetReason;
use palpate::wire::Record;
use palpate::wire::acceptance::Ticks;
use palpate::wire::telemetry::Consumer;

/// A loop that a timer's interrupt owns.
pub trait Ticking {
    /// The telemetry that it queues.
    type Message: 'static;

    /// A tick.
    fn tick(&mut self);
}

impl<F: Felt<JOINTS>, B: Board<JOINTS>, const JOINTS: usize> Ticking for Bench<'_, F, B, JOINTS> {
    type Message = Record;

    #[inline(always)]
    fn tick(&mut self) {
        self.tick();
    }
}

impl<F: Felt<JOINTS>, B: Passive<JOINTS>, const JOINTS: usize> Ticking for Acceptance<'_, F, B, JOINTS> {
    type Message = Ticks;

    #[inline(always)]
    fn tick(&mut self) {
        self.tick();
    }
}

/// Shared by main and the interrupt. A `static`.
pub struct Shared<L: 'static> {
    /// The loop on its way from main to the interrupt, by reference: moving it would take as much stack.
    handed_over: HandOver<&'static mut L>,
    /// The messages between them afterwards.
    pub mailbox: Mailbox,
}

impl<L> Shared<L> {
    /// Nothing handed over yet.
    pub const fn new() -> Self {
        Self { handed_over: HandOver::new(), mailbox: Mailbox::new() }
    }

    /// Main's part: hands the loop over, before the interrupt is unmasked.
    pub fn hand_over(&self, ticking: &'static mut L) {
        self.handed_over.give(ticking);
    }

    /// The interrupt's part: a tick. `taken` is where the interrupt keeps the loop: after the first tick no lock is
    /// needed.
    #[inline(always)]
    pub fn tick(&self, taken: &mut Option<&'static mut L>)
    where
        L: Ticking,
    {
        if taken.is_none() {
            *taken = self.handed_over.take();
        }
        if let Some(ticking) = taken {
            ticking.tick();
        }
    }
}

impl<L> Default for Shared<L> {
    fn default() -> Self {
        Self::new()
    }
}

/// Main's loop below the ticks, once all is set up. Main returns from setting up first: that takes most stack of all.
pub struct Below<M: 'static, P, K, S> {
    /// The telemetry of the loop.
    pub messages: Consumer<'static, M>,
    /// The core's clock, for the acceptance.
    pub cycles: Cycles,
    /// Why the chip was reset.
    pub reset: ResetReason,
    /// The chip's option bytes, if it has any, for the acceptance.
    pub options: OptionBytes,
    /// The way to a host.
    pub port: P,
    /// Compares the chip's clocks, a step each turn. If they disagree, the program panics: the motors are off at once.
    pub clocks: K,
    /// Compares the program in RAM with its images: whole before the first tick, then a few words each turn.
    pub program: ProgramCheck<2>,
    /// Starts the watchdog and the ticks: once everything that takes its time is done.
    pub start: S,
}

fn agree(clocks: Result<(), ClocksDisagree>) {
    if let Err(wrong) = clocks {
        panic!("{wrong}");
    }
}

impl<P: Port, W: Watchdog, K: FnMut() -> Result<(), ClocksDisagree>, S: FnOnce() -> W> Below<Record, P, K, S> {
    /// Serves the host, and feeds the watchdog while ticks go on.
    pub fn run(mut self, mailbox: &Mailbox, settings: &palpate::servo::Settings, offers: &impl Offers) -> ! {
        let idle = Idle::new(mailbox, self.messages, heartbeat(settings.rate_hz))
            .saying(settings.rate_hz, settings.max_force_n);
        let mut idle = offers.offer(idle);
        self.program.all();
        let mut watchdog = (self.start)();
        loop {
            idle.step(&mut self.port, &mut watchdog);
            agree((self.clocks)());
            let _ = self.program.step();
        }
    }
}

impl<P: Port, W: Watchdog, K: FnMut() -> Result<(), ClocksDisagree>, S: FnOnce() -> W> Below<Ticks, P, K, S> {
    /// Examines the board for a host.
    pub fn examine<const JOINTS: usize>(
        mut self,
        mailbox: &Mailbox,
        felt: &impl Felt<JOINTS>,
        settings: &Settings,
    ) -> ! {
        let chip = Chip { core: core_id(), reset: self.reset, options: self.options };
        let mut examiner = Examiner::new(felt, settings, chip, mailbox, self.messages, self.cycles);
        self.program.all();
        let mut watchdog = (self.start)();
        loop {
            if let Some(failure) = examiner.step(&mut self.port, &mut watchdog) {
                fail(failure);
            }
            agree((self.clocks)());
            let _ = self.program.step();
        }
    }
}
