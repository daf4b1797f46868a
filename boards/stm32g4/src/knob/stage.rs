//! The SimpleFOCShield: three pulse widths and the pin that enables its bridges.

use palpate::device::drive::ThreePhase;
use palpate_bench::{Cause, Memo};
use stm32g4xx_hal::gpio::{AF1, AF2, Output, PA9, PB4, PB10, PC7};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwm::{ActiveHigh, C1, C2, C3, ComplementaryImpossible, Pwm};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{GPIOA, TIM2, TIM3};
use stm32g4xx_hal::time::RateExtU32;

use palpate_bench::knob::MODULATION;
use palpate_stm32g4::MEMO;

type Width<T, C> = Pwm<T, C, ComplementaryImpossible, ActiveHigh, ActiveHigh>;
/// The stage.
pub type Stage = ThreePhase<Width<TIM2, C3>, Width<TIM3, C2>, Width<TIM3, C1>, PA9<Output>>;
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
    ThreePhase::new((a, b, c), enable, MODULATION)
}

/// Whether the enable pin reads as high.
pub fn reads_enabled() -> bool {
    // SAFETY: read alone.
    unsafe { (*GPIOA::ptr()).idr().read().idr9().bit_is_set() }
}

/// Takes the motor's power away, by the registers. Before anything else too: a debugger may have reset the core alone,
/// and the pins are as they were.
pub fn motors_off() {
    // SAFETY: nobody else uses it meanwhile, and the write takes power away: the enable pin low.
    unsafe { (*GPIOA::ptr()).bsrr().write(|w| w.br9().set_bit()) };
}

#[unsafe(no_mangle)]
fn palpate_motors_off(cause: Cause) {
    motors_off();
    MEMO.write(Memo::new(cause));
}
