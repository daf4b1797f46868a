//! The motors' supply, by the converter.

use palpate_bench::{Divider, Supply};
use rp235x_hal::adc::{Adc, AdcPin};
use rp235x_hal::gpio::{FunctionNull, Pin, PullNone, bank0::Gpio26};

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

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
        self.converter.read(&mut self.pin).ok().map(|reading| DIVIDER.volts(reading))
    }
}
