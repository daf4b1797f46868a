//! How deep the stack gets in a hundred thousand interrupts that visit every mode: paints it, runs, and prints the
//! bytes that are no longer painted.

#![no_std]
#![no_main]

use core::hint::black_box;
use core::ptr::addr_of;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

use cortex_m_rt::entry;
use palpate::servo::Tracked;
use palpate::wire::Report;
use palpate::wire::frame::{self, MAX_FRAME};
use palpate_bench::exercise::laps::WOODEN_HAPTICS_REACH;
use palpate_bench::exercise::script::Script;
use palpate_emulated::board::BOARD;
use palpate_emulated::body::{self, SERVO, SETTINGS, State};
use palpate_emulated::vectors::interrupt;
use semihosting::println;
use static_cell::StaticCell;

/// Ticks of the run.
const TICKS: u32 = 100_000;
/// The pattern that the stack is painted with, and the number of words painted.
const PAINT: u32 = 0xcccc_cccc;
const PAINTED: usize = 4_096;
/// Below the stack pointer and not painted: what painting itself may use.
const OWN: usize = 32;

unsafe extern "C" {
    /// The top of the stack; from cortex-m-rt's linker script.
    static _stack_start: u32;
}

#[entry]
fn main() -> ! {
    let top = cortex_m::register::msp::read() as *mut u32;
    // SAFETY: the memory below the stack pointer is nobody's while no interrupt is on, and there are megabytes of it.
    let lowest = unsafe { top.sub(OWN + PAINTED) };
    for index in 0..PAINTED {
        // SAFETY: as above.
        unsafe { lowest.add(index).write_volatile(PAINT) };
    }
    BOARD.start_timer(SETTINGS.rate_hz);
    while TICKS_DONE.load(Relaxed) < TICKS {
        cortex_m::asm::wfi();
    }
    cortex_m::interrupt::disable();
    // SAFETY: the same words, read.
    let kept = (0..PAINTED).take_while(|index| unsafe { lowest.add(*index).read_volatile() } == PAINT).count();
    let start = addr_of!(_stack_start);
    println!("stack = {}", start as usize - (lowest as usize + 4 * kept));
    let (modes, touches) = (MODES.load(Relaxed), TOUCHES.load(Relaxed));
    println!("modes = {modes}");
    println!("ticks_in_contact = {touches}");
    semihosting::process::exit(0)
}

static TICKS_DONE: AtomicU32 = AtomicU32::new(0);
static MODES: AtomicU32 = AtomicU32::new(0);
static TOUCHES: AtomicU32 = AtomicU32::new(0);

#[interrupt]
fn TIMER0() {
    static mut RUN: Option<(&'static mut Script, &'static mut State)> = None;

    BOARD.acknowledge_timer();
    if RUN.is_none() {
        *RUN = begin_script().zip(begin_state());
    }
    let Some((script, state)) = RUN else { return };
    let order = script.next_order();
    if let Some(reset) = order.restart {
        restart(state, reset);
    }
    for event in order.events.into_iter().flatten() {
        SERVO.note(state, event);
    }
    body::tick(state, order.input);
    let mut buffer = [0; MAX_FRAME];
    black_box(frame::pack(&Report::new(state, 0), &mut buffer).is_ok());
    MODES.fetch_or(1 << state.witness().witness().mode as u32, Relaxed);
    TOUCHES.fetch_add(u32::from(state.contact() == palpate::track::Contact::Touching), Relaxed);
    TICKS_DONE.fetch_add(1, Relaxed);
}

// What makes a state does so on the stack, and a board does it before its first interrupt: not below the tick.

static SCRIPT: StaticCell<Script> = StaticCell::new();
static STATE: StaticCell<State> = StaticCell::new();

#[inline(never)]
fn begin_script() -> Option<&'static mut Script> {
    let encoders = &palpate::device::presets::WOODEN_HAPTICS_2016.encoders;
    SCRIPT.try_init(Script::new(1, encoders, WOODEN_HAPTICS_REACH))
}

#[inline(never)]
fn begin_state() -> Option<&'static mut State> {
    STATE.try_init(SERVO.start())
}

#[inline(never)]
fn restart(state: &mut State, reset: palpate::servo::ResetReason) {
    *state = SERVO.start_after(reset);
}
