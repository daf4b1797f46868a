//! The servo loop over two FIFOs of the host; what changes is logged with defmt on the emulator's standard output.

#![no_std]
#![no_main]

use cortex_m_rt::entry;
use defmt_semihosting as _;
use palpate::wire::Record;
use palpate::wire::log::Changes;
use palpate::wire::telemetry::Queue;
use palpate_emulated::board::BOARD;
use palpate_emulated::body::SETTINGS;
use palpate_emulated::link_semihosting::FifoLink;
use palpate_emulated::recorded::{self, PLACES, RecordedLoop};
use palpate_emulated::vectors::interrupt;

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, PLACES> = Queue::new();

    // Only changes matter: no record in between.
    let mut records = recorded::hand_over(&BOARD, QUEUE, u32::MAX);
    let mut changes = Changes::default();
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        match records.dequeue() {
            Some(record) => changes.log(&record),
            None => cortex_m::asm::wfi(),
        }
    }
}

#[interrupt]
fn TIMER0() {
    // Made at the first tick, in the only place that uses it: from then on no lock is needed.
    static mut SERVO_LOOP: Option<RecordedLoop<FifoLink>> = None;

    BOARD.acknowledge_timer();
    if SERVO_LOOP.is_none() {
        *SERVO_LOOP = RecordedLoop::take(&BOARD, FifoLink::open);
    }
    if let Some(servo_loop) = SERVO_LOOP {
        servo_loop.tick();
    }
}
