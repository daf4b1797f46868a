//! The timer that raises ticks.

use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::TIM7;
use stm32g4xx_hal::time::ExtU32;
use stm32g4xx_hal::timer::{CountDownTimer, Event, Timer};

use crate::body::SETTINGS;

const PERIOD_MICROSECONDS: u32 = (1e6 / SETTINGS.rate_hz) as u32;

/// It, running.
pub struct Ticks {
    timer: CountDownTimer<TIM7>,
}

impl Ticks {
    /// Starts the timer; its interrupt is still masked.
    pub fn start(timer: TIM7, rcc: &Rcc) -> Self {
        let mut timer = Timer::new(timer, &rcc.clocks).start_count_down(PERIOD_MICROSECONDS.micros());
        timer.listen(Event::TimeOut);
        Self { timer }
    }
}

impl palpate_bench::Timer for Ticks {
    #[inline]
    fn acknowledge(&mut self) {
        self.timer.clear_interrupt(Event::TimeOut);
    }
}
