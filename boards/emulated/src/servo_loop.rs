//! One tick: a frame in, the servo, a frame out. The timer's interrupt calls it.

use palpate::device::Counts;
use palpate::servo::{Deadline, Event, Input};
use palpate::wire::Report;
use palpate::wire::frame::{self, MAX_FRAME, Received};

use crate::board::Board;
use crate::body::{self, SERVO, SETTINGS, State};
use crate::link::{Frame, Link};
use crate::timer::{CHIP_INSTRUCTIONS_PER_SECOND, InstructionCounter};

/// Ticks in a row without any frame after which the host is taken for gone and the emulator ends, so that none is left
/// running. A real device stays, with its motors off.
const SILENT_TICKS: u32 = 5;

/// Frames looked at in one tick while late ones come.
const FRAMES_PER_TICK: u32 = 4;

/// From the sensors in hand to the duties applied; waiting for the host does not count, for a real device has its
/// sensors by it.
const DEADLINE: Deadline = Deadline::of_period(CHIP_INSTRUCTIONS_PER_SECOND as f32, SETTINGS.rate_hz);

/// The servo loop over a link.
pub struct ServoLoop<L> {
    link: L,
    state: State,
    /// The last counts of the wrist, and its angles.
    #[cfg(feature = "wrist")]
    wrist: ([i32; 3], palpate::device::WristState),
    counter: InstructionCounter,
    silent_ticks: u32,
}

impl<L: Link> ServoLoop<L> {
    /// A loop before its first tick.
    pub fn new(board: &Board, link: L, counter: InstructionCounter) -> Self {
        Self {
            link,
            state: SERVO.start_after(board.reset_reason()),
            #[cfg(feature = "wrist")]
            wrist: Default::default(),
            counter,
            silent_ticks: 0,
        }
    }

    /// One tick.
    pub fn tick(&mut self) {
        let input = self.input();
        let state = &mut self.state;
        #[cfg(feature = "wrist")]
        let wrist = &mut self.wrist;
        let ((), instructions) = self.counter.count(|| {
            #[cfg(feature = "wrist")]
            body::orient(state, wrist, input);
            body::tick(state, input);
        });
        // A real board applies the tick's output here, before anything else.
        if DEADLINE.overrun(0, instructions) {
            // After a fault the output is another: off.
            SERVO.note(state, Event::Overrun);
        }
        let mut buffer = [0; MAX_FRAME];
        if let Ok(frame) = frame::pack(&Report::new(state, instructions), &mut buffer) {
            self.link.send(frame);
        }
        if self.silent_ticks >= SILENT_TICKS {
            semihosting::process::exit(0);
        }
    }

    /// The state after the last tick.
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// The input of this tick, from the host's frames.
    fn input(&mut self) -> Input<3> {
        let mut late = false;
        for _ in 0..FRAMES_PER_TICK {
            let received = self.link.receive();
            self.silent_ticks = if received.is_none() { self.silent_ticks + 1 } else { 0 };
            if matches!(received, Some(Received::Message(_) | Received::Empty)) {
                SERVO.note(&mut self.state, Event::LinkAlive);
            }
            match received {
                Some(Received::Message(frame)) if tick_of(&frame) == self.state.ticks() => {
                    return if late { Input::Lost } else { self.input_of(frame) };
                }
                // The frame of another tick counts as lost. Reading on finds the right one behind it, else every later
                // one would be late too.
                Some(Received::Message(_)) => late = true,
                Some(Received::Damaged) => return Input::Damaged,
                Some(Received::Empty) | None => return Input::Lost,
            }
        }
        Input::Lost
    }

    fn input_of(&mut self, frame: Frame) -> Input<3> {
        #[cfg(feature = "wrist")]
        let frame = {
            self.wrist.0 = frame.wrist;
            frame.arm
        };
        Input::Sensors { counts: frame.counts.map(Counts), enable: frame.enable }
    }
}

const fn tick_of(frame: &Frame) -> u32 {
    #[cfg(feature = "wrist")]
    let frame = &frame.arm;
    frame.tick
}
