//! One output of FlexPWM2 as embedded-hal has it.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use imxrt_ral::pwm::PWM2;
use palpate_bench::dwell;
use teensy4_bsp::hal::flexpwm::{
    Channel, ClockSelect, FULL_RELOAD_VALUE_REGISTER, LoadMode, PairOperation, Prescaler, Pwm, SM,
};

use crate::body::RATE_HZ;

/// 2 kHz from 150 MHz / 4: the ESCON takes 10 Hz to 5 kHz, and measures worse the faster it is.
const PERIOD: u16 = 18_750;
/// Counts before a period's end, a microsecond: longer than it takes to write a width.
const NEAR: u16 = 38;
/// Looks that are longer than that.
const LOOKS: u32 = 1_000;
/// Two periods of a width, in ticks: how long a reversal stays at no current.
pub const DWELL: u8 = dwell(RATE_HZ, 2_000, 2);

/// Output A of a submodule.
pub struct PulseWidth {
    pwm: Pwm,
    submodule: SM,
}

impl PulseWidth {
    /// The output, running at no width.
    ///
    /// # Safety
    /// Each submodule at most once, and all of them in one interrupt or none: they share a control register.
    pub unsafe fn start(submodule: SM) -> Self {
        // SAFETY: as asked for above, nobody changes the shared register at the same time.
        let mut pwm = Pwm::new::<2>(unsafe { PWM2::instance() });
        // A reset of the core alone leaves what waited.
        pwm.clear_load_ok(submodule.mask());
        pwm.set_clock_select(submodule, ClockSelect::Ipg);
        pwm.set_prescaler(submodule, Prescaler::Prescaler4);
        pwm.set_pair_operation(submodule, PairOperation::Independent);
        pwm.set_load_mode(submodule, LoadMode::reload_full());
        pwm.set_load_frequency(submodule, 1);
        pwm.set_initial_count(submodule, 0);
        pwm.set_value(submodule, FULL_RELOAD_VALUE_REGISTER, PERIOD as i16 - 1);
        pwm.set_turn_on(submodule, Channel::A, 0);
        pwm.set_turn_off(submodule, Channel::A, 0);
        pwm.set_output_enable(pwm.output_enable(Channel::A) | submodule.mask(), Channel::A);
        pwm.set_load_ok(submodule.mask());
        pwm.set_run(pwm.run() | submodule.mask());
        Self { pwm, submodule }
    }

    /// Whether a width waits for the end of the period: the chip takes no other meanwhile.
    fn waits(&self) -> bool {
        self.pwm.load_ok().contains(self.submodule.mask())
    }

    /// Takes back a width that waits. One that is about to hold is waited for: widths that are taken back again and
    /// again just before the period's end, which ticks may be in step with, would never hold.
    #[inline]
    fn take_back(&mut self) {
        if self.waits() && self.pwm.sm_count(self.submodule) >= (PERIOD - NEAR) as i16 {
            let _ = (0..LOOKS).any(|_| !self.waits());
        }
        self.pwm.clear_load_ok(self.submodule.mask());
    }
}

impl ErrorType for PulseWidth {
    type Error = Infallible;
}

impl SetDutyCycle for PulseWidth {
    fn max_duty_cycle(&self) -> u16 {
        PERIOD
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        // Ticks are faster than periods.
        self.take_back();
        // At most 18,750: a positive i16. The new width holds from the next period on.
        self.pwm.set_turn_off(self.submodule, Channel::A, duty.min(PERIOD) as i16);
        self.pwm.set_load_ok(self.submodule.mask());
        Ok(())
    }
}
