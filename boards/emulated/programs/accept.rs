//! The acceptance of a board, over the UART: see `palpate_bench::accept`.

#![no_std]
#![no_main]

use core::cell::Cell;

use cortex_m::interrupt::{Mutex, free};
use cortex_m::peripheral::{CPUID, Peripherals};
use cortex_m_rt::entry;
use palpate::wire::acceptance::Ticks;
use palpate::wire::telemetry::Queue;
use palpate_bench::accept::{Acceptance, Chip, Examiner};
use palpate_bench::{Mailbox, OptionBytes, Settings};
use palpate_emulated::accepted::{Instructions, NoWatchdog, This, Wired};
use palpate_emulated::board::BOARD;
use palpate_emulated::body::SETTINGS;
use palpate_emulated::link_uart::Uart;
use palpate_emulated::vectors::interrupt;

type Loop = Acceptance<'static, This, Wired, 3>;

static HANDED_OVER: Mutex<Cell<Option<Loop>>> = Mutex::new(Cell::new(None));
static MAILBOX: Mailbox = Mailbox::new();

#[entry]
fn main() -> ! {
    static mut QUEUE: Queue<Ticks, 16> = Queue::new();

    let Some(peripherals) = Peripherals::take() else { panic!("they are taken here and nowhere else") };
    let reset = BOARD.reset_reason();
    let settings = Settings::new(BOARD.clock);
    let (producer, ticks) = QUEUE.split();
    let made = Loop::new(This, Wired::new(&BOARD), &settings, reset, producer, &MAILBOX);
    free(|section| HANDED_OVER.borrow(section).set(Some(made)));
    // SAFETY: a register that is only ever read.
    let core = unsafe { (*CPUID::PTR).base.read() };
    let stopwatch = Instructions::new(&BOARD, peripherals.SYST);
    let chip = Chip { core, reset, options: OptionBytes::default() };
    let mut examiner = Examiner::new(&This, &settings, chip, &MAILBOX, ticks, stopwatch);
    let mut port = Uart::new(&BOARD);
    BOARD.start_timer(SETTINGS.rate_hz);
    // Nothing here can be reset: what would fail goes on.
    loop {
        let _ = examiner.step(&mut port, &mut NoWatchdog);
    }
}

#[interrupt]
fn TIMER0() {
    static mut LOOP: Option<Loop> = None;

    if LOOP.is_none() {
        *LOOP = free(|section| HANDED_OVER.borrow(section).take());
    }
    if let Some(servo_loop) = LOOP {
        servo_loop.tick();
    }
}
