//! The loop of the boards for the bench: its pins over two FIFOs of the host, its serial port over the UART, what it
//! was calibrated with in a file of the host.

#![no_std]
#![no_main]

use core::cell::Cell;

use cortex_m::interrupt::{Mutex, free};
use cortex_m_rt::entry;
use palpate::device::Device;
use palpate::servo::Heartbeat;
use palpate::wire::Record;
use palpate::wire::telemetry::{Producer, Queue};
use palpate_bench::store::{Built, KeptCalibration};
use palpate_bench::{Bench, Idle, Mailbox, Settings};
use palpate_emulated::board::BOARD;
use palpate_emulated::body::{DEVICE, Mechanism, SETTINGS, WIRING};
use palpate_emulated::flash::FileFlash;
use palpate_emulated::link_semihosting::FifoLink;
use palpate_emulated::link_uart::Uart;
use palpate_emulated::measured::Measured;
use palpate_emulated::pins::{NoWatchdog, Pins};
use palpate_emulated::vectors::interrupt;

type Loop = Bench<'static, Measured, Pins<FifoLink>, 3>;

/// The device as it was built, to compare a stored calibration with.
static BUILT: Device<Mechanism, 3> = DEVICE;

/// The servo and the interrupt's end of the queue, on their way from main.
type HandedOver = (Measured, Producer<'static, Record>);
static HANDED_OVER: Mutex<Cell<Option<HandedOver>>> = Mutex::new(Cell::new(None));
static MAILBOX: Mailbox = Mailbox::new();

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();

    let (producer, records) = QUEUE.split();
    let Some(flash) = FileFlash::open() else { panic!("it is opened here and nowhere else") };
    // Nothing homes it: its counters are the simulation's, which begin in the pose.
    let (kept, found) =
        KeptCalibration::find(flash, Built { device: &BUILT, wiring: WIRING, homed_by: None, gains: SETTINGS.gains() });
    let felt = Measured::try_new(found);
    free(|section| HANDED_OVER.borrow(section).set(felt.map(|felt| (felt, producer))));
    let mut idle = Idle::new(&MAILBOX, records, Heartbeat::default())
        .saying(SETTINGS.rate_hz, SETTINGS.max_force_n)
        .calibrating(&kept);
    let mut port = Uart::new(&BOARD);
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        idle.step(&mut port, &mut NoWatchdog);
    }
}

#[interrupt]
fn TIMER0() {
    // Made in an interrupt of its own, in the only place that uses it: no lock is needed to hand it over, and the first
    // tick is on time, though checking the tables takes longer than a period.
    static mut LOOP: Option<Loop> = None;

    BOARD.acknowledge_timer();
    if let Some(servo_loop) = LOOP {
        servo_loop.tick();
        servo_loop.board().report();
    } else if let Some((felt, records)) = free(|section| HANDED_OVER.borrow(section).take()) {
        let pins = Pins::new(&BOARD, FifoLink::open());
        *LOOP = Some(Bench::new(felt, pins, &Settings::new(BOARD.clock), BOARD.reset_reason(), records, &MAILBOX));
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
