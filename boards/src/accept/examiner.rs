//! Main's loop of a board that is being accepted.

use crate::exercise::Runner;
use crate::exercise::tally::Tally;
use crate::outbox::Outbox;
use crate::{Felt, Mailbox, OptionBytes, Port, Settings, Watchdog, heartbeat};
use palpate::servo::{BakedTables as _, Heartbeat, ResetReason, TableCheck};
use palpate::wire::acceptance::{Counted, Failure, Finding, Identity, Line, Request, Ticks};
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::telemetry::Consumer;

/// Measures how long a tick of the script takes.
pub trait Stopwatch {
    /// The unit it counts in.
    const COUNTED: Counted;

    /// Runs `work`, which no interrupt disturbs, and gives its counts.
    fn measure(&mut self, work: impl FnOnce()) -> u32;
}

/// A board's chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chip {
    /// Its core, as the CPUID register names it.
    pub core: u32,
    /// Why it was reset.
    pub reset: ResetReason,
    /// Its option bytes, if it has any.
    pub options: OptionBytes,
}

/// Answers the host's requests, feeds the watchdog while ticks go on.
pub struct Examiner<'a, W> {
    identity: Identity,
    mailbox: &'a Mailbox,
    ticks: Consumer<'a, Ticks>,
    heartbeat: Heartbeat,
    stopwatch: W,
    receiver: Receiver<Request>,
    outbox: Outbox,
    watches: bool,
    asked: Option<Request>,
}

impl<'a, W: Stopwatch> Examiner<'a, W> {
    /// The other end of the queue and the mailbox of an [`super::Acceptance`]. It reads the tables whole: do this
    /// before the watchdog runs.
    pub fn new<F: Felt<JOINTS>, const JOINTS: usize>(
        felt: &F,
        settings: &Settings,
        chip: Chip,
        mailbox: &'a Mailbox,
        ticks: Consumer<'a, Ticks>,
        stopwatch: W,
    ) -> Self {
        let surface = felt.servo().surface();
        let identity = Identity {
            core: chip.core,
            clock: settings.clock,
            counted: W::COUNTED,
            rate: felt.servo().settings().rate_hz,
            reset: chip.reset as u8,
            table: TableCheck::read(surface),
            baked: surface.baked_crc().unwrap_or(0),
            options: chip.options.0,
        };
        Self {
            identity,
            mailbox,
            ticks,
            heartbeat: heartbeat(felt.servo().settings().rate_hz),
            stopwatch,
            receiver: Receiver::new(),
            outbox: Outbox::new(),
            watches: false,
            asked: None,
        }
    }

    /// One step. Call it continuously; if it returns a failure, fail that way.
    pub fn step(&mut self, port: &mut impl Port, watchdog: &mut impl Watchdog) -> Option<Failure> {
        self.feed(watchdog);
        if let Some(byte) = port.receive()
            && let Some(Received::Message(request)) = self.receiver.feed(byte)
        {
            self.asked = Some(request);
        }
        if self.outbox.is_empty() {
            match self.asked.take() {
                Some(Request::Identity) => self.outbox.put(&Finding::Identity(self.identity)),
                Some(Request::Watch(watches)) => self.watches = watches,
                Some(Request::Fail(failure)) => return Some(failure),
                Some(Request::Script { most }) => {
                    crate::exercise::run_by(&mut Run { of: self, port, watchdog, number: 0, longest: 0 }, most);
                    self.outbox.put(&Finding::Done);
                }
                None => {
                    if let Some(ticks) = self.ticks.dequeue()
                        && self.watches
                    {
                        self.outbox.put(&Finding::Ticks(ticks));
                    }
                }
            }
        }
        self.outbox.step(port);
        None
    }

    fn feed(&mut self, watchdog: &mut impl Watchdog) {
        if self.heartbeat.may_feed(self.mailbox.ticks()) {
            watchdog.feed();
        }
    }
}

/// The script, run for a host that waits.
struct Run<'r, 'a, W, P, D> {
    of: &'r mut Examiner<'a, W>,
    port: &'r mut P,
    watchdog: &'r mut D,
    /// Lines so far.
    number: u32,
    /// Counts of the longest tick of this lap.
    longest: u32,
}

impl<W: Stopwatch, P: Port, D: Watchdog> Runner for Run<'_, '_, W, P, D> {
    fn tick(&mut self, work: impl FnOnce()) {
        self.longest = self.longest.max(self.of.stopwatch.measure(work));
        self.of.feed(self.watchdog);
        // Its ticks are late now and then: they are not reported.
        self.of.ticks.dequeue();
    }

    fn line(&mut self, _: &'static str, tally: &Tally, is_last: bool) {
        self.of.outbox.put(&Finding::Line(Line {
            number: self.number,
            ticks: tally.ticks,
            digest: tally.digest,
            modes: tally.modes,
            phases: tally.phases,
            faults: tally.faults,
            touching: tally.touching,
            longest: self.longest,
        }));
        // A line that takes no byte at all starves nothing but the host: the watchdog is fed meanwhile.
        while !self.of.outbox.is_empty() {
            self.of.outbox.step(self.port);
            self.of.feed(self.watchdog);
        }
        self.number += 1;
        if is_last {
            self.longest = 0;
        }
    }
}
