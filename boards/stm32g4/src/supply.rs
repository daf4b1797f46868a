//! The motors' supply, by the converter.

use embedded_hal::delay::DelayNs;
use palpate_bench::{Divider, Supply};
use stm32g4xx_hal::adc::config::{AdcConfig, ClockMode, SampleTime};
use stm32g4xx_hal::adc::{Adc, AdcClaim, AdcCommonExt, Configured};
use stm32g4xx_hal::gpio::{Analog, PB1};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{ADC1, ADC12_COMMON};

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// The converter and its pin.
pub struct Volts {
    converter: Adc<ADC1, Configured>,
    pin: PB1<Analog>,
}

impl Volts {
    /// The converter, calibrated and configured.
    pub fn new(
        converter: ADC1,
        common: ADC12_COMMON,
        pin: PB1<Analog>,
        delay: &mut impl DelayNs,
        rcc: &mut Rcc,
    ) -> Self {
        // 42.5 MHz. The HAL's default is the core's clock, undivided, which is more than the 60 MHz that the converter
        // takes, and a panic.
        let common = common.claim(ClockMode::AdcHclkDiv4, rcc);
        Self { converter: common.claim_and_configure(converter, AdcConfig::default(), delay), pin }
    }
}

impl Supply for Volts {
    /// About 1 µs: one conversion of 12 bits, of 37 cycles.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let reading = self.converter.convert(&self.pin, SampleTime::Cycles_24_5);
        Some(DIVIDER.volts(reading))
    }
}
