//! The counter that times ticks, and the timer that raises them.

use palpate_bench::{Clock, Counter};
use palpate_cortex::Cycles;
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::TIM7;
use stm32g4xx_hal::time::ExtU32;
use stm32g4xx_hal::timer::{CountDownTimer, Event, Timer};

use crate::body::SETTINGS;

const PERIOD_MICROSECONDS: u32 = (1e6 / SETTINGS.rate) as u32;

/// Both.
pub struct Time {
    cycles: Cycles,
    timer: CountDownTimer<TIM7>,
}

impl Time {
    /// Starts the timer; its interrupt is still masked.
    pub fn start(cycles: Cycles, timer: TIM7, rcc: &Rcc) -> Self {
        let mut timer = Timer::new(timer, &rcc.clocks).start_count_down(PERIOD_MICROSECONDS.micros());
        timer.listen(Event::TimeOut);
        Self { cycles, timer }
    }
}

impl Counter for Time {
    #[inline]
    fn now(&self) -> u32 {
        self.cycles.now()
    }
}

impl Clock for Time {
    #[inline]
    fn acknowledge(&mut self) {
        self.timer.clear_interrupt(Event::TimeOut);
    }
}
