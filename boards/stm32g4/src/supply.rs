//! The motors' supply, by the converter.

use embedded_hal::delay::DelayNs;
use palpate_bench::{Supply, SupplyRange};
use stm32g4xx_hal::adc::config::{AdcConfig, SampleTime};
use stm32g4xx_hal::adc::{Adc, AdcClaim, AdcCommonExt, Configured};
use stm32g4xx_hal::gpio::{Analog, PB1};
use stm32g4xx_hal::rcc::Rcc;
use stm32g4xx_hal::stm32::{ADC1, ADC12_COMMON};

/// Volts at full scale: 3.3 V, behind 100 kΩ and 10 kΩ.
const FULL: f32 = 3.3 * 11.0;
/// A supply of 24 V that is on, and does not break down.
pub const RANGE: SupplyRange = SupplyRange { least: 20.0, most: 30.0 };

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
        let common = common.claim(Default::default(), rcc);
        Self { converter: common.claim_and_configure(converter, AdcConfig::default(), delay), pin }
    }
}

impl Supply for Volts {
    /// About 2 µs: one conversion of 12 bits.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let reading = self.converter.convert(&self.pin, SampleTime::Cycles_24_5);
        Some(f32::from(reading) * (FULL / 4_095.0))
    }
}
