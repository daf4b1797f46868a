//! The motors' supply, by the converter, which measures the chip's temperature sensor besides.

use palpate_bench::{Divider, Supply};
use rp235x_hal::adc::{Adc, AdcPin};
use rp235x_hal::gpio::{FunctionNull, FunctionSio, Pin, PullDown, PullNone, SioInput, bank0::Gpio26};
use rp235x_hal::pac::ADC;

/// GP26 without pulls.
type Gp26 = Pin<Gpio26, FunctionSio<SioInput>, PullNone>;

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// GP26, and the temperature sensor of the chip with four analogue pins ("ADC: Channels").
const PIN: u8 = 0;
const SENSOR: u8 = 4;
/// 0.706 V at 27 °C, 1.721 mV less a degree ("Temperature Sensor"): −40 to 125 °C, and a tenth of the converter's
/// reference, which is the board's 3.3 V.
const PLAUSIBLE: core::ops::RangeInclusive<u16> = 600..=1_120;
/// Looks at a conversion, of four cycles or more: it takes 2 µs.
const LOOKS: u32 = 500;

/// The converter and its pin.
pub struct Volts {
    converter: ADC,
    _pin: AdcPin<Gp26>,
}

/// GP26 as it comes from reset: its pad is isolated, and pulled down until it is given a function, whatever is written
/// to it. Some tens of kΩ beside the divider's 10 kΩ would read 24 V as some 20 V.
pub fn pin(pin: Pin<Gpio26, FunctionNull, PullDown>) -> Gp26 {
    pin.into_floating_input()
}

impl Volts {
    /// The converter, at its first conversion of the sensor.
    pub fn new(mut converter: Adc, pin: AdcPin<Gp26>) -> Self {
        let _ = converter.take_temp_sensor();
        let mut volts = Self { converter: converter.free(), _pin: pin };
        volts.convert(SENSOR);
        volts
    }

    fn convert(&mut self, channel: u8) {
        // SAFETY: four bits of a channel that there is.
        self.converter.cs().modify(|_, w| unsafe { w.ainsel().bits(channel).start_once().set_bit() });
    }

    /// The conversion, if it is over and well.
    fn reading(&self) -> Option<u16> {
        let status = self.converter.cs().read();
        let is_good = status.ready().bit_is_set() && status.err().bit_is_clear();
        is_good.then(|| self.converter.result().read().result().bits())
    }
}

impl Supply for Volts {
    /// One conversion of 2 µs; that of the sensor was started a tick ago. None if either is not over, or if the converter
    /// measures the sensor wrong.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        let sensor = self.reading();
        self.convert(PIN);
        let pin = (0..LOOKS).find_map(|_| self.reading());
        self.convert(SENSOR);
        pin.filter(|_| sensor.is_some_and(|sensor| PLAUSIBLE.contains(&sensor))).map(|pin| DIVIDER.volts(pin))
    }
}
