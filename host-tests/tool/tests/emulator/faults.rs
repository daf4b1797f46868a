//! What goes wrong on the line, in the middle of a run, with the motors pushing: they stop within the tick, the fault
//! is named, and nothing but a reset starts them again.

use crate::path::{TICKS, sensors};
use crate::running::{TRANSPORTS, firmware, is_wanted};
use clap::Parser;
use palpate::servo::{Fault, Phase, ResetReason};
use palpate::wire::Sensors;
use palpate::wire::frame::{self, DELIMITER, MAX_FRAME};
use palpate_tool::commands::demo::program;
use palpate_tool::commands::options::SceneOptions;
use palpate_tool::firmware::{Board, Emulator, Link, LinkError, Progress};

#[derive(Parser)]
struct Scene {
    #[command(flatten)]
    options: SceneOptions,
}

/// Moves until the surface has pushed for a while, does `harm` in the place of the next tick's frame, and asserts what
/// the device must say from then on. Gives the frames it has lost at the end.
fn after(harm: fn(&mut Emulator, Sensors) -> Result<(), LinkError>, expected: Fault, test: &str) -> Option<Vec<u32>> {
    let firmware = firmware(test)?;
    let lost = TRANSPORTS.map(|transport| {
        let mut emulator = firmware.start(transport).unwrap();
        let mut pushed = 0;
        let mut next = (0..TICKS).map(sensors);
        for sensors in next.by_ref() {
            let report = emulator.exchange(&sensors).unwrap();
            assert_eq!(report.fault, 0, "{transport:?}");
            pushed += u32::from(report.duties != [0; 3]);
            if pushed > 20 {
                break;
            }
        }
        let harmed = next.next().expect("the surface is met long before the end of the movement");
        harm(&mut emulator, harmed).unwrap();
        let mut report = emulator.receive().unwrap();
        for sensors in next.take(40) {
            assert_eq!(report.duties, [0; 3], "{transport:?}, tick {}", report.tick);
            assert_eq!(report.phase, Phase::Fault as u8, "{transport:?}, tick {}", report.tick);
            assert_eq!((report.fault, report.fault_tick), (expected.code(), harmed.tick), "{transport:?}");
            report = emulator.exchange(&sensors).unwrap();
        }
        report.frames_lost
    });
    Some(lost.to_vec())
}

#[test]
fn unplugged() {
    let lost = after(|emulator, _| emulator.stay_silent(), Fault::FrameLost, "unplugged");
    assert!(lost.is_none_or(|lost| lost == [1, 1]));
}

#[test]
fn a_flipped_bit() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        let mut buffer = [0; MAX_FRAME];
        let length = frame::pack(&sensors, &mut buffer).unwrap().len();
        let byte = &mut buffer[length / 2];
        // Not into a delimiter: that is the next test.
        *byte ^= if *byte == 1 { 2 } else { 1 };
        emulator.send_bytes(&buffer[..length])
    };
    let lost = after(harm, Fault::FrameDamaged, "a_flipped_bit");
    assert!(lost.is_none_or(|lost| lost == [1, 1]));
}

#[test]
fn a_frame_that_falls_in_two() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        let mut buffer = [0; MAX_FRAME];
        let length = frame::pack(&sensors, &mut buffer).unwrap().len();
        buffer[length / 2] = DELIMITER;
        emulator.send_bytes(&buffer[..length])
    };
    let lost = after(harm, Fault::FrameDamaged, "a_frame_that_falls_in_two");
    // Each half takes a tick; then a good frame comes late, and the next is in time.
    assert!(lost.is_none_or(|lost| lost == [3, 3]));
}

#[test]
fn a_frame_of_an_earlier_tick() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        emulator.send(&Sensors { tick: sensors.tick - 1, ..sensors })?;
        emulator.stay_silent()
    };
    let lost = after(harm, Fault::FrameLost, "a_frame_of_an_earlier_tick");
    assert!(lost.is_none_or(|lost| lost == [1, 1]));
}

#[test]
fn a_frame_sent_twice() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        emulator.send(&Sensors { tick: sensors.tick - 1, ..sensors })?;
        emulator.send(&sensors)
    };
    let lost = after(harm, Fault::FrameLost, "a_frame_sent_twice");
    assert!(lost.is_none_or(|lost| lost == [1, 1]));
}

/// 100 kHz leave 625 instructions a tick, fewer than a tick takes in any phase: the first one overruns.
#[test]
fn a_tick_that_takes_longer_than_its_period() {
    if !is_wanted("a_tick_that_takes_longer_than_its_period") {
        return;
    }
    let Scene { options } = Scene::parse_from(["scene", "--rate", "100000"]);
    let [uart, _] = TRANSPORTS;
    let image = program(Board::M4, &options.scene().unwrap(), uart, &Progress::new()).expect("the image builds");
    let mut emulator = image.start_over(uart).unwrap();
    for tick in 0..20 {
        let report = emulator.exchange(&sensors(tick)).unwrap();
        assert_eq!((report.fault, report.phase), (Fault::Overrun.code(), Phase::Fault as u8), "tick {tick}");
        assert_eq!((report.duties, report.reset), ([0; 3], ResetReason::PowerOn as u8));
        // Counted on, for as long as ticks take too long; the first that does stops the motors.
        assert!(report.overruns >= 1 && report.overruns <= tick + 1, "{}", report.overruns);
    }
}

#[test]
fn counts_as_great_as_can_be() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| emulator.send(&Sensors { counts: [i32::MAX; 3], ..sensors });
    let lost = after(harm, Fault::JointOutOfRange, "counts_as_great_as_can_be");
    assert!(lost.is_none_or(|lost| lost == [0, 0]));
}

#[test]
fn one_count_as_low_as_can_be() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        let [first, second, _] = sensors.counts;
        emulator.send(&Sensors { counts: [first, second, i32::MIN], ..sensors })
    };
    let lost = after(harm, Fault::JointOutOfRange, "one_count_as_low_as_can_be");
    assert!(lost.is_none_or(|lost| lost == [0, 0]));
}

#[test]
fn a_jump_within_range() {
    let harm = |emulator: &mut Emulator, sensors: Sensors| {
        let [first, second, third] = sensors.counts;
        emulator.send(&Sensors { counts: [first + 400, second, third], ..sensors })
    };
    let lost = after(harm, Fault::JointJumped, "a_jump_within_range");
    assert!(lost.is_none_or(|lost| lost == [0, 0]));
}
