//! Time: the interrupt that paces the servo, and the counter that measures it.

use cortex_m::peripheral::{NVIC, SYST, syst::SystClkSource};
use vcell::VolatileCell;

use crate::board::Board;
use crate::vectors::Position;

/// The registers of an APB timer (Arm CMSDK technical reference, "APB timer").
#[repr(C)]
struct Registers {
    control: VolatileCell<u32>,
    value: VolatileCell<u32>,
    reload: VolatileCell<u32>,
    interrupt: VolatileCell<u32>,
}

/// How far behind the first timer the second one lies.
const SECOND_TIMER: usize = 0x1000;

const ENABLE: u32 = 1;
const ENABLE_INTERRUPT: u32 = 1 << 3;

impl Board {
    fn registers(&self) -> &'static Registers {
        // SAFETY: the address is the chip's, the block is there for good, and a `VolatileCell` may be shared; main
        // writes it before the interrupt is unmasked and the handler after.
        unsafe { &*(self.timer as *const Registers) }
    }

    /// Starts the servo's interrupt, `rate` Hz; the first one comes a whole period later.
    pub fn start_timer(&self, rate: f32) {
        let timer = self.registers();
        let reload = (self.clock as f32 / rate) as u32 - 1;
        timer.reload.set(reload);
        timer.value.set(reload);
        timer.control.set(ENABLE | ENABLE_INTERRUPT);
        self.acknowledge_timer();
        NVIC::unpend(Position(self.timer_interrupt));
        // SAFETY: no critical section is broken: main does nothing from here on but sleep.
        unsafe { NVIC::unmask(Position(self.timer_interrupt)) };
    }

    /// Extends this period by a number of counts: for the tests that must detect it.
    pub fn delay_timer(&self, counts: u32) {
        let timer = self.registers();
        timer.value.set(timer.value.get() + counts);
    }

    /// Takes the interrupt back, so that the next period can raise it again.
    #[inline]
    pub fn acknowledge_timer(&self) {
        self.registers().interrupt.set(1);
    }
}

/// The second timer, which runs freely at the board's clock: what the telemetry measures time with.
pub struct Clock(&'static Registers);

// SAFETY: it only ever reads a register that counts by itself, from whichever interrupt holds it.
unsafe impl Send for Clock {}

impl Clock {
    /// Starts it.
    pub fn start(board: &Board) -> Self {
        // SAFETY: the address is the chip's, the block is there for good, and a `VolatileCell` may be shared.
        let timer = unsafe { &*((board.timer + SECOND_TIMER) as *const Registers) };
        timer.reload.set(u32::MAX);
        timer.value.set(u32::MAX);
        timer.control.set(ENABLE);
        Self(timer)
    }

    /// The count, which rises and wraps at 32 bits.
    #[inline]
    pub fn now(&self) -> u32 {
        !self.0.value.get()
    }
}

/// Counts instructions with SysTick, which runs freely at the core's clock.
///
/// Under `-icount shift=6` an instruction takes 64 ns of the emulator's time, 1.6 ticks at 25 MHz, 1.28 at 20 MHz: the
/// count is right to one instruction, and the same in every run. On a real core the same difference is cycles, not
/// instructions.
pub struct InstructionCounter {
    /// Instructions a tick of SysTick, as a fraction in lowest terms.
    instructions_per_tick: [u32; 2],
    overhead: u32,
}

/// Instructions in a second of the emulator's time under `-icount shift=6`: 64 ns each. On a real core, cycles: the
/// clock.
pub const INSTRUCTIONS_PER_SECOND: u32 = 15_625_000;

/// Instructions in a second of a chip like those of the bench boards, which a tick's deadline is counted by: 170 MHz, as
/// of a Cortex-M4F, and 2.7 cycles for each. The model of `palpate cycles` has 1.7 to 2.1 of them; the rest is for
/// memory that answers late. The emulator's own clock goes four times as slow, so that it resolves an instruction.
pub const CHIP_INSTRUCTIONS_PER_SECOND: u32 = 62_500_000;

impl InstructionCounter {
    /// Takes SysTick, so that nobody else sets it, starts it, and measures what measuring costs.
    #[inline]
    pub fn new(board: &Board, mut systick: SYST) -> Self {
        let divisor = greatest_common_divisor(INSTRUCTIONS_PER_SECOND, board.clock);
        let instructions_per_tick = [INSTRUCTIONS_PER_SECOND / divisor, board.clock / divisor];
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(MASK);
        systick.clear_current();
        systick.enable_counter();
        let mut counter = Self { instructions_per_tick, overhead: 0 };
        // The second: the first may find the counter not yet reloaded.
        counter.count(|| ());
        counter.overhead = counter.count(|| ()).1;
        counter
    }

    /// Where the counter stands, for [`Self::since`].
    #[inline(always)]
    pub fn started(&self) -> u32 {
        SYST::get_current()
    }

    /// Instructions since then, those of the reading among them.
    #[inline(always)]
    pub fn since(&self, before: u32) -> u32 {
        // SysTick counts down, 24 bits wide: right as long as the work is shorter than 0.67 s.
        let ticks = before.wrapping_sub(SYST::get_current()) & MASK;
        let [instructions, of_ticks] = self.instructions_per_tick;
        ticks * instructions / of_ticks
    }

    /// Runs `work` and gives how many instructions it took, the reading of the counter subtracted.
    #[inline]
    pub fn count<T>(&mut self, work: impl FnOnce() -> T) -> (T, u32) {
        let before = self.started();
        let result = work();
        (result, self.since(before).saturating_sub(self.overhead))
    }
}

const MASK: u32 = 0x00ff_ffff;

const fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
