//! Time: the timer that raises ticks, and the counter that times them.

use palpate_bench::Counter;
use stm32g4xx_hal::rcc::{Enable, Rcc, Reset};
use stm32g4xx_hal::stm32::{DBGMCU, LPTIMER1, RCC, TIM5, TIM7, lptimer1, tim2};

/// The counter that times ticks and waits (TIM5), running: 32 bits of the core's clock. Copies of it are the same
/// counter.
#[derive(Clone, Copy, Debug)]
pub struct Clock(());

impl Clock {
    /// Starts it, and lets it and the watchdogs go on while a debugger halts the core: OpenOCD stops the watchdogs, and
    /// a debugger leaves these bits behind until power-on.
    pub fn start(_: TIM5, debug: &DBGMCU, rcc: &mut Rcc) -> Self {
        debug
            .apb1l_fz()
            .modify(|_, w| w.dbg_tim5_stop().clear_bit().dbg_iwdg_stop().clear_bit().dbg_wwdg_stop().clear_bit());
        TIM5::enable(rcc);
        TIM5::reset(rcc);
        Self::registers().cr1().write(|w| w.cen().set_bit());
        Self(())
    }

    fn registers() -> &'static tim2::RegisterBlock {
        // SAFETY: `start` took the timer; from then on it is only read.
        unsafe { &*TIM5::ptr() }
    }
}

impl Counter for Clock {
    #[inline]
    fn now(&self) -> u32 {
        Self::registers().cnt().read().bits()
    }
}

/// The counter of the chip's own slow oscillator (LPTIM1 of LSI, 32 kHz), 16 bits: the loop's clock comes of another one
/// (HSI16).
#[derive(Debug)]
pub struct Slow(());

/// Looks until the oscillator must run, some 0.2 ms.
const LOOKS: u32 = 100_000;
/// Readings of a counter with another clock than the bus until two agree (RM0440, "LPTIM_CNT").
const READINGS: u32 = 4;

impl Slow {
    /// Hz.
    pub const FREQUENCY: u32 = 32_000;

    /// Starts it.
    pub fn start(_: LPTIMER1) -> Self {
        // SAFETY: set-up alone runs; bits of the manual that nobody else uses.
        let clocks = unsafe { &*RCC::ptr() };
        clocks.csr().modify(|_, w| w.lsion().set_bit());
        let _ = (0..LOOKS).any(|_| clocks.csr().read().lsirdy().bit_is_set());
        // SAFETY: 1 is LSI.
        clocks.ccipr().modify(|_, w| unsafe { w.lptim1sel().bits(1) });
        clocks.apb1enr1().modify(|_, w| w.lptim1en().set_bit());
        // Read back, for the clock takes two cycles.
        let _ = clocks.apb1enr1().read();
        let timer = Self::registers();
        timer.cr().write(|w| w.enable().set_bit());
        // SAFETY: the whole range.
        timer.arr().write(|w| unsafe { w.bits(0xffff) });
        timer.cr().write(|w| w.enable().set_bit().cntstrt().set_bit());
        Self(())
    }

    fn registers() -> &'static lptimer1::RegisterBlock {
        // SAFETY: `start` took the timer.
        unsafe { &*LPTIMER1::ptr() }
    }
}

impl Counter for Slow {
    fn now(&self) -> u32 {
        let read = || Self::registers().cnt().read().bits();
        let mut last = read();
        let _ = (0..READINGS).any(|_| core::mem::replace(&mut last, read()) == last);
        last
    }
}

/// The timer that raises ticks (TIM7), running.
pub struct Ticks {
    timer: TIM7,
}

impl Ticks {
    /// Starts the timer, with a tick of this number of cycles; its interrupt is still masked. Not by the HAL, whose
    /// period is a cycle longer.
    pub fn start(timer: TIM7, period: u16, rcc: &mut Rcc) -> Self {
        TIM7::enable(rcc);
        TIM7::reset(rcc);
        // SAFETY: sixteen bits, of any value.
        timer.arr().write(|w| unsafe { w.bits(u32::from(period) - 1) });
        timer.dier().write(|w| w.uie().set_bit());
        timer.cr1().write(|w| w.cen().set_bit());
        Self { timer }
    }
}

impl palpate_bench::Timer for Ticks {
    #[inline]
    fn acknowledge(&mut self) {
        self.timer.sr().write(|w| w.uif().clear_bit());
    }
}
