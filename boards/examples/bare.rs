//! The servo in the interrupt of a timer, with cortex-m-rt alone, on an STM32G474.
//!
//! Minimal: hold the arm in its calibration pose at reset, button up. No homing, no stop, ready or supply input, and no
//! protection beyond the loop's own checks.
//!
//! `cargo palpate firmware --board stm32g4 build --release --example bare`

#![no_std]
#![no_main]

mod board;

use board::{Board, DEVICE, SETTINGS, body};
use core::cell::Cell;
use cortex_m::interrupt::{Mutex, free};
use cortex_m::peripheral::NVIC;
use palpate::device::SerialArm;
use palpate::servo::{Config, Event, Output, Rendering, Servo, State};
use stm32g4xx_hal::stm32::{Interrupt, Peripherals, interrupt};

/// The loop's type, named once, and what the interrupt owns.
type Loop = Servo<'static, body::Surface, SerialArm, 3>;
type Own = (Board, State<Loop>);

/// In flash; settings beyond the device's limits are compile errors.
static SERVO: Loop =
    Servo::new(&DEVICE, body::SURFACE, Config { settings: SETTINGS, rendering: Rendering::SMOOTH, ..Config::DEFAULT });

/// On its way from main to the interrupt, before the first tick.
static PARTS: Mutex<Cell<Option<Own>>> = Mutex::new(Cell::new(None));

#[interrupt]
fn TIM7() {
    static mut OWN: Option<Own> = None;

    if OWN.is_none() {
        *OWN = free(|section| PARTS.borrow(section).take());
    }
    let Some((board, state)) = OWN else { return };
    if board.acknowledge() {
        SERVO.note(state, Event::Overrun);
    }
    // `Off` disables the amplifiers. Zero duty would keep them enabled, and braking.
    match SERVO.tick(state, board.input()) {
        Output::Off => board.release(),
        Output::Drive(duties) => board.drive(duties),
    }
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut board = Board::new(Peripherals::take().unwrap());
    let state = SERVO.start_after(board.reset_reason());
    board.start(SETTINGS.rate_hz);
    free(|section| PARTS.borrow(section).set(Some((board, state))));
    // SAFETY: the interrupt's data is in place.
    unsafe { NVIC::unmask(Interrupt::TIM7) };
    loop {
        cortex_m::asm::wfi();
    }
}
