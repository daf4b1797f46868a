//! The motors' supply, by the converter.

use imxrt_ral::{adc::ADC1, modify_reg, read_reg, write_reg};
use palpate_bench::{Divider, Supply};
use teensy4_bsp::hal::adc::{Adc, AnalogInput, AveragingCount, ResolutionBits};

/// 12 bits of 3.3 V, behind 100 kΩ and 10 kΩ.
const DIVIDER: Divider = Divider::new(4_095, 3.3, 100e3, 10e3);

/// Looks until a calibration must be over, which takes some 6 ms.
const LOOKS: u32 = 1_000_000;

/// The converter and its pin.
pub struct Volts {
    converter: Adc,
    input: AnalogInput,
    is_calibrated: bool,
}

impl Volts {
    /// A converter of 12 bits that takes single samples. One that cannot be calibrated measures nothing.
    pub fn new(mut converter: Adc, input: AnalogInput) -> Self {
        converter.set_resolution(ResolutionBits::Res12);
        converter.set_averaging(AveragingCount::Avg32);
        let is_calibrated = calibrate();
        converter.set_averaging(AveragingCount::Avg1);
        Self { converter, input, is_calibrated }
    }
}

/// Calibrates the converter, and waits: the HAL starts a calibration, and aborts it by its next write.
fn calibrate() -> bool {
    // SAFETY: the owner of the converter's driver calls this, and uses it only afterwards.
    let registers = unsafe { ADC1::instance() };
    write_reg!(imxrt_ral::adc, registers, GS, CALF: 1);
    modify_reg!(imxrt_ral::adc, registers, GC, CAL: 1);
    let is_over = (0..LOOKS).any(|_| read_reg!(imxrt_ral::adc, registers, GC, CAL == 0));
    is_over && read_reg!(imxrt_ral::adc, registers, GS, CALF == 0)
}

impl Supply for Volts {
    /// Some 20 µs, by the converter's clock of 2.5 MHz.
    #[inline]
    fn volts(&mut self) -> Option<f32> {
        self.is_calibrated.then(|| DIVIDER.volts(self.converter.read_blocking(&mut self.input)))
    }
}
