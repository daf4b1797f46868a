//! The firmware, if it is to be run.

use palpate_host::firmware::{self, Choice, Firmware, Progress, Transport, WITH_FIRMWARE};
use std::env;
use std::io::{Write, stderr};

pub const TRANSPORTS: [Transport; 2] = [Transport::Uart, Transport::Fifo];

/// The firmware, ready to start; `None` where the tests are run without, which is said.
pub fn firmware(test: &str) -> Option<Firmware> {
    if env::var_os(WITH_FIRMWARE).is_none() {
        // Past the test harness, which would swallow it: a test that did not run must not look like one that passed.
        let _ = writeln!(
            stderr(),
            "LEFT OUT {test}: it needs the firmware on the emulated board; `cargo palpate test` sets that up"
        );
        return None;
    }
    Some(firmware::prepare(&Choice::default(), &Progress::new()).expect("everything was set up before the tests"))
}
