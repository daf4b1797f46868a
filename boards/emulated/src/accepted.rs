//! An emulated board that is being accepted: a counter, a timer and a line. It has no sensors, no panel and no motors.

use cortex_m::interrupt::free;
use cortex_m::peripheral::SYST;
use palpate::commission::Wiring;
use palpate::device::Counts;
use palpate::servo::Servo;
use palpate::wire::acceptance::Counted;
use palpate_bench::accept::Stopwatch;
use palpate_bench::sensors::BadFrame;
use palpate_bench::{Felt, NotObeyed, Panel, Passive, Watchdog};

use crate::board::Board;
use crate::body::{Chosen, Felt as Surface, Mechanism, SERVO, WIRING};
use crate::processor::{Clock, Ticks};
use crate::timer::InstructionCounter;

/// The servo of the image.
pub struct This;

impl Felt<3> for This {
    type Surface = Surface;
    type Mechanism = Mechanism;
    type Guard = Chosen;

    #[inline(always)]
    fn servo(&self) -> &Servo<'static, Surface, Mechanism, 3, Chosen> {
        &SERVO
    }

    #[inline(always)]
    fn wiring(&self) -> Wiring<3> {
        WIRING
    }
}

/// The board.
pub struct Wired {
    board: &'static Board,
    clock: Clock,
    /// Ticks so far.
    ticks: u32,
}

impl Wired {
    /// With its clock running.
    pub fn new(board: &'static Board) -> Self {
        Self { board, clock: Clock::start(board), ticks: 0 }
    }
}

impl Passive<3> for Wired {
    fn now(&self) -> u32 {
        self.clock.now()
    }

    fn acknowledge(&mut self) {
        self.board.acknowledge_timer();
        self.ticks = self.ticks.wrapping_add(1);
        if cfg!(feature = "planted-late") && self.ticks.is_multiple_of(PLANTED) {
            self.board.delay_timer(LATE);
        }
    }

    fn panel(&mut self) -> Panel {
        Panel { enable: false, enable_disagrees: false, stop: false, ready: true, supply: None }
    }

    /// The device at rest in the middle of its workspace.
    fn read(&mut self) -> Result<[Counts; 3], BadFrame> {
        Ok([Counts(0); 3])
    }

    fn release(&mut self) -> Result<(), NotObeyed> {
        Ok(())
    }

    fn show(&mut self, _: bool) {}
}

/// One tick of this number is late.
const PLANTED: u32 = 1_000;
/// Delay of a late tick, counts of the timer: 12 µs of 250.
const LATE: u32 = 300;

/// Nobody to be fed.
pub struct NoWatchdog;

impl Watchdog for NoWatchdog {
    fn feed(&mut self) {}
}

/// Instructions, as the emulator's clock has them.
pub struct Instructions(InstructionCounter);

impl Instructions {
    /// Takes SysTick.
    pub fn new(board: &Board, systick: SYST) -> Self {
        Self(InstructionCounter::new(board, Ticks::new(systick)))
    }
}

impl Stopwatch for Instructions {
    const COUNTED: Counted = Counted::Instructions;

    #[inline(always)]
    fn measure(&mut self, work: impl FnOnce()) -> u32 {
        free(|_| self.0.count(work).1)
    }
}
