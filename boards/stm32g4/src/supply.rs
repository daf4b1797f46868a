//! The motors' supply, by the converter, which measures its own reference with it.

use embedded_hal::delay::DelayNs;
use palpate_bench::{Divider, Supply};
use stm32g4xx_hal::adc::config::{AdcConfig, ClockMode};
use stm32g4xx_hal::adc::{AdcClaim, AdcCommon, AdcCommonExt};
use stm32g4xx_hal::gpio::{Analog, PB1};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{ADC1, ADC12_COMMON, adc1};

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// PB1, and the chip's own reference (RM0440, "ADC1/2/3/4/5 connectivity").
const PIN: u8 = 12;
const REFERENCE: u8 = 18;
/// 1.212 V of 3.3 V, and a tenth more or less: the reference has 2 %, the board's regulator and the converter the rest.
const PLAUSIBLE: core::ops::RangeInclusive<u16> = 1_354..=1_654;

/// The clock of two converters.
pub type Converters = AdcCommon<ADC12_COMMON>;

/// Gives the converters 42.5 MHz. The HAL's default is the core's clock, undivided, which is more than the 60 MHz that
/// they take, and a panic.
pub fn converters(common: ADC12_COMMON, rcc: &mut Rcc) -> Converters {
    common.claim(ClockMode::AdcHclkDiv4, rcc)
}

/// The converter and its pin.
pub struct Volts {
    _pin: PB1<Analog>,
}

impl Volts {
    /// The converter, calibrated, configured, and at its first conversion.
    pub fn new(converter: ADC1, converters: &Converters, pin: PB1<Analog>, delay: &mut impl DelayNs) -> Self {
        // From here on its registers are this driver's.
        let _ = converters.claim_and_configure(converter, AdcConfig::default(), delay);
        // SAFETY: a bit that switches the reference to its input; the HAL's owner of the register is gone.
        unsafe { (*ADC12_COMMON::ptr()).ccr().modify(|_, w| w.vrefen().set_bit()) };
        let registers = Self::registers();
        // 5.8 µs at 42.5 MHz. The divider is a source of 9.1 kΩ; with 1 kΩ of the switch and some 10 pF of the converter
        // and its pin it is within half a step of 12 bits after nine time constants, 0.9 µs. The reference wants 4 µs
        // (data sheet DS12288, "VREFINT").
        registers.smpr2().modify(|_, w| w.smp12().cycles247_5().smp18().cycles247_5());
        // SAFETY: channels of the manual. A conversion of the pin is followed by one of the reference.
        unsafe {
            registers.sqr1().write(|w| w.l().bits(0).sq1().bits(PIN));
            registers.cfgr().modify(|_, w| w.jauto().set_bit());
            registers.jsqr().write(|w| w.jl().bits(0).jsq1().bits(REFERENCE));
        }
        registers.cr().modify(|_, w| w.adstart().set_bit());
        Self { _pin: pin }
    }

    fn registers() -> &'static adc1::RegisterBlock {
        // SAFETY: `new` took the converter.
        unsafe { &*ADC1::ptr() }
    }
}

impl Supply for Volts {
    /// As it was a tick ago, and never waits: reads the last conversion and starts the next. None if that is not over, or
    /// if the converter measures its own reference wrong.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let registers = Self::registers();
        let is_over = registers.isr().read().jeos().bit_is_set();
        let (reading, reference) = (registers.dr().read().bits() as u16, registers.jdr1().read().bits() as u16);
        if is_over {
            registers.isr().write(|w| w.jeos().clear());
            registers.cr().modify(|_, w| w.adstart().set_bit());
        }
        (is_over && PLAUSIBLE.contains(&reference)).then(|| DIVIDER.volts(reading))
    }
}
