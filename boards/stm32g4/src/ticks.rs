//! Time: the timer that raises ticks, and the counter that times them.

use palpate_bench::Counter;
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32g4xx_hal::stm32::{DBGMCU, TIM5, TIM7, tim2};
use stm32g4xx_hal::time::ExtU32;
use stm32g4xx_hal::timer::{CountDownTimer, Event, Timer};

/// The counter that times ticks and waits (TIM5), running: 32 bits of the core's clock. Copies of it are the same
/// counter.
#[derive(Clone, Copy, Debug)]
pub struct Clock(());

impl Clock {
    /// Starts it, and lets it and the watchdogs go on while a debugger halts the core: OpenOCD stops the watchdogs, and
    /// a debugger leaves these bits behind until power-on.
    pub fn start(_: TIM5, debug: &DBGMCU, rcc: &mut Rcc) -> Self {
        debug
            .apb1l_fz()
            .modify(|_, w| w.dbg_tim5_stop().clear_bit().dbg_iwdg_stop().clear_bit().dbg_wwdg_stop().clear_bit());
        TIM5::enable(rcc);
        TIM5::reset(rcc);
        Self::registers().cr1().write(|w| w.cen().set_bit());
        Self(())
    }

    fn registers() -> &'static tim2::RegisterBlock {
        // SAFETY: `start` took the timer; from then on it is only read.
        unsafe { &*TIM5::ptr() }
    }
}

impl Counter for Clock {
    #[inline]
    fn now(&self) -> u32 {
        Self::registers().cnt().read().bits()
    }
}

/// The timer that raises ticks (TIM7), running.
pub struct Ticks {
    timer: CountDownTimer<TIM7>,
}

impl Ticks {
    /// Starts the timer at `rate_hz`; its interrupt is still masked.
    pub fn start(timer: TIM7, rate_hz: f32, rcc: &Rcc) -> Self {
        let period_us = (1e6 / rate_hz) as u32;
        let mut timer = Timer::new(timer, &rcc.clocks).start_count_down(period_us.micros());
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
