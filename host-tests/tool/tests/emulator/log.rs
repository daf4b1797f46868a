//! What the board logs with defmt, decoded.

use crate::path::{TICKS, sensors};
use crate::running::is_wanted;
use defmt_decoder::Table;
use palpate::wire::Sensors;
use palpate_tool::firmware::{Board, Link, Program, Progress};
use std::io::Read;

/// The log of an image, from what it wrote.
fn decoded(elf: &[u8], written: &[u8]) -> Vec<String> {
    let table = Table::parse(elf).expect("the image has a table").expect("and it is defmt's");
    let mut decoder = table.new_stream_decoder();
    decoder.received(written);
    let mut lines = Vec::new();
    while let Ok(frame) = decoder.decode() {
        let level = frame.level().map_or("", |level| level.as_str());
        lines.push(format!("{level} {}", frame.display_message()));
    }
    lines
}

#[test]
fn phases_contacts_and_a_fault_are_logged_as_they_come() {
    if !is_wanted("phases_contacts_and_a_fault_are_logged_as_they_come") {
        return;
    }
    let program = Program::prepare(Board::M4, "log", &["defmt"], &Progress::new()).unwrap();
    let (mut emulator, mut output) = program.start_with_output().unwrap();
    let reader = std::thread::spawn(move || {
        let mut written = Vec::new();
        output.read_to_end(&mut written).map(|_| written)
    });
    let mut touched = None;
    for tick in 0..TICKS {
        let report = emulator.exchange(&sensors(tick)).unwrap();
        if report.contact == 2 && touched.is_none() {
            touched = Some(tick);
        }
    }
    let touched = touched.expect("the movement ends deep in the body");
    emulator.exchange(&Sensors { counts: [i32::MAX; 3], ..sensors(TICKS) }).unwrap();
    for tick in TICKS + 1..TICKS + 20 {
        emulator.exchange(&sensors(tick)).unwrap();
    }
    drop(emulator);
    let lines = decoded(&std::fs::read(&program.image.elf).unwrap(), &reader.join().unwrap().unwrap());
    let expected = [
        "info tick 0: reset reason PowerOn, phase Calibrate".to_owned(),
        "info tick 1: phase Calibrate -> Armed".to_owned(),
        "info tick 2: phase Armed -> Running".to_owned(),
        format!("info tick {touched}: contact InFront -> Touching"),
        format!("info tick {TICKS}: phase Running -> Fault"),
        format!("error tick {TICKS}: fault JointOutOfRange, seen at tick {TICKS}"),
    ];
    for line in &expected {
        assert!(lines.contains(line), "no {line:?} in {lines:#?}");
    }
    // Changes are logged, and nothing else.
    for line in &lines {
        let sides = line.split_once(" -> ").and_then(|(before, after)| Some((before.rsplit(' ').next()?, after)));
        assert!(sides.is_none_or(|(before, after)| before != after), "{line:?} in {lines:#?}");
    }
}
