//! Set-points as pulse widths, 2 kHz: the ESCON takes 10 Hz to 5 kHz, and measures worse the faster it is.
//!
//! The break of their timer ends the widths without the program (RM0440, "Using the break function"): where the core has
//! locked up, a word of SRAM or flash is damaged, the chip's supply falls below 2.9 V, a debugger halts the core, or the
//! stop loop at PB12 opens.

use palpate::device::drive::SetPointRange;
use palpate_bench::{Breakable, dwell};
use stm32g4xx_hal::gpio::{AF6, Output, PA5, PA8, PA9, PA10, PB12};
use stm32g4xx_hal::prelude::*;
use stm32g4xx_hal::pwm::{ActiveHigh, C1, C2, C3, ComplementaryDisabled, Pwm};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{DBGMCU, PWR, RCC, SYSCFG, TIM1, tim1};
use stm32g4xx_hal::time::RateExtU32;

use crate::amplifiers::Amplifiers;
use crate::body::RATE_HZ;

/// One width.
type Width<C> = Pwm<TIM1, C, ComplementaryDisabled, ActiveHigh, ActiveHigh>;
/// The three outputs.
type Outputs = (Width<C1>, Width<C2>, Width<C3>);
/// The amplifiers on them.
type Three = Amplifiers<Width<C1>, Width<C2>, Width<C3>>;
/// The green light of the board.
pub type Light = PA5<Output>;

const FREQUENCY: u32 = 2_000;
/// As the amplifiers are configured.
pub const RANGE: SetPointRange = SetPointRange::TEN_TO_NINETY;
/// Two periods of a width.
pub const DWELL: u8 = dwell(RATE_HZ, FREQUENCY, 2);

/// The flags of breaks, which zeros clear.
const BREAKS: u32 = 1 << 7 | 1 << 8 | 1 << 13;

/// The outputs, at no width until the first command or release, behind the break. Without a wire PB12 is pulled down,
/// and does nothing.
pub fn outputs(
    timer: TIM1,
    pins: (PA8<AF6>, PA9<AF6>, PA10<AF6>),
    _stop: PB12<AF6>,
    (debug, system): (&DBGMCU, &SYSCFG),
    rcc: &mut Rcc,
) -> Outputs {
    let (mut a, mut b, mut c) = timer.pwm(pins, FREQUENCY.Hz(), rcc);
    // SAFETY: set-up alone runs; it switches a clock on, and the detector of the supply, which nobody else uses.
    unsafe {
        (*RCC::ptr()).apb2enr().modify(|_, w| w.syscfgen().set_bit());
        (*PWR::ptr()).cr2().modify(|_, w| w.pvdls().bits(6).pvde().set_bit());
    }
    system.cfgr2().modify(|_, w| w.cll().set_bit().spl().set_bit().pvdl().set_bit().eccl().set_bit());
    debug.apb2_fz().modify(|_, w| w.dbg_tim1_stop().set_bit());
    // A high level at the pin breaks, after eight samples at a 32nd of the clock: 1.5 µs. Then the outputs are low.
    // SAFETY: four bits, all of whose values are filters.
    registers().bdtr().modify(|_, w| unsafe { w.bkf().bits(0b1111).bkp().set_bit().bke().set_bit().ossi().set_bit() });
    a.enable();
    b.enable();
    c.enable();
    // The enable pins are low: a break of the program's own must end the widths, or nothing is driven at all.
    registers().egr().write(|w| w.bg().set_bit());
    assert!(registers().bdtr().read().moe().bit_is_clear(), "the break of the set-points does not work");
    take_back();
    (a, b, c)
}

/// Takes back a break that is over.
fn take_back() {
    // SAFETY: zeros clear flags, ones leave them.
    registers().sr().write(|w| unsafe { w.bits(!BREAKS) });
    registers().bdtr().modify(|_, w| w.moe().set_bit());
}

fn registers() -> &'static tim1::RegisterBlock {
    // SAFETY: set-up, then the interrupt alone use what is used here.
    unsafe { &*TIM1::ptr() }
}

/// The amplifiers behind the break.
pub type Drives = Breakable<Three>;

/// These behind the break.
pub fn guarded(amplifiers: Three) -> Drives {
    Breakable::new(amplifiers, is_broken as fn() -> bool, RATE_HZ)
}

fn is_broken() -> bool {
    let is_off = || registers().bdtr().read().moe().bit_is_clear();
    if is_off() {
        take_back();
    }
    is_off()
}
