//! The servo loop with a recorder behind it, for the programs that tell of it while it runs.

use core::cell::Cell;

use cortex_m::interrupt::{Mutex, free};
use palpate::wire::Record;
use palpate::wire::telemetry::{Consumer, Queue, Recorder};

use crate::board::Board;
use crate::link::Link;
use crate::processor::Clock;
use crate::servo_loop::ServoLoop;
use crate::timer::InstructionCounter;

/// Records that wait for the sender, at most; one place of the queue stays free.
pub const PLACES: usize = 16;

/// On its way from main to the interrupt.
static HANDED_OVER: Mutex<Cell<Option<Recorder<'static>>>> = Mutex::new(Cell::new(None));

/// Main's part, before the timer is started: the interrupt's end of the queue is handed over, the other one comes back.
pub fn hand_over(board: &Board, queue: &'static mut Queue<Record, PLACES>, every: u32) -> Consumer<'static, Record> {
    let (producer, records) = queue.split();
    free(|section| HANDED_OVER.borrow(section).set(Some(Recorder::new(producer, board.clock, every))));
    records
}

/// The interrupt's part.
pub struct RecordedLoop<L> {
    servo_loop: ServoLoop<L>,
    recorder: Recorder<'static>,
    clock: Clock,
}

impl<L: Link> RecordedLoop<L> {
    /// Takes what was handed over; `None` if there is nothing.
    pub fn take(board: &Board, link: impl FnOnce() -> L) -> Option<Self> {
        let recorder = free(|section| HANDED_OVER.borrow(section).take())?;
        let counter = InstructionCounter::take(board)?;
        Some(Self { servo_loop: ServoLoop::new(board, link(), counter), recorder, clock: Clock::start(board) })
    }

    /// One tick and its telemetry.
    pub fn tick(&mut self) {
        let began = self.clock.now();
        self.servo_loop.tick();
        self.recorder.note(self.servo_loop.state(), began, self.clock.now());
    }
}
