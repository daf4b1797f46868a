//! The periodic timer (PIT) that raises ticks, and the counter that times them.

use imxrt_ral::gpt::GPT1;
use imxrt_ral::{modify_reg, read_reg};
use palpate_bench::{Counter, Timer};
use teensy4_bsp::board::PERCLK_FREQUENCY;
use teensy4_bsp::hal::gpt::{ClockSource, Gpt, Mode};
use teensy4_bsp::hal::pit::{Channel::Chan0, Pit};

use crate::body::SETTINGS;

/// Counts of the periodic timer a tick.
const PERIOD: u32 = (PERCLK_FREQUENCY as f32 / SETTINGS.rate_hz) as u32;

/// The counter that times ticks and waits (GPT1), running: 32 bits of the bus's clock, `IPG_FREQUENCY`. Copies of it
/// are the same counter.
#[derive(Clone, Copy, Debug)]
pub struct Clock(());

impl Clock {
    /// Starts it. A debugger that halts the core would stop it, unless it is told not to.
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
