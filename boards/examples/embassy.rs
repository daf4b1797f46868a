//! The servo in an interrupt above Embassy's executor, whose tasks hear of it, on an STM32G474.
//!
//! `cargo palpate firmware --board stm32g4 build --release --example embassy`

#![no_std]
#![no_main]

mod board;

use board::{Board, DEVICE, SETTINGS};
use core::cell::Cell;
use cortex_m::interrupt::{Mutex, free};
use embassy_sync::{blocking_mutex::raw::CriticalSectionRawMutex, signal::Signal};
use palpate::device::SerialArm;
use palpate::servo::{Config, Output, Servo, State};
use stm32g4xx_hal::stm32::{Interrupt, Peripherals, interrupt};

/// The tables of a body, baked when the program is built.
mod body {
    include!(env!("PALPATE_BODY_FILE"));
}

/// The loop's type, named once.
type Loop = Servo<'static, body::Surface, SerialArm, 3>;

/// In flash; settings beyond the device's limits are compile errors.
static SERVO: Loop = Servo::new(&DEVICE, body::SURFACE, Config { settings: SETTINGS, ..Config::DEFAULT });

/// On its way from main to the interrupt, which owns it from the first tick on.
static BOARD: Mutex<Cell<Option<Board>>> = Mutex::new(Cell::new(None));
/// The last tick's number: tasks await it, the interrupt never waits.
static TICK: Signal<CriticalSectionRawMutex, u32> = Signal::new();

#[interrupt]
fn TIM7() {
    static mut OWN: Option<(Board, State<Loop>)> = None;

    if OWN.is_none() {
        *OWN = free(|section| BOARD.borrow(section).take()).map(|board| (board, SERVO.start()));
    }
    let Some((board, state)) = OWN else { return };
    board.acknowledge();
    // `Off` disables the amplifiers. Zero duty would keep them enabled, and braking.
    match SERVO.tick(state, board.input()) {
        Output::Off => board.release(),
        Output::Drive(duties) => board.drive(duties),
    }
    TICK.signal(state.ticks());
}

#[embassy_executor::main]
async fn main(_spawner: embassy_executor::Spawner) {
    let chip = Peripherals::take().unwrap();
    free(|section| BOARD.borrow(section).set(Some(Board::new(chip, SETTINGS.rate_hz))));
    // SAFETY: the interrupt's data is in place.
    unsafe { cortex_m::peripheral::NVIC::unmask(Interrupt::TIM7) };
    loop {
        TICK.wait().await; // Telemetry goes here.
    }
}
