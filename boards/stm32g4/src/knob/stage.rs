//! The SimpleFOCShield: three pulse widths and the pin that enables its bridges.

use core::convert::Infallible;
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use palpate::device::drive::ThreePhase;
use palpate_bench::{Cause, Memo};
use stm32g4xx_hal::gpio::{AF1, AF2, Output, PA9, PB4, PB10, PC7};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwm::{ActiveHigh, C1, C2, C3, ComplementaryImpossible, Pwm};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{GPIOA, GPIOC, TIM2, TIM3, tim2};
use stm32g4xx_hal::time::RateExtU32;

use palpate_bench::knob::MODULATION;
use palpate_stm32g4::MEMO;

type Width<T, C> = Pwm<T, C, ComplementaryImpossible, ActiveHigh, ActiveHigh>;

/// The width of phase A, whose timer counts 32 bits. The HAL takes its period for one of as many, and makes all or nothing
/// of every width.
pub struct Wide(Width<TIM2, C3>);

impl Wide {
    fn registers(&self) -> &tim2::RegisterBlock {
        let Self(_) = self;
        // SAFETY: this owns the timer's only output.
        unsafe { &*TIM2::ptr() }
    }
}

impl ErrorType for Wide {
    type Error = Infallible;
}

impl SetDutyCycle for Wide {
    /// The cast is right: at 25 kHz it is 6,800.
    #[inline]
    fn max_duty_cycle(&self) -> u16 {
        self.registers().arr().read().bits() as u16 + 1
    }

    #[inline]
    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        // SAFETY: all 32 bits of the register.
        self.registers().ccr3().write(|w| unsafe { w.bits(u32::from(duty)) });
        Ok(())
    }
}

/// The stage.
pub type Stage = ThreePhase<Wide, Width<TIM3, C2>, Width<TIM3, C1>, PA9<Output>>;
/// The pins of the phases A, B and C, given to their timers.
pub type Pins = (PB10<AF1>, PC7<AF2>, PB4<AF2>);

/// As [`MODULATION`] has it: half a microsecond of dead time is its share of this.
const FREQUENCY: u32 = 25_000;

/// The stage, disabled. Two timers make the three widths. They need not keep step: what a phase gets is the mean over a
/// period, each by itself.
pub fn stage(timers: (TIM2, TIM3), (a, b, c): Pins, enable: PA9<Output>, rcc: &mut Rcc) -> Stage {
    let mut a = timers.0.pwm(a, FREQUENCY.Hz(), rcc);
    let (mut c, mut b) = timers.1.pwm((c, b), FREQUENCY.Hz(), rcc);
    a.enable();
    b.enable();
    c.enable();
    ThreePhase::new((Wide(a), b, c), enable, MODULATION)
}

/// Whether the enable pin reads as high.
pub fn reads_enabled() -> bool {
    // SAFETY: read alone.
    unsafe { (*GPIOA::ptr()).idr().read().idr9().bit_is_set() }
}

/// Takes the motor's power away, by the registers. Before anything else too: a debugger may have reset the core alone,
/// and the pins are as they were.
pub fn motors_off() {
    // SAFETY: nobody else uses them meanwhile, and each write takes power away: the enable pin and the chopper's low.
    unsafe {
        (*GPIOA::ptr()).bsrr().write(|w| w.br9().set_bit());
        (*GPIOC::ptr()).bsrr().write(|w| w.br1().set_bit());
    }
}

#[unsafe(no_mangle)]
fn palpate_motors_off(cause: Cause) {
    motors_off();
    MEMO.write(Memo::new(cause));
}
