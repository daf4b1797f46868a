//! The servo loop over two FIFOs of the host.

#![no_std]
#![no_main]

use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_qemu_m4::vectors::interrupt;
use palpate_qemu_m4::{body::SETTINGS, link_semihosting::FifoLink, servo_loop::ServoLoop, timer};

#[entry]
fn main() -> ! {
    timer::start(SETTINGS.rate);
    loop {
        cortex_m::asm::wfi();
    }
}

#[interrupt]
fn TIMER0() {
    // Made at the first tick, in the only place that uses it: no lock is needed to hand it over.
    static mut SERVO_LOOP: Option<ServoLoop<FifoLink>> = None;

    timer::acknowledge();
    if SERVO_LOOP.is_none() {
        *SERVO_LOOP = Peripherals::take().map(|core| ServoLoop::new(FifoLink::open(), core.SYST));
    }
    if let Some(servo_loop) = SERVO_LOOP {
        servo_loop.tick();
    }
}
