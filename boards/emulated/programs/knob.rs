//! The knob's loop over two FIFOs of the host.

#![no_std]
#![no_main]

use cortex_m::peripheral::Peripherals;
use cortex_m_rt::entry;
use palpate_emulated::board::BOARD;
use palpate_emulated::vectors::interrupt;
use palpate_emulated::{
    knob::{KnobLoop, SETTINGS},
    link_semihosting::FifoLink,
};
use static_cell::StaticCell;

#[entry]
fn main() -> ! {
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        cortex_m::asm::wfi();
    }
}

static PLACE: StaticCell<KnobLoop<FifoLink>> = StaticCell::new();

#[interrupt]
fn TIMER0() {
    // Made in an interrupt of its own, in the only place that uses it: no lock is needed to hand it over.
    static mut KNOB_LOOP: Option<&'static mut KnobLoop<FifoLink>> = None;

    BOARD.acknowledge_timer();
    if let Some(knob_loop) = KNOB_LOOP {
        knob_loop.tick();
    } else {
        *KNOB_LOOP =
            Peripherals::take().and_then(|core| PLACE.try_init(KnobLoop::new(&BOARD, FifoLink::open(), core.SYST)));
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
