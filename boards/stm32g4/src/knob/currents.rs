//! The currents of the phases A and B, by ADC2: the shield's amplifiers give half of 3.3 V at none.

use embedded_hal::delay::DelayNs;
use palpate_bench::PhaseCurrents;
use palpate_bench::knob::CURRENTS;
use palpate_stm32g4::Converters;
use stm32g4xx_hal::adc::AdcClaim;
use stm32g4xx_hal::adc::config::AdcConfig;
use stm32g4xx_hal::gpio::{Analog, PA0, PA4};
use stm32g4xx_hal::stm32::{ADC2, adc1};

/// 12 bits of 3.3 V; 10 mΩ, and an amplifier of 50.
const AMPS_PER_COUNT: f32 = 3.3 / 4_095.0 / (0.01 * 50.0);
// Half of all counts, 3.3 A, is what they show at most: a short must be above the limit before.
const _: () =
    assert!(CURRENTS.max_a <= 0.85 * 3.3, "CURRENTS.max_a is beyond the shunts' range: lower CURRENT_AT_FULL");
/// PA0 and PA4 (RM0440, "ADC1/2/3/4/5 connectivity").
const CHANNELS: [u8; 2] = [1, 17];
/// Counts without current: half of all, and a tenth more or less. The amplifiers' offsets have 0.2 %, their reference 1 %.
const PLAUSIBLE: core::ops::RangeInclusive<u32> = 1_843..=2_252;
/// Measurements without current, whose mean is the zero.
const ZEROS: u32 = 16;
/// Looks at a measurement, of five cycles or more: it takes 12 µs.
const LOOKS: u32 = 2_000;

/// The converter, its pins, and the counts without current.
pub struct Shunts {
    _pins: (PA0<Analog>, PA4<Analog>),
    zeros: Option<[f32; 2]>,
}

impl Shunts {
    /// The converter, calibrated, and its zeros, while the stage is off. Where they are implausible nothing is measured.
    pub fn new(
        converter: ADC2,
        converters: &Converters,
        pins: (PA0<Analog>, PA4<Analog>),
        delay: &mut impl DelayNs,
    ) -> Self {
        // From here on its registers are this driver's.
        let _ = converters.claim_and_configure(converter, AdcConfig::default(), delay);
        let registers = Self::registers();
        // 5.8 µs each, by which the ripple of 25 kHz is no sharp edge.
        registers.smpr1().modify(|_, w| w.smp1().cycles247_5());
        registers.smpr2().modify(|_, w| w.smp17().cycles247_5());
        let [a, b] = CHANNELS;
        // SAFETY: channels of the manual, one after the other.
        registers.jsqr().write(|w| unsafe { w.jl().bits(1).jsq1().bits(a).jsq2().bits(b) });
        Self::start();
        let mut sums = Some([0; 2]);
        for _ in 0..ZEROS {
            let counts = (0..LOOKS).find_map(|_| Self::counts());
            sums = sums.zip(counts).map(|([a, b], [x, y])| [a + u32::from(x), b + u32::from(y)]);
        }
        let sums = sums.filter(|sums| sums.iter().all(|sum| PLAUSIBLE.contains(&(sum / ZEROS))));
        Self { _pins: pins, zeros: sums.map(|sums| sums.map(|sum| sum as f32 / ZEROS as f32)) }
    }

    fn registers() -> &'static adc1::RegisterBlock {
        // SAFETY: `new` took the converter.
        unsafe { &*ADC2::ptr() }
    }

    fn start() {
        Self::registers().isr().write(|w| w.jeos().clear());
        Self::registers().cr().modify(|_, w| w.jadstart().set_bit());
    }

    /// The last measurement, if it is over; then the next is started.
    fn counts() -> Option<[u16; 2]> {
        let registers = Self::registers();
        registers.isr().read().jeos().bit_is_set().then(|| {
            let counts = [registers.jdr1().read().bits() as u16, registers.jdr2().read().bits() as u16];
            Self::start();
            counts
        })
    }
}

impl PhaseCurrents for Shunts {
    /// As they were a tick ago; the third is what the others leave.
    #[inline]
    fn amps(&mut self) -> Option<[f32; 3]> {
        let ([a, b], [zero_a, zero_b]) = Self::counts().zip(self.zeros)?;
        let (a, b) = ((f32::from(a) - zero_a) * AMPS_PER_COUNT, (f32::from(b) - zero_b) * AMPS_PER_COUNT);
        Some([a, b, -a - b])
    }
}
