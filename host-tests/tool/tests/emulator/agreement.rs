//! The device and the host compute the same bits.

use crate::path::{TICKS, sensors};
use crate::running::{TRANSPORTS, firmware_of};
use palpate::body::Effort;
use palpate::device::Counts;
use palpate::servo::{Config, Event, Input, Servo};
use palpate::wire::Report;
use palpate_tool::firmware::{Board, Link, is_long};

/// The very tables, effort and settings of the image.
mod tables {
    include!("../../../../boards/bodies/capped_box.rs");
}
#[allow(dead_code, unused_imports)]
mod settings {
    include!("../../../../boards/emulated/settings.rs");
}

static SURFACE: tables::Surface = tables::with_effort(Effort::ONE);
static SERVO: Servo<'static, tables::Surface, settings::Mechanism, 3> = Servo::new(
    &settings::DEVICE,
    &SURFACE,
    Config { settings: settings::SETTINGS, safety: settings::SAFETY, ..Config::DEFAULT },
);

#[test]
fn every_board_and_the_host_agree_in_every_bit_of_every_tick() {
    let others: &[Board] = if is_long() { &[Board::Riscv] } else { &[] };
    for board in Board::CORTEX_F.iter().chain(others) {
        agrees(*board);
    }
}

fn agrees(board: Board) {
    let Some(firmware) = firmware_of(board, "every_board_and_the_host_agree_in_every_bit_of_every_tick") else {
        return;
    };
    for transport in TRANSPORTS {
        let mut emulator = firmware.start(transport).unwrap();
        let mut state = SERVO.start();
        let mut pushed = 0;
        for tick in 0..TICKS {
            let sensors = sensors(tick);
            let report = emulator.exchange(&sensors).unwrap();
            SERVO.note(&mut state, Event::LinkAlive);
            let _ =
                SERVO.tick(&mut state, Input::Sensors { counts: sensors.counts.map(Counts), enable: sensors.enable });
            assert_eq!(report, Report::new(&state, report.instructions), "{board:?}, {transport:?}");
            pushed += u32::from(report.duties != [0; 3]);
        }
        assert!(pushed > 100, "{board:?}, {transport:?}: the surface pushed back in {pushed} ticks only");
    }
}
