//! Frames there and back over both transports, and an emulator that ends by itself.

use crate::path::sensors;
use crate::running::{TRANSPORTS, firmware};
use palpate_tool::firmware::{Link, Transport};
use std::io::{Write, stderr};
use std::time::{Duration, Instant};

const TICKS: u32 = 1_000;

#[test]
fn no_frame_is_lost_in_a_thousand() {
    let Some(firmware) = firmware("no_frame_is_lost_in_a_thousand") else { return };
    for transport in TRANSPORTS {
        let mut emulator = firmware.start(transport).unwrap();
        let start = Instant::now();
        for tick in 0..TICKS {
            let report = emulator.exchange(&sensors(tick)).unwrap();
            assert_eq!((report.tick, report.frames_lost, report.fault), (tick, 0, 0), "{transport:?}");
        }
        let rate = f64::from(TICKS) / start.elapsed().as_secs_f64();
        let _ = writeln!(stderr(), "{transport:?}: {rate:.0} round trips a second");
    }
}

#[test]
fn the_counted_instructions_are_the_same_in_every_run() {
    let Some(firmware) = firmware("the_counted_instructions_are_the_same_in_every_run") else { return };
    let run = |transport| {
        let mut emulator = firmware.start(transport).unwrap();
        (0..TICKS).map(|tick| emulator.exchange(&sensors(tick)).unwrap().instructions).collect::<Vec<_>>()
    };
    let counts = run(Transport::Fifo);
    assert_eq!(counts, run(Transport::Fifo));
    let mut sorted = counts.clone();
    sorted.sort_unstable();
    let _ = writeln!(
        stderr(),
        "instructions a tick: median {}, maximum {}",
        sorted[sorted.len() / 2],
        counts.iter().max().unwrap()
    );
    // A tick evaluates a patch and a pose: hundreds of instructions. Of a 4 kHz tick it has 40,000 on a small real
    // core.
    assert!(counts.iter().all(|count| (300..10_000).contains(count)), "{counts:?}");
}

#[test]
fn the_emulator_ends_by_itself_when_the_host_is_gone() {
    let Some(firmware) = firmware("the_emulator_ends_by_itself_when_the_host_is_gone") else { return };
    for transport in TRANSPORTS {
        let mut emulator = firmware.start(transport).unwrap();
        emulator.exchange(&sensors(0)).unwrap();
        let start = Instant::now();
        let status = emulator.hang_up(Duration::from_secs(120)).unwrap();
        assert!(status.success(), "{transport:?}: {status}");
        let _ = writeln!(stderr(), "{transport:?}: ended by itself after {:.1} s", start.elapsed().as_secs_f64());
    }
}
