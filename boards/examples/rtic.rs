//! The servo as RTIC's task of highest priority, in the interrupt of a timer of an STM32G474.
//!
//! `cargo palpate firmware --board stm32g4 build --release --example rtic`

#![no_std]
#![no_main]

mod board;

use board::{Board, DEVICE, SETTINGS};
use palpate::device::SerialArm;
use palpate::servo::{Config, Output, Servo, State};

/// The tables of a body, baked when the program is built.
mod body {
    include!(env!("PALPATE_BODY_FILE"));
}

/// The loop's type, named once.
type Loop = Servo<'static, body::Surface, SerialArm, 3>;

/// In flash; settings beyond the device's limits are compile errors.
static SERVO: Loop = Servo::new(&DEVICE, body::SURFACE, Config { settings: SETTINGS, ..Config::DEFAULT });

#[rtic::app(device = stm32g4xx_hal::stm32)]
mod app {
    use super::*;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        board: Board,
        state: State<Loop>,
    }

    #[init]
    fn init(context: init::Context) -> (Shared, Local) {
        (Shared {}, Local { board: Board::new(context.device, SETTINGS.rate_hz), state: SERVO.start() })
    }

    /// Telemetry and commands go into software tasks below this priority.
    #[task(binds = TIM7, priority = 15, local = [board, state])]
    fn tick(context: tick::Context) {
        let tick::LocalResources { board, state, .. } = context.local;
        board.acknowledge();
        // `Off` disables the amplifiers. Zero duty would keep them enabled, and braking.
        match SERVO.tick(state, board.input()) {
            Output::Off => board.release(),
            Output::Drive(duties) => board.drive(duties),
        }
    }
}
