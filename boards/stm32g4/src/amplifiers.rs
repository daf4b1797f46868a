//! The three amplifiers, as WoodenHaptics configures its ESCON 50/5: a set-point for the magnitude of the current, a
//! pin for its direction, a pin that enables.
//!
//! The set-point is a pulse width of 2 kHz, 10 % for none and 90 % for full; with the feature `analog` it is a voltage,
//! 0 V for none and 3.3 V for full, which reaches the amplifier without the millisecond that measuring a width takes.

use embedded_hal::pwm::SetDutyCycle;
use palpate::device::drive::{SetPointDrive, SetPointRange};
use palpate_bench::{Cause, Memo};
use stm32g4xx_hal::gpio::{Output, PB13, PB14, PB15, PC0, PC1, PC2};
use stm32g4xx_hal::stm32::{GPIOA, GPIOC, TIM1};

use palpate_stm32g4::MEMO;

/// The enable pins, low.
pub type Enables = (PC0<Output>, PC1<Output>, PC2<Output>);
/// The direction pins.
pub type Directions = (PB13<Output>, PB14<Output>, PB15<Output>);
/// The three, on outputs of three types.
pub type Amplifiers<A, B, C> = (
    SetPointDrive<A, PC0<Output>, PB13<Output>>,
    SetPointDrive<B, PC1<Output>, PB14<Output>>,
    SetPointDrive<C, PC2<Output>, PB15<Output>>,
);

/// The drives of these outputs. `dwell` is for how many ticks a reversal stays at no current: two periods of a width.
pub fn amplifiers<A: SetDutyCycle, B: SetDutyCycle, C: SetDutyCycle>(
    (a, b, c): (A, B, C),
    enables: Enables,
    directions: Directions,
    range: SetPointRange,
    dwell: u8,
) -> Amplifiers<A, B, C> {
    (
        SetPointDrive::with_direction(a, enables.0, directions.0, range, dwell),
        SetPointDrive::with_direction(b, enables.1, directions.1, range, dwell),
        SetPointDrive::with_direction(c, enables.2, directions.2, range, dwell),
    )
}

/// Whether any of the enable pins reads as high.
pub fn reads_enabled() -> bool {
    // SAFETY: read alone.
    unsafe { (*GPIOC::ptr()).idr().read().bits() & 0b111 != 0 }
}

/// Takes the motors' power away, by the registers. Before anything else too: a debugger may have reset the core alone,
/// and the pins are as they were.
pub fn motors_off() {
    // SAFETY: nobody else uses them meanwhile; each write takes power away.
    unsafe {
        // The three enable pins low, and every output of the timer off.
        (*GPIOC::ptr()).bsrr().write(|w| w.br0().set_bit().br1().set_bit().br2().set_bit());
        (*TIM1::ptr()).bdtr().modify(|_, w| w.moe().clear_bit());
    }
}

#[unsafe(no_mangle)]
fn palpate_motors_off(cause: Cause) {
    motors_off();
    // SAFETY: nothing else runs any more; it lights the light.
    unsafe { (*GPIOA::ptr()).bsrr().write(|w| w.bs5().set_bit()) };
    MEMO.write(Memo::new(cause));
}
