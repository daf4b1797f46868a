//! The servo as RTIC's task of highest priority, in the interrupt of a timer of an STM32G474.
//!
//! `cargo palpate firmware --board stm32g4 build --release --example rtic`

#![no_std]
#![no_main]

mod board;

use board::{Board, DEVICE, SETTINGS};
use palpate::device::SerialArm;
use palpate::servo::{Output, Servo, ServoState, Surface};
use palpate::track::Controller;

/// The tables of a body, baked when the program is built.
mod body {
    include!(env!("PALPATE_BODY_FILE"));
}

/// In flash; settings beyond the device's limits are compile errors.
static SERVO: Servo<'static, body::Surface, SerialArm, 3> =
    Servo::new(&DEVICE, body::SURFACE, Controller::SECOND_ORDER, SETTINGS);

#[rtic::app(device = stm32g4xx_hal::stm32)]
mod app {
    use super::*;

    #[shared]
    struct Shared {}

    #[local]
    struct Local {
        board: Board,
        state: ServoState<3, <body::Surface as Surface>::Witness>,
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
        SERVO.tick(state, board.input());
        // `Off` disables the amplifiers. Zero duty would keep them enabled, and braking.
        match state.output() {
            Output::Off => board.release(),
            Output::Drive(duties) => board.drive(duties),
        }
    }
}
