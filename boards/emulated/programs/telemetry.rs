//! The servo loop over two FIFOs of the host, and telemetry over the UART.

#![no_std]
#![no_main]

use cortex_m_rt::entry;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate::wire::telemetry::Queue;
use palpate::wire::{DeviceMessage, Record};
use palpate_emulated::board::BOARD;
use palpate_emulated::body::SETTINGS;
use palpate_emulated::link::Link;
use palpate_emulated::link_semihosting::FifoLink;
use palpate_emulated::link_uart::UartLink;
use palpate_emulated::recorded::{self, PLACES, RecordedLoop};
use palpate_emulated::vectors::interrupt;
use static_cell::StaticCell;

/// 100 records a second at 4 kHz.
const TICKS_PER_RECORD: u32 = 40;

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, PLACES> = Queue::new();

    let mut records = recorded::hand_over(&BOARD, QUEUE, TICKS_PER_RECORD);
    let mut line = UartLink::new(&BOARD);
    let mut buffer = [0; MAX_FRAME];
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        // No sleep: the emulator, left asleep, lets every other tick of the timer pass.
        let Some(record) = records.dequeue() else { continue };
        if let Ok(frame) = frame::pack(&DeviceMessage::Record(record), &mut buffer) {
            line.send(frame);
        }
    }
}

static PLACE: StaticCell<RecordedLoop<FifoLink>> = StaticCell::new();

#[interrupt]
fn TIMER0() {
    // Made in an interrupt of its own, in the only place that uses it: no lock is needed to hand it over, and the first
    // tick is on time, though checking the tables takes longer than a period.
    static mut SERVO_LOOP: Option<&'static mut RecordedLoop<FifoLink>> = None;

    BOARD.acknowledge_timer();
    if let Some(servo_loop) = SERVO_LOOP {
        servo_loop.tick();
    } else {
        *SERVO_LOOP = RecordedLoop::take(&BOARD, FifoLink::open).and_then(|made| PLACE.try_init(made));
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
