//! The motors' supply, by the converter.

use palpate_bench::{Supply, SupplyRange};
use rp235x_hal::adc::{Adc, AdcPin};
use rp235x_hal::gpio::{FunctionNull, Pin, PullNone, bank0::Gpio26};

/// Volts at full scale: 3.3 V, behind 100 kΩ and 10 kΩ.
const FULL: f32 = 3.3 * 11.0;
/// A supply of 24 V that is on, and does not break down.
pub const RANGE: SupplyRange = SupplyRange { least: 20.0, most: 30.0 };

/// The converter and its pin.
pub struct Volts {
    /// The converter.
    pub converter: Adc,
    /// GP26.
    pub pin: AdcPin<Pin<Gpio26, FunctionNull, PullNone>>,
}

impl Supply for Volts {
    /// About 2 µs: one conversion of 12 bits.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        self.converter.read(&mut self.pin).ok().map(|reading| f32::from(reading) * (FULL / 4_095.0))
    }
}
