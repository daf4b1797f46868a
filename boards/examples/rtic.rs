//! The servo as RTIC's task of highest priority, in the interrupt of a timer of an STM32G474.
//!
//! Minimal: hold the arm in its calibration pose at reset, button up. No homing, no stop, ready or supply input, and no
//! protection beyond the loop's own checks.
//!
//! `cargo palpate firmware --board stm32g4 build --release --example rtic`

#![no_std]
#![no_main]

mod board;

use board::{Board, DEVICE, SETTINGS, body};
use palpate::device::SerialArm;
use palpate::servo::{Config, Event, Output, Rendering, Servo, State};

/// The loop's type, named once.
type Loop = Servo<'static, body::Surface, SerialArm, 3>;

/// In flash; settings beyond the device's limits are compile errors.
static SERVO: Loop =
    Servo::new(&DEVICE, body::SURFACE, Config { settings: SETTINGS, rendering: Rendering::SMOOTH, ..Config::DEFAULT });

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
        let mut board = Board::new(context.device);
        let state = SERVO.start_after(board.reset_reason());
        board.start(SETTINGS.rate_hz);
        (Shared {}, Local { board, state })
    }

    /// Telemetry and commands go into software tasks below this priority.
    #[task(binds = TIM7, priority = 15, local = [board, state])]
    fn tick(context: tick::Context) {
        let tick::LocalResources { board, state, .. } = context.local;
        if board.acknowledge() {
            SERVO.note(state, Event::Overrun);
        }
        // `Off` disables the amplifiers. Zero duty would keep them enabled, and braking.
        match SERVO.tick(state, board.input()) {
            Output::Off => board.release(),
            Output::Drive(duties) => board.drive(duties),
        }
    }
}
