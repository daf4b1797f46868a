//! Device, body, settings and pins of the examples, on an STM32G474 at the 16 MHz it has after reset: the part to
//! replace by your own. For bridges that take a pulse width of 0 to 100 % and a direction; not for the tutorial's
//! ESCONs, which take 10 to 90 %.
//!
//! Encoders on TIM2 to TIM4, pulse widths of TIM1 on PA8 to PA10 with their directions on PB13 to PB15, enable lines on
//! PC0 to PC2 (high enables), the button that asks for force on PC13 (high while pressed). Each enable line needs a
//! pull-down resistor: a reset releases the pins.

use cortex_m_rt::{ExceptionFrame, exception};
pub use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, Duty};
use palpate::math::vec3;
use palpate::servo::{Input, ResetReason, Settings, recommended};
use stm32g4xx_hal::stm32::Peripherals;

/// The tables of a body, baked when the program is built.
pub mod body {
    include!(env!("PALPATE_BODY_FILE"));
}

/// The loop's settings: 2 kHz leave 8,000 cycles a tick.
pub const SETTINGS: Settings = Settings {
    rate_hz: 2_000.0,
    body_origin_m: vec3(-0.05, -0.05, -0.06),
    ..recommended::WOODEN_HAPTICS_2016.settings
};

/// Counts of TIM1 a period: 16 kHz.
const PERIOD: u32 = 1_000;

/// The board; what a tick reads and writes.
pub struct Board {
    chip: Peripherals,
    /// Whether the button was seen released since the reset: one that is held from then on asks for nothing.
    was_released: bool,
    /// Whether the last tick ended after the next one was due.
    overran: bool,
}

impl Board {
    /// Everything set up, the motors disabled.
    pub fn new(chip: Peripherals) -> Self {
        motors_off();
        chip.RCC.ahb2enr().modify(|_, w| w.gpioaen().set_bit().gpioben().set_bit().gpiocen().set_bit());
        chip.RCC.apb2enr().modify(|_, w| w.tim1en().set_bit());
        chip.RCC
            .apb1enr1()
            .modify(|_, w| w.tim2en().set_bit().tim3en().set_bit().tim4en().set_bit().tim7en().set_bit());
        // SAFETY: values of the reference manual (RM0440) for the pins and timers named above, which only `Board` uses.
        unsafe {
            chip.GPIOC.moder().modify(|r, w| w.bits(r.bits() & !0x0c00_f03f | 0xa015));
            chip.GPIOB.moder().modify(|r, w| w.bits(r.bits() & !0xfc00_f000 | 0x5400_a000));
            chip.GPIOB.afrl().modify(|r, w| w.bits(r.bits() & 0x00ff_ffff | 0x2200_0000));
            chip.GPIOA.moder().modify(|r, w| w.bits(r.bits() & !0x003f_000f | 0x002a_000a));
            chip.GPIOA.afrl().modify(|r, w| w.bits(r.bits() & !0xff | 0x11));
            chip.GPIOA.afrh().modify(|r, w| w.bits(r.bits() & !0xfff | 0x666));
            chip.GPIOC.afrl().modify(|r, w| w.bits(r.bits() & 0x00ff_ffff | 0x2200_0000));
            chip.TIM1.arr().write(|w| w.bits(PERIOD - 1));
            chip.TIM1.ccmr1_output().write(|w| w.bits(0x6868));
            chip.TIM1.ccmr2_output().write(|w| w.bits(0x0068));
            chip.TIM1.ccer().write(|w| w.bits(0x0111));
            chip.TIM1.bdtr().write(|w| w.bits(1 << 15));
            for (inputs, mode, control) in [
                (chip.TIM2.ccmr1_input().as_ptr(), chip.TIM2.smcr().as_ptr(), chip.TIM2.cr1().as_ptr()),
                (chip.TIM3.ccmr1_input().as_ptr(), chip.TIM3.smcr().as_ptr(), chip.TIM3.cr1().as_ptr()),
                (chip.TIM4.ccmr1_input().as_ptr(), chip.TIM4.smcr().as_ptr(), chip.TIM4.cr1().as_ptr()),
            ] {
                inputs.write_volatile(0x0101);
                mode.write_volatile(3);
                control.write_volatile(1);
            }
            chip.TIM1.cr1().write(|w| w.bits(1));
        }
        Self { chip, was_released: false, overran: false }
    }

    /// Why the chip was reset, as far as it matters here. Read once: the flags are cleared.
    pub fn reset_reason(&mut self) -> ResetReason {
        let hung = self.chip.RCC.csr().read().iwdgrstf().bit_is_set();
        self.chip.RCC.csr().modify(|_, w| w.rmvf().set_bit());
        if hung { ResetReason::Watchdog } else { ResetReason::PowerOn }
    }

    /// Starts the ticks, `rate_hz` of TIM7, and the watchdog: 20 ms without a tick reset the chip.
    pub fn start(&mut self, rate_hz: f32) {
        let Peripherals { TIM7: timer, IWDG: watchdog, .. } = &self.chip;
        // SAFETY: values of the reference manual (RM0440). The update loads the prescaler; its flag is cleared.
        unsafe {
            timer.psc().write(|w| w.bits(15));
            timer.arr().write(|w| w.bits((1e6 / rate_hz) as u32 - 1));
            timer.egr().write(|w| w.bits(1));
            timer.sr().write(|w| w.bits(0));
            timer.dier().write(|w| w.bits(1));
            timer.cr1().write(|w| w.bits(1));
            for key in [0xcccc, 0x5555] {
                watchdog.kr().write(|w| w.bits(key));
            }
            // 32 kHz / 4.
            watchdog.rlr().write(|w| w.bits(160));
        }
    }

    /// Takes the tick's interrupt back and feeds the watchdog. Returns whether a tick was missed: the last one took too
    /// long, or this one was delayed by half a period.
    pub fn acknowledge(&mut self) -> bool {
        // SAFETY: zero clears the only flag; the key feeds the watchdog.
        unsafe {
            self.chip.TIM7.sr().write(|w| w.bits(0));
            self.chip.IWDG.kr().write(|w| w.bits(0xaaaa));
        }
        self.overran || self.chip.TIM7.cnt().read().bits() > self.chip.TIM7.arr().read().bits() / 2
    }

    /// The encoders and the button.
    pub fn input(&mut self) -> Input<3> {
        let chip = &self.chip;
        let [a, b, c] = [chip.TIM2.cnt().read().bits(), chip.TIM3.cnt().read().bits(), chip.TIM4.cnt().read().bits()];
        // Two of the timers have 16 bits: a joint of this device turns less.
        let counts = [Counts(a as i32), Counts(i32::from(b as i16)), Counts(i32::from(c as i16))];
        let is_pressed = chip.GPIOC.idr().read().bits() & 1 << 13 != 0;
        self.was_released |= !is_pressed;
        Input::Sensors { counts, enable: is_pressed && self.was_released }
    }

    /// Enables the amplifiers and gives them these duties.
    pub fn drive(&mut self, duties: [Duty; 3]) {
        let width = |Duty(duty): Duty| u32::from(duty.unsigned_abs()) * PERIOD / 32_767;
        let sign = |index: usize| if duties[index].0 < 0 { 1 << (29 + index) } else { 1 << (13 + index) };
        // SAFETY: widths within the period; a bit a pin.
        unsafe {
            self.chip.TIM1.ccr1().write(|w| w.bits(width(duties[0])));
            self.chip.TIM1.ccr2().write(|w| w.bits(width(duties[1])));
            self.chip.TIM1.ccr3().write(|w| w.bits(width(duties[2])));
            self.chip.GPIOB.bsrr().write(|w| w.bits(sign(0) | sign(1) | sign(2)));
            self.chip.GPIOC.bsrr().write(|w| w.bits(0b111));
        }
        self.overran = self.chip.TIM7.sr().read().uif().bit_is_set();
    }

    /// Disables the amplifiers.
    pub fn release(&mut self) {
        motors_off();
        self.overran = self.chip.TIM7.sr().read().uif().bit_is_set();
    }
}

/// Disables the amplifiers by the register, whatever ran before.
pub fn motors_off() {
    // SAFETY: one write that clears three pins.
    unsafe { (*stm32g4xx_hal::stm32::GPIOC::ptr()).bsrr().write(|w| w.bits(0b111 << 16)) };
}

/// Panics and exceptions: the motors off, no tick after it, and the watchdog resets the chip.
fn stop() -> ! {
    cortex_m::interrupt::disable();
    motors_off();
    loop {
        cortex_m::asm::nop();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    stop()
}

// SAFETY: it touches no state.
#[exception]
unsafe fn HardFault(_: &ExceptionFrame) -> ! {
    stop()
}

// SAFETY: as above.
#[exception]
unsafe fn DefaultHandler(_: i16) -> ! {
    stop()
}
