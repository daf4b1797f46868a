//! The servo loop over two FIFOs of the host.

#![no_std]
#![no_main]

use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_emulated::board::BOARD;
use palpate_emulated::vectors::interrupt;
use palpate_emulated::{body::SETTINGS, link_semihosting::FifoLink, servo_loop::ServoLoop};
use static_cell::StaticCell;

#[entry]
fn main() -> ! {
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        cortex_m::asm::wfi();
    }
}

static PLACE: StaticCell<ServoLoop<FifoLink>> = StaticCell::new();

#[interrupt]
fn TIMER0() {
    // Made in an interrupt of its own, in the only place that uses it: no lock is needed to hand it over, and the first
    // tick is on time, though checking the tables takes longer than a period.
    static mut SERVO_LOOP: Option<&'static mut ServoLoop<FifoLink>> = None;

    BOARD.acknowledge_timer();
    if let Some(servo_loop) = SERVO_LOOP {
        servo_loop.tick();
    } else {
        *SERVO_LOOP =
            Peripherals::take().and_then(|core| PLACE.try_init(ServoLoop::new(&BOARD, FifoLink::open(), core.SYST)));
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
