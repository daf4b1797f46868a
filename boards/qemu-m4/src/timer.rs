//! Time: the interrupt that paces the servo, and the counter that measures it.

use cortex_m::peripheral::{NVIC, SYST, syst::SystClkSource};
use vcell::VolatileCell;

use crate::vectors::Interrupt;

/// The clock of the core, of its timers and of SysTick, Hz.
pub const CLOCK: u32 = 25_000_000;

/// Instructions in a second of the emulator's time under `-icount shift=6`: 64 ns each. On a real core, cycles: the clock.
pub const INSTRUCTIONS_A_SECOND: f32 = 15_625_000.0;

/// The registers of an APB timer (Arm CMSDK technical reference, "APB timer").
#[repr(C)]
struct Registers {
    control: VolatileCell<u32>,
    value: VolatileCell<u32>,
    reload: VolatileCell<u32>,
    interrupt: VolatileCell<u32>,
}

const TIMER0: *const Registers = 0x4000_0000 as *const Registers;
const ENABLE: u32 = 1;
const ENABLE_INTERRUPT: u32 = 1 << 3;

fn timer0() -> &'static Registers {
    // SAFETY: the address is the chip's (application note AN386), the block is there for good, and a `VolatileCell`
    // may be shared; main writes it before the interrupt is unmasked and the handler after.
    unsafe { &*TIMER0 }
}

/// Starts the servo's interrupt, `rate` Hz.
pub fn start(rate: f32) {
    let timer = timer0();
    let reload = (CLOCK as f32 / rate) as u32 - 1;
    timer.reload.set(reload);
    timer.value.set(reload);
    timer.control.set(ENABLE | ENABLE_INTERRUPT);
    // SAFETY: no critical section is broken: main does nothing from here on but sleep.
    unsafe { NVIC::unmask(Interrupt::TIMER0) };
}

/// Takes the interrupt back, so that the next period can raise it again.
pub fn acknowledge() {
    timer0().interrupt.set(1);
}

/// Counts instructions with SysTick, which runs freely at the core's clock.
///
/// Under `-icount shift=6` an instruction takes 64 ns of the emulator's time, 1.6 ticks of 40 ns: the count is right to
/// one instruction, and the same in every run. On a real core the same difference is cycles, not instructions.
pub struct InstructionCounter {
    overhead: u32,
}

impl InstructionCounter {
    /// Takes SysTick, so that nobody else sets it, starts it, and measures what measuring costs.
    pub fn new(mut systick: SYST) -> Self {
        systick.set_clock_source(SystClkSource::Core);
        systick.set_reload(MASK);
        systick.clear_current();
        systick.enable_counter();
        let mut counter = Self { overhead: 0 };
        // The second: the first may find the counter not yet reloaded.
        counter.count(|| ());
        counter.overhead = counter.count(|| ()).1;
        counter
    }

    /// Runs `work` and gives how many instructions it took, the reading of the counter subtracted.
    #[inline]
    pub fn count<T>(&mut self, work: impl FnOnce() -> T) -> (T, u32) {
        let before = SYST::get_current();
        let result = work();
        let after = SYST::get_current();
        // SysTick counts down, 24 bits wide: right as long as the work is shorter than 0.67 s.
        let ticks = before.wrapping_sub(after) & MASK;
        (result, (ticks * 5 / 8).saturating_sub(self.overhead))
    }
}

const MASK: u32 = 0x00ff_ffff;
