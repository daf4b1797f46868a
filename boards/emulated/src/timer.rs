//! Time: the counter that measures the servo.

use crate::board::Board;
use crate::processor::Ticks;

/// Counts instructions: under `-icount shift=6` the emulator's time is theirs, and the same in every run. On a real core
/// the same difference is cycles, not instructions.
pub struct InstructionCounter {
    ticks: Ticks,
    /// Instructions a tick, as a fraction in lowest terms.
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
    /// Takes the core's counter; `None` the second time.
    #[inline]
    pub fn take(board: &Board) -> Option<Self> {
        Ticks::take().map(|ticks| Self::new(board, ticks))
    }

    /// Measures what measuring costs.
    #[inline]
    pub(crate) fn new(board: &Board, ticks: Ticks) -> Self {
        let frequency = Ticks::frequency(board);
        let divisor = greatest_common_divisor(INSTRUCTIONS_PER_SECOND, frequency);
        let instructions_per_tick = [INSTRUCTIONS_PER_SECOND / divisor, frequency / divisor];
        let mut counter = Self { ticks, instructions_per_tick, overhead: 0 };
        // The second: the first may find the counter not yet reloaded.
        counter.count(|| ());
        counter.overhead = counter.count(|| ()).1;
        counter
    }

    /// Where the counter stands, for [`Self::since`].
    #[inline(always)]
    pub fn started(&self) -> u32 {
        self.ticks.now()
    }

    /// Instructions since then, those of the reading among them.
    #[inline(always)]
    pub fn since(&self, before: u32) -> u32 {
        let ticks = self.ticks.now().wrapping_sub(before) & Ticks::MASK;
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

const fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}
