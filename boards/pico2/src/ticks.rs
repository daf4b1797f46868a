//! The PWM slice that, used as a timer, raises ticks.

use palpate_bench::Timer;
use rp235x_hal::pwm::{FreeRunning, Pwm0, Slice};

use crate::body::SETTINGS;
use crate::chip::CLOCK;

/// Counts of the slice a tick; 16 bits hold it down to 2,289 Hz.
const PERIOD: u16 = {
    let counts = CLOCK as f32 / SETTINGS.rate_hz;
    assert!(counts <= 65_536.0, "the rate is too low for a slice without divider");
    (counts - 1.0) as u16
};

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
