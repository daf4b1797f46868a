//! The motors' supply, by the converter, which measures its own reference besides.

use imxrt_ral::{adc::ADC1, modify_reg, read_reg, write_reg};
use palpate_bench::{Divider, Supply};
use teensy4_bsp::hal::adc::{Adc, AnalogInput, AveragingCount, ResolutionBits};

use crate::body::RATE_HZ;

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// The converter's own reference at its input ("ADC_HC0": VREFSH, for a self-test).
const REFERENCE: u32 = 25;
/// A full reading, less two hundredths.
const PLAUSIBLE: core::ops::RangeInclusive<u16> = 4_014..=4_095;
/// Looks at a conversion, of some 40 ns or more: it takes 20 µs.
const CONVERSION_LOOKS: u32 = 2_000;
/// Looks until a calibration must be over, which takes some 6 ms.
const LOOKS: u32 = 1_000_000;

/// Whether a tick waits for a conversion: 20 µs are at most a sixth of it. A faster one takes what the last two have
/// converted, the pin and the reference in turn.
const WAITS: bool = RATE_HZ <= 8_000;

/// The converter and its pin.
pub struct Volts {
    _converter: Adc,
    input: AnalogInput,
    is_calibrated: bool,
    /// Whether the pin is being converted, and the last conversions of pin and reference.
    converts_pin: bool,
    pin: Option<u16>,
    reference: Option<u16>,
}

impl Volts {
    /// A converter of 12 bits that takes single samples. One that cannot be calibrated measures nothing.
    pub fn new(mut converter: Adc, input: AnalogInput) -> Self {
        converter.set_resolution(ResolutionBits::Res12);
        converter.set_averaging(AveragingCount::Avg32);
        let is_calibrated = calibrate();
        converter.set_averaging(AveragingCount::Avg1);
        convert(REFERENCE);
        Self { _converter: converter, input, is_calibrated, converts_pin: false, pin: None, reference: None }
    }
}

fn registers() -> ADC1 {
    // SAFETY: the owner of the converter's driver calls this, and lets the driver rest.
    unsafe { ADC1::instance() }
}

fn convert(channel: u32) {
    write_reg!(imxrt_ral::adc, registers(), HC0, channel);
}

/// The conversion, if it is over.
fn reading() -> Option<u16> {
    let registers = registers();
    read_reg!(imxrt_ral::adc, registers, HS, COCO0 != 0).then(|| read_reg!(imxrt_ral::adc, registers, R0) as u16)
}

/// Calibrates the converter, and waits: the HAL starts a calibration, and aborts it by its next write.
fn calibrate() -> bool {
    let registers = registers();
    write_reg!(imxrt_ral::adc, registers, GS, CALF: 1);
    modify_reg!(imxrt_ral::adc, registers, GC, CAL: 1);
    let is_over = (0..LOOKS).any(|_| read_reg!(imxrt_ral::adc, registers, GC, CAL == 0));
    is_over && read_reg!(imxrt_ral::adc, registers, GS, CALF == 0)
}

impl Supply for Volts {
    /// Some 20 µs, by the converter's clock of 2.5 MHz; the conversion of the reference was started a tick before. None if
    /// either is not over, or if the reference is not a full reading.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        if WAITS {
            self.reference = reading();
            convert(self.input.channel());
            self.pin = (0..CONVERSION_LOOKS).find_map(|_| reading());
            convert(REFERENCE);
        } else {
            let done = reading();
            *(if self.converts_pin { &mut self.pin } else { &mut self.reference }) = done;
            self.converts_pin = !self.converts_pin;
            convert(if self.converts_pin { self.input.channel() } else { REFERENCE });
        }
        let is_good = self.is_calibrated && self.reference.is_some_and(|reference| PLAUSIBLE.contains(&reference));
        self.pin.filter(|_| is_good).map(|pin| DIVIDER.volts(pin))
    }
}
