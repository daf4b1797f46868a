//! Three timers in encoder mode: the hardware counts every edge, and a tick reads three registers.

use palpate_bench::Felt;
use palpate_bench::sensors::{Readings, greatest_step};
use stm32g4xx_hal::gpio::{AF1, AF2, PA0, PA1, PB6, PB7, PC6, PC7};
use stm32g4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32g4xx_hal::stm32::{TIM2, TIM3, TIM4};

use crate::body::SETTINGS;
use crate::felt::This;
use crate::set_up::BENCH;

/// The pins, A and B of each encoder, already given to their timers.
pub type Pins = ((PA0<AF1>, PA1<AF1>), (PC6<AF2>, PC7<AF2>), (PB6<AF2>, PB7<AF2>));

/// Eight samples at an eighth of the timer's clock have to agree: 0.38 µs, against spikes of the motors. An edge of the
/// fastest hand, 25 rad/s at 16 : 1 and 2,000 counts, lasts 7.8 µs. (RM0440, "TIMx_CCMR1, input capture", IC1F.)
const FILTER: u8 = 0b1001;

/// The three encoders.
pub struct Encoders {
    timers: (TIM2, TIM3, TIM4),
    _pins: Pins,
}

/// Sets a timer to count both edges of both channels, each filtered. A macro, since each timer has a type of its own.
macro_rules! start {
    ($timer:expr) => {
        // SAFETY: four bits, all of whose values are filters.
        $timer.ccmr1_input().write(|w| unsafe { w.cc1s().ti1().cc2s().ti2().ic1f().bits(FILTER).ic2f().bits(FILTER) });
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
        start!(timers.0);
        start!(timers.1);
        start!(timers.2);
        Self { timers, _pins: pins }
    }
}

/// The greatest step between two readings of each input, counts.
pub fn steps(felt: &This) -> [i32; 3] {
    let device = felt.servo().device();
    let step = |encoder| greatest_step(&encoder, device.max_joint_rate, SETTINGS.rate, BENCH.bad_frames);
    felt.wiring().inputs(device.encoders.map(step))
}

impl Readings<3> for Encoders {
    #[inline]
    fn readings(&mut self) -> [u32; 3] {
        [self.timers.0.cnt().read().bits(), self.timers.1.cnt().read().bits(), self.timers.2.cnt().read().bits()]
    }
}
