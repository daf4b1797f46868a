//! The servo loop over two FIFOs of the host.

#![no_std]
#![no_main]

use board::BOARD;
use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_emulated::vectors::interrupt;
use palpate_emulated::{body::SETTINGS, link_semihosting::FifoLink, servo_loop::ServoLoop};

#[entry]
fn main() -> ! {
    BOARD.start_timer(SETTINGS.rate);
    loop {
        cortex_m::asm::wfi();
    }
}

#[interrupt]
fn TIMER0() {
    // Made at the first tick, in the only place that uses it: no lock is needed to hand it over.
    static mut SERVO_LOOP: Option<ServoLoop<FifoLink>> = None;

    BOARD.acknowledge_timer();
    if SERVO_LOOP.is_none() {
        *SERVO_LOOP = Peripherals::take().map(|core| ServoLoop::new(&BOARD, FifoLink::open(), core.SYST));
    }
    if let Some(servo_loop) = SERVO_LOOP {
        servo_loop.tick();
    }
}
