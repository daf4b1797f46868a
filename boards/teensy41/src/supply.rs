//! The motors' supply, by the converter.

use palpate_bench::{Divider, Supply};
use teensy4_bsp::hal::adc::{Adc, AnalogInput, AveragingCount, ResolutionBits};

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// The converter and its pin.
pub struct Volts {
    converter: Adc,
    input: AnalogInput,
}

impl Volts {
    /// A converter of 12 bits that takes single samples.
    pub fn new(mut converter: Adc, input: AnalogInput) -> Self {
        converter.set_resolution(ResolutionBits::Res12);
        converter.set_averaging(AveragingCount::Avg1);
        Self { converter, input }
    }
}

impl Supply for Volts {
    /// Some 20 µs, by the converter's clock of 2.5 MHz.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let reading = self.converter.read_blocking(&mut self.input);
        Some(DIVIDER.volts(reading))
    }
}
