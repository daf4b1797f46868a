//! Device, settings and pins of the examples, on an STM32G474 at the 16 MHz it has after reset: the part to replace by
//! your own.
//!
//! Encoders on TIM2 to TIM4, pulse widths of TIM1 on PA8 to PA10 with their directions on PB13 to PB15, enable lines on
//! PC0 to PC2 (high enables), the button that asks for force on PC13 (high while pressed).

pub use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, Duty};
use palpate::math::vec3;
use palpate::servo::{Input, Settings};
use stm32g4xx_hal::stm32::Peripherals;

/// The loop's settings: 2 kHz leave 8,000 cycles a tick.
pub const SETTINGS: Settings = Settings {
    rate_hz: 2_000.0,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 2.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.2,
    body_origin_m: vec3(-0.05, -0.05, -0.06),
};

/// Counts of TIM1 a period: 16 kHz.
const PERIOD: u32 = 1_000;

/// The board; what a tick reads and writes.
pub struct Board(Peripherals);

impl Board {
    /// Everything set up, the motors disabled, a tick every `1/rate_hz` seconds from TIM7.
    pub fn new(chip: Peripherals, rate_hz: f32) -> Self {
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
            chip.TIM7.psc().write(|w| w.bits(15));
            chip.TIM7.arr().write(|w| w.bits((1e6 / rate_hz) as u32 - 1));
            chip.TIM7.dier().write(|w| w.bits(1));
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
            chip.TIM7.cr1().write(|w| w.bits(1));
        }
        Self(chip)
    }

    /// Takes the tick's interrupt back.
    pub fn acknowledge(&mut self) {
        // SAFETY: zero clears the only flag.
        self.0.TIM7.sr().write(|w| unsafe { w.bits(0) });
    }

    /// The encoders and the button.
    pub fn input(&mut self) -> Input<3> {
        let [a, b, c] =
            [self.0.TIM2.cnt().read().bits(), self.0.TIM3.cnt().read().bits(), self.0.TIM4.cnt().read().bits()];
        // Two of the timers have 16 bits: a joint of this device turns less.
        let counts = [Counts(a as i32), Counts(i32::from(b as i16)), Counts(i32::from(c as i16))];
        Input::Sensors { counts, enable: self.0.GPIOC.idr().read().bits() & 1 << 13 != 0 }
    }

    /// Enables the amplifiers and gives them these duties.
    pub fn drive(&mut self, duties: [Duty; 3]) {
        let width = |Duty(duty): Duty| u32::from(duty.unsigned_abs()) * PERIOD / 32_767;
        let sign = |index: usize| if duties[index].0 < 0 { 1 << (29 + index) } else { 1 << (13 + index) };
        // SAFETY: widths within the period; a bit a pin.
        unsafe {
            self.0.TIM1.ccr1().write(|w| w.bits(width(duties[0])));
            self.0.TIM1.ccr2().write(|w| w.bits(width(duties[1])));
            self.0.TIM1.ccr3().write(|w| w.bits(width(duties[2])));
            self.0.GPIOB.bsrr().write(|w| w.bits(sign(0) | sign(1) | sign(2)));
            self.0.GPIOC.bsrr().write(|w| w.bits(0b111));
        }
    }

    /// Disables the amplifiers.
    pub fn release(&mut self) {
        motors_off();
    }
}

/// Disables the amplifiers by the register, whatever ran before.
pub fn motors_off() {
    // SAFETY: one write that clears three pins.
    unsafe { (*stm32g4xx_hal::stm32::GPIOC::ptr()).bsrr().write(|w| w.bits(0b111 << 16)) };
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    motors_off();
    loop {}
}
