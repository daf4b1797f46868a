//! The tick of a board that is being accepted.

use crate::sensors::BadFrame;
use crate::{Felt, Mailbox, Passive, Settings, State};
use palpate::servo::{Deadline, FrameBridge, Input, ResetReason};
use palpate::wire::acceptance::{Ticks, panel};
use palpate::wire::telemetry::Producer;

/// Frames a second.
const FRAMES: u32 = 10;

/// The loop without its motors, which the timer's interrupt owns. It reads the sensors and runs the servo as
/// [`crate::Bench`] does, and lets go of the motors in every tick, whatever the servo asks for.
pub struct Acceptance<'a, F: Felt<JOINTS>, B, const JOINTS: usize> {
    felt: F,
    board: B,
    state: State<F, JOINTS>,
    bridge: FrameBridge<JOINTS>,
    deadline: Deadline,
    mailbox: &'a Mailbox,
    queue: Producer<'a, Ticks>,
    /// The next message.
    next: Ticks,
    /// Ticks since the last frame.
    waited: u32,
    /// Bad frames in a row, now.
    in_a_row: u32,
    /// The counter at the last tick's interrupt.
    began: Option<u32>,
    /// Of the loop, Hz.
    rate: u32,
}

const fn first(number: u32, next: Ticks) -> Ticks {
    Ticks { number, shortest: u32::MAX, longest: 0, took: 0, ..next }
}

impl<'a, F: Felt<JOINTS>, B: Passive<JOINTS>, const JOINTS: usize> Acceptance<'a, F, B, JOINTS> {
    /// A loop before its first tick, on a board whose motors are off. It reads the tables whole: do this before the
    /// watchdog runs.
    pub fn new(
        felt: F,
        board: B,
        settings: &Settings,
        reset: ResetReason,
        queue: Producer<'a, Ticks>,
        mailbox: &'a Mailbox,
    ) -> Self {
        let rate = felt.servo().settings().rate_hz;
        // A reset that is a fault is reported, and stops nothing here: there is no force that it could keep away.
        let reset = if reset.fault().is_some() { ResetReason::Unknown } else { reset };
        Self {
            board,
            state: felt.servo().start_after(reset),
            bridge: FrameBridge::new(settings.bad_frames),
            deadline: Deadline::of_period(settings.clock as f32, rate),
            mailbox,
            queue,
            next: first(0, Ticks::default()),
            waited: 0,
            in_a_row: 0,
            began: None,
            // At least 1 Hz, and below 2³² by far.
            rate: rate as u32,
            felt,
        }
    }

    /// One tick, from the timer's interrupt.
    #[inline]
    pub fn tick(&mut self) {
        let began = self.board.now();
        self.board.acknowledge();
        let panel = self.board.panel();
        let read = self.board.read();
        self.count(read.err());
        let input = match read {
            Ok(counts) => {
                for (highest, gain) in self.next.gains.iter_mut().zip(self.felt.wiring().joints(self.board.gains())) {
                    *highest = gain.max(*highest);
                }
                Input::Sensors { counts: self.felt.wiring().joints(counts), enable: panel.enable }
            }
            Err(bad) => bad.input(),
        };
        let input = self.bridge.input(self.felt.servo(), &self.state, input, panel.enable);
        // This image has no way to drive a motor.
        let _ = self.felt.servo().tick(&mut self.state, input);
        // A pin that fails is ignored: nothing has ever set it.
        let _ = self.board.release();

        self.next.panel = if panel.enable { panel::ENABLE } else { 0 }
            | if panel.stop { panel::STOP } else { 0 }
            | if panel.ready { panel::READY } else { 0 };
        // The cast saturates, and takes NaN for 0.
        self.next.supply = panel.supply.map_or(0, |volts| (volts * 1e3) as u32);
        self.time(began);
        let is_lit = self.next.ticks % self.rate < self.rate / 2;
        self.board.show(is_lit);
    }

    /// The state after the last tick.
    pub const fn state(&self) -> &State<F, JOINTS> {
        &self.state
    }

    /// The board.
    pub const fn board(&mut self) -> &mut B {
        &mut self.board
    }

    #[inline]
    fn count(&mut self, bad: Option<BadFrame>) {
        let Some(bad) = bad else {
            self.in_a_row = 0;
            return;
        };
        let [absent, damaged, jumped, magnet, frozen] = &mut self.next.bad;
        let kind = match bad {
            BadFrame::Absent => absent,
            BadFrame::Damaged => damaged,
            BadFrame::Jumped => jumped,
            BadFrame::Magnet => magnet,
            BadFrame::Frozen => frozen,
        };
        *kind = kind.saturating_add(1);
        self.in_a_row = self.in_a_row.saturating_add(1);
        self.next.in_a_row = self.next.in_a_row.max(self.in_a_row);
    }

    #[inline]
    fn time(&mut self, began: u32) {
        if let Some(last) = self.began.replace(began) {
            let period = began.wrapping_sub(last);
            self.next.shortest = self.next.shortest.min(period);
            self.next.longest = self.next.longest.max(period);
        }
        let ended = self.board.now();
        self.next.took = self.next.took.max(ended.wrapping_sub(began));
        self.next.overruns = self.next.overruns.wrapping_add(u32::from(self.deadline.overrun(began, ended)));
        (self.next.began, self.next.ticks) = (began, self.next.ticks.wrapping_add(1));
        self.mailbox.tell_ticks(self.next.ticks);
        self.waited = self.waited.saturating_add(1);
        // A full queue is tried again in the next tick, and no measurement is lost.
        if self.waited >= self.rate / FRAMES && self.queue.enqueue(self.next).is_ok() {
            (self.next, self.waited) = (first(self.next.number.wrapping_add(1), self.next), 0);
        }
    }
}
