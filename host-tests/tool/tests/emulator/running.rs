//! The firmware, if it is to be run.

use palpate_tool::firmware::{self, Board, Choice, Firmware, Progress, Transport, WITH_FIRMWARE};
use std::env;
use std::io::{Write, stderr};

pub const TRANSPORTS: [Transport; 2] = [Transport::Uart, Transport::Fifo];

/// Whether an emulated board is to be used. If not, that is said.
pub fn is_wanted(test: &str) -> bool {
    let wanted = env::var_os(WITH_FIRMWARE).is_some();
    if !wanted {
        // Past the test harness, which would swallow it: a test that did not run must not look like one that passed.
        // In one piece, for tests run side by side.
        let line = format!(
            "LEFT OUT {test}: it needs the firmware on the emulated board; `cargo palpate test` sets that up\n"
        );
        let _ = stderr().write_all(line.as_bytes());
    }
    wanted
}

/// The boards of a test that builds an image of its own for each: one core, or every core in a long run.
///
/// Bits, image sizes and the proofs of the plain image are compared on every core in every run.
pub fn boards() -> &'static [Board] {
    firmware::cores()
}

/// The firmware of the first board, ready to start; `None` where the tests are run without.
pub fn firmware(test: &str) -> Option<Firmware> {
    firmware_of(Board::default(), test)
}

/// The firmware of a board.
pub fn firmware_of(board: Board, test: &str) -> Option<Firmware> {
    is_wanted(test).then(|| {
        firmware::prepare(&Choice { board, ..Choice::default() }, &Progress::new())
            .expect("everything was set up before the tests")
    })
}
