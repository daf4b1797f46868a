//! The motors' supply, by the converter.

use palpate_bench::{Divider, Supply};
use rp235x_hal::adc::{Adc, AdcPin};
use rp235x_hal::gpio::{FunctionNull, FunctionSio, Pin, PullDown, PullNone, SioInput, bank0::Gpio26};

/// GP26 without pulls.
type Gp26 = Pin<Gpio26, FunctionSio<SioInput>, PullNone>;

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// The converter and its pin.
pub struct Volts {
    /// The converter.
    pub converter: Adc,
    /// GP26.
    pub pin: AdcPin<Gp26>,
}

/// GP26 as it comes from reset: its pad is isolated, and pulled down until it is given a function, whatever is written
/// to it. Some tens of kΩ beside the divider's 10 kΩ would read 24 V as some 20 V.
pub fn pin(pin: Pin<Gpio26, FunctionNull, PullDown>) -> Gp26 {
    pin.into_floating_input()
}

impl Supply for Volts {
    /// About 2 µs: one conversion of 12 bits.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        self.converter.read(&mut self.pin).ok().map(|reading| DIVIDER.volts(reading))
    }
}
