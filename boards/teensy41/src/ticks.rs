//! The periodic timer (PIT) that raises ticks.

use palpate_bench::Timer;
use teensy4_bsp::board::PERCLK_FREQUENCY;
use teensy4_bsp::hal::pit::{Channel::Chan0, Pit};

use crate::body::SETTINGS;

/// Counts of the periodic timer a tick.
const PERIOD: u32 = (PERCLK_FREQUENCY as f32 / SETTINGS.rate_hz) as u32;

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
