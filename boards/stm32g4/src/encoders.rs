//! Three timers in encoder mode: the hardware counts every edge, and a tick reads three registers.

use palpate::device::Counts;
use palpate::device::sensor::{Jumped, TimerCount};
use stm32g4xx_hal::gpio::{AF1, AF2, PA0, PA1, PA6, PA7, PB6, PB7};
use stm32g4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32g4xx_hal::stm32::{TIM2, TIM3, TIM4};

/// The pins, A and B of each encoder, already given to their timers.
pub type Pins = ((PA0<AF1>, PA1<AF1>), (PA6<AF2>, PA7<AF2>), (PB6<AF2>, PB7<AF2>));

/// More counts a tick than any hand makes: what is more is a glitch.
const GREATEST_STEP: i32 = 400;

/// The three encoders.
pub struct Encoders {
    timers: (TIM2, TIM3, TIM4),
    counts: [TimerCount; 3],
    _pins: Pins,
}

/// Sets a timer to count both edges of both channels, each filtered by eight samples at its clock. A macro, since each
/// timer has a type of its own.
macro_rules! start {
    ($timer:expr, $rcc:expr) => {
        $timer.ccmr1_input().write(|w| w.cc1s().ti1().cc2s().ti2().ic1f().fck_int_n8().ic2f().fck_int_n8());
        // SAFETY: 3 is encoder mode 3 in the reference manual (RM0440, TIMx_SMCR).
        $timer.smcr().write(|w| unsafe { w.sms().bits(3) });
        $timer.cr1().write(|w| w.cen().set_bit());
    };
}

impl Encoders {
    /// Starts counting.
    pub fn new(timers: (TIM2, TIM3, TIM4), pins: Pins, rcc: &mut Rcc) -> Self {
        TIM2::enable(rcc);
        TIM2::reset(rcc);
        TIM3::enable(rcc);
        TIM3::reset(rcc);
        TIM4::enable(rcc);
        TIM4::reset(rcc);
        start!(timers.0, rcc);
        start!(timers.1, rcc);
        start!(timers.2, rcc);
        Self { timers, counts: [TimerCount::new(GREATEST_STEP); 3], _pins: pins }
    }

    /// Here is zero.
    pub fn zero(&mut self) {
        self.timers.0.cnt().reset();
        self.timers.1.cnt().reset();
        self.timers.2.cnt().reset();
        self.counts = [TimerCount::new(GREATEST_STEP); 3];
    }

    /// The counts now.
    ///
    /// # Errors
    /// An encoder that jumped.
    #[inline]
    pub fn read(&mut self) -> Result<[Counts; 3], Jumped> {
        // The lower 16 bits of each; a tick is far too short for them to wrap unseen.
        let readings =
            [self.timers.0.cnt().read().bits(), self.timers.1.cnt().read().bits(), self.timers.2.cnt().read().bits()];
        let mut counts = [Counts(0); 3];
        for ((count, timer), reading) in counts.iter_mut().zip(&mut self.counts).zip(readings) {
            *count = timer.count(reading)?;
        }
        Ok(counts)
    }
}
