//! The PWM slice that, used as a timer, raises ticks, and the counter that times them.

use palpate_bench::{Counter, Timer, tick_counts};
use rp235x_hal::clocks::ClocksManager;
use rp235x_hal::pac::{RESETS, TIMER0};
use rp235x_hal::pwm::{FreeRunning, Pwm0, Slice};

use crate::body::RATE_HZ;
use crate::chip::CLOCK;

/// Counts of the slice a tick; 16 bits hold it down to 2,289 Hz.
const PERIOD: u16 = {
    let counts = tick_counts(CLOCK, RATE_HZ);
    assert!(counts <= 65_536, "the rate is too low for a slice without divider");
    (counts - 1) as u16
};

/// The counter that times ticks and waits (TIMER0), running: the lower 32 bits of the core's clock. Copies of it are the
/// same counter.
#[derive(Clone, Copy, Debug)]
pub struct Clock(());

impl Clock {
    /// Starts it, with the pause at a debugger's halt switched off.
    pub fn start(timer: TIMER0, resets: &mut RESETS, clocks: &ClocksManager) -> Self {
        // Out of reset.
        let _ = rp235x_hal::Timer::new_timer0(timer, resets, clocks);
        let registers = Self::registers();
        registers.source().write(|w| w.clk_sys().clk_sys());
        registers.dbgpause().write(|w| w.dbg0().clear_bit().dbg1().clear_bit());
        Self(())
    }

    fn registers() -> &'static rp235x_hal::pac::timer0::RegisterBlock {
        // SAFETY: `start` took the timer; from then on it is only read.
        unsafe { &*TIMER0::ptr() }
    }
}

impl Counter for Clock {
    #[inline]
    fn now(&self) -> u32 {
        Self::registers().timerawl().read().bits()
    }
}

/// It, running.
pub struct Ticks {
    timer: Slice<Pwm0, FreeRunning>,
}

impl Ticks {
    /// Starts the timer; its interrupt is still masked.
    pub fn start(mut timer: Slice<Pwm0, FreeRunning>) -> Self {
        timer.set_top(PERIOD);
        timer.enable_interrupt0();
        timer.enable();
        Self { timer }
    }
}

impl Timer for Ticks {
    #[inline]
    fn acknowledge(&mut self) {
        self.timer.clear_interrupt();
    }
}
