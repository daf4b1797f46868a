//! Three timers in encoder mode: the hardware counts every edge, and catches its count at the rising edge of an index
//! mark. A tick reads three counts, and asks three times whether one was caught.

use palpate_bench::sensors::Readings;
use stm32g4xx_hal::gpio::{AF1, AF2, PA0, PA1, PB6, PB7, PB9, PB10, PC6, PC7, PC8};
use stm32g4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32g4xx_hal::stm32::{TIM2, TIM3, TIM4};

/// The pins, A, B and index of each encoder, already given to their timers.
pub type Pins = ((PA0<AF1>, PA1<AF1>, PB10<AF1>), (PC6<AF2>, PC7<AF2>, PC8<AF2>), (PB6<AF2>, PB7<AF2>, PB9<AF2>));

/// Eight samples at an eighth of the timer's clock have to agree: 0.38 µs, against spikes of the motors. An edge of the
/// fastest hand, 25 rad/s at 16 : 1 and 2,000 counts, lasts 7.8 µs. (RM0440, "TIMx_CCMR1, input capture", IC1F.)
const FILTER: u8 = 0b1001;

/// The three encoders.
pub struct Encoders {
    timers: (TIM2, TIM3, TIM4),
    _pins: Pins,
}

/// Sets a timer to count both edges of both channels and to catch its count at the index, all filtered. A macro, since
/// each timer has a type of its own.
macro_rules! start {
    ($timer:expr, $catches:ident) => {
        // SAFETY: four bits, all of whose values are filters.
        $timer.ccmr1_input().write(|w| unsafe { w.cc1s().ti1().cc2s().ti2().ic1f().bits(FILTER).ic2f().bits(FILTER) });
        // SAFETY: as above. The third channel of two timers, the fourth of one: what is no index is never caught.
        $timer.ccmr2_input().write(|w| unsafe { w.cc3s().ti3().cc4s().ti4().ic3f().bits(FILTER).ic4f().bits(FILTER) });
        $timer.ccer().write(|w| w.$catches().set_bit());
        // SAFETY: 3 is encoder mode 3 in the reference manual (RM0440, TIMx_SMCR).
        $timer.smcr().write(|w| unsafe { w.sms().bits(3) });
        $timer.cr1().write(|w| w.cen().set_bit());
    };
}

impl Encoders {
    /// Starts counting, from zero.
    pub fn new(timers: (TIM2, TIM3, TIM4), pins: Pins, rcc: &mut Rcc) -> Self {
        TIM2::enable(rcc);
        TIM2::reset(rcc);
        TIM3::enable(rcc);
        TIM3::reset(rcc);
        TIM4::enable(rcc);
        TIM4::reset(rcc);
        start!(timers.0, cc3e);
        start!(timers.1, cc3e);
        start!(timers.2, cc4e);
        Self { timers, _pins: pins }
    }
}

impl Readings<3> for Encoders {
    #[inline]
    fn readings(&mut self) -> [u32; 3] {
        [self.timers.0.cnt().read().bits(), self.timers.1.cnt().read().bits(), self.timers.2.cnt().read().bits()]
    }

    #[inline]
    fn caught(&mut self) -> [Option<u32>; 3] {
        let (a, b, c) = &self.timers;
        // Reading what was caught takes its flag down (RM0440, TIMx_SR, CC1IF).
        [
            a.sr().read().cc3if().bit_is_set().then(|| a.ccr3().read().bits()),
            b.sr().read().cc3if().bit_is_set().then(|| b.ccr3().read().bits()),
            c.sr().read().cc4if().bit_is_set().then(|| c.ccr4().read().bits()),
        ]
    }
}
