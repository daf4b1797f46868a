//! The boards' loop of the knob: its pins over two FIFOs, a host at the UART, a feel that is kept in a file of the host.

#![no_std]
#![no_main]

use core::cell::Cell;

use cortex_m::interrupt::{Mutex, free};
use cortex_m_rt::entry;
use palpate::render::Feel;
use palpate::servo::Heartbeat;
use palpate::wire::Record;
use palpate::wire::telemetry::{Producer, Queue};
use palpate_bench::knob::JOG;
use palpate_bench::store::KeptFeels;
use palpate_bench::{Bench, Idle, Mailbox, Settings};
use palpate_emulated::board::BOARD;
use palpate_emulated::flash::FileFlash;
use palpate_emulated::knob::{KnobPins, SETTINGS, This};
use palpate_emulated::link_semihosting::FifoLink;
use palpate_emulated::link_uart::Uart;
use palpate_emulated::pins::NoWatchdog;
use palpate_emulated::vectors::interrupt;

type Loop = Bench<'static, This, KnobPins<FifoLink>, 1>;

/// The kept feel and the interrupt's end of the queue, on their way from main.
type HandedOver = (Option<Feel>, Producer<'static, Record>);
static HANDED_OVER: Mutex<Cell<Option<HandedOver>>> = Mutex::new(Cell::new(None));
static MAILBOX: Mailbox = Mailbox::new();

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Record, 16> = Queue::new();

    let (producer, records) = QUEUE.split();
    let Some(flash) = FileFlash::open() else { panic!("it is opened here and nowhere else") };
    let (kept, feel) = KeptFeels::find(flash);
    let feel = feel.filter(|feel| {
        let is_borne = This::bears(feel);
        if !is_borne {
            kept.refused();
        }
        is_borne
    });
    free(|section| HANDED_OVER.borrow(section).set(Some((feel, producer))));
    let mut idle =
        Idle::new(&MAILBOX, records, Heartbeat::default()).saying(SETTINGS.rate_hz, 0.0).keeping_feels(&kept);
    let mut port = Uart::new(&BOARD);
    BOARD.start_timer(SETTINGS.rate_hz);
    loop {
        idle.step(&mut port, &mut NoWatchdog);
    }
}

#[interrupt]
fn TIMER0() {
    // As in `bench`: made where it is used.
    static mut LOOP: Option<Loop> = None;

    BOARD.acknowledge_timer();
    if let Some(knob_loop) = LOOP {
        knob_loop.tick();
        knob_loop.board().report();
    } else if let Some((feel, records)) = free(|section| HANDED_OVER.borrow(section).take()) {
        let pins = KnobPins::new(&BOARD, FifoLink::open());
        let settings = Settings { jog: Some(JOG), ..Settings::new(BOARD.clock) };
        let knob_loop = LOOP.insert(Bench::new(This, pins, &settings, BOARD.reset_reason(), records, &MAILBOX));
        if let Some(feel) = feel {
            let _ = knob_loop.restore(feel);
        }
        BOARD.start_timer(SETTINGS.rate_hz);
    }
}
