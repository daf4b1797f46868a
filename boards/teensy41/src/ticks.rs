//! The periodic timer (PIT) that raises ticks, and the counter that times them.

use imxrt_ral::gpt::GPT1;
use imxrt_ral::snvs::SNVS;
use imxrt_ral::{modify_reg, read_reg};
use palpate_bench::{Counter, Timer, tick_counts};
use teensy4_bsp::board::PERCLK_FREQUENCY;
use teensy4_bsp::hal::gpt::{ClockSource, Gpt, Mode};
use teensy4_bsp::hal::pit::{Channel::Chan0, Pit};

use crate::body::RATE_HZ;

/// Counts of the periodic timer a tick.
const PERIOD: u32 = tick_counts(PERCLK_FREQUENCY, RATE_HZ);

/// The counter that times ticks and waits (GPT1), running: 32 bits of the bus's clock, `IPG_FREQUENCY`. Copies of it
/// are the same counter.
#[derive(Clone, Copy, Debug)]
pub struct Clock(());

impl Clock {
    /// Starts it, with counting at a debugger's halt switched on.
    pub fn start(mut timer: Gpt) -> Self {
        timer.set_clock_source(ClockSource::PeripheralClock);
        timer.set_divider(1);
        timer.set_mode(Mode::FreeRunning);
        modify_reg!(imxrt_ral::gpt, Self::registers(), CR, DBGEN: 1);
        timer.enable();
        Self(())
    }

    fn registers() -> GPT1 {
        // SAFETY: `start` took the timer; from then on it is only read.
        unsafe { GPT1::instance() }
    }
}

impl Counter for Clock {
    #[inline]
    fn now(&self) -> u32 {
        read_reg!(imxrt_ral::gpt, Self::registers(), CNT)
    }
}

/// The counter of the slow oscillator (the real-time counter of SNVS, 32.768 kHz): the loop's clock comes of another one.
#[derive(Debug)]
pub struct Slow(());

/// Readings of a counter with another clock than the bus until two agree.
const READINGS: u32 = 4;

impl Slow {
    /// Hz.
    pub const FREQUENCY: u32 = 32_768;

    /// Starts it.
    pub fn start() -> Self {
        modify_reg!(imxrt_ral::snvs, Self::registers(), HPCR, RTC_EN: 1);
        Self(())
    }

    fn registers() -> SNVS {
        // SAFETY: nobody else uses its counter.
        unsafe { SNVS::instance() }
    }
}

impl Counter for Slow {
    fn now(&self) -> u32 {
        let read = || read_reg!(imxrt_ral::snvs, Self::registers(), HPRTCLR);
        let mut last = read();
        let _ = (0..READINGS).any(|_| core::mem::replace(&mut last, read()) == last);
        last
    }
}

/// It, running.
pub struct Ticks {
    timer: Pit,
}

impl Ticks {
    /// Starts the timer; its interrupt is still masked.
    pub fn start(mut timer: Pit) -> Self {
        timer.set_load_timer_value(Chan0, PERIOD);
        timer.set_interrupt_enable(Chan0, true);
        timer.enable(Chan0);
        Self { timer }
    }
}

impl Timer for Ticks {
    #[inline]
    fn acknowledge(&mut self) {
        self.timer.clear_elapsed(Chan0);
        // Else the core may leave before the flag is down, and come back at once.
        cortex_m::asm::dsb();
    }
}
