//! `docs/reference/wire.md` documents the frames byte by byte: golden bytes of what the library packs and takes.
//!
//! `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs wire_page` writes the frames of the tables' bytes.

use crate::byte_tables::{Row, hexadecimal, numbers, table, written};
use crate::pages::{compare, text};
use palpate::commission::CalibrationError;
use palpate::wire::acceptance::{Finding, Request};
use palpate::wire::frame::{MAX_FRAME, pack};
use palpate::wire::{Calibrated, DeviceMessage, HostMessage, Report, Sensors};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

const PAGE: &str = "docs/reference/wire.md";
/// Rows that are no field of a struct: which variant follows, whether an option is there, and fields of tuples.
const TAGS: [&str; 10] =
    ["message", "command", "request", "finding", "calibrated", "error", "which", "is_refused", "is_kept", "body"];

/// Asserts that a row is the next field of the message: its name and, where both are numbers, its value.
fn assert_field(row: &Row, left: &mut &str) {
    let name = row.name.trim_matches('`');
    let Some((_, rest)) = left.split_once(&format!("{name}: ")) else {
        assert!(TAGS.contains(&name), "{name} is not a field of what follows: {left}");
        return;
    };
    *left = rest;
    let shown = rest.trim_start_matches("Some(").trim_start_matches('[').split([',', ']', '}']);
    let shown = shown.map(|shown| shown.trim().replace("true", "1")).filter(|shown| !shown.is_empty());
    for (value, shown) in row.value.split(", ").zip(shown).filter(|(value, _)| *value != "…") {
        let number = shown.parse::<f64>();
        assert!(number.is_err() || value.parse() == number, "{name}: {value} is {shown}");
    }
}

/// The page with the frame of a section's message.
fn with_frame<M: Serialize + DeserializeOwned + Debug>(page: &str, title: &str) -> String {
    let (before, rows, rest, after) = table(page, title);
    let bytes = rows.iter().flat_map(|row| row.bytes.clone()).collect::<Vec<_>>();
    let (message, left) = postcard::take_from_bytes::<M>(&bytes).unwrap_or_else(|error| panic!("{title}: {error}"));
    assert!(left.is_empty(), "{title}: bytes after the message {message:?}");
    let mut buffer = [0; MAX_FRAME];
    let packed = postcard::to_slice(&message, &mut buffer).expect("it fits");
    assert_eq!(hexadecimal(packed), hexadecimal(&bytes), "{title}");
    let (shown, mut rows_shown) = (format!("{message:?}"), 0);
    let mut left = shown.as_str();
    for row in &rows {
        assert_field(row, &mut left);
        if let Some(numbers) = numbers(&row.kind, &row.bytes).filter(|_| row.kind != "64 bytes") {
            assert_eq!(row.value, numbers, "{title}: {}", row.name);
            rows_shown += 1;
        }
    }
    assert!(rows_shown + 1 >= rows.len(), "{title}: rows of unknown kinds");
    assert!(rest.starts_with("\nFrame: `"), "{title}: {rest}");
    let frame = hexadecimal(pack(&message, &mut buffer).expect("it fits"));
    format!("{before}{}\nFrame: `{frame}`\n{after}", written(&rows, 0))
}

#[test]
fn every_byte_of_a_frame_is_documented() {
    let mut page = text(PAGE);
    let mut with = |frame: fn(&str, &str) -> String, titles: &[&str]| {
        titles.iter().for_each(|title| page = frame(&page, title));
    };
    with(with_frame::<Sensors>, &["Sensors"]);
    with(with_frame::<Report>, &["Report"]);
    let told = [
        "Record",
        "Hello",
        "Answer",
        "View",
        "Dial",
        "Modes",
        "Reading",
        "Calibrated",
        "Calibrated: refused",
        "Marked",
    ];
    with(with_frame::<DeviceMessage>, &told);
    let upload_and_calibrate = ["HostMessage: upload", "HostMessage: jog", "HostMessage: calibrate"];
    with(
        with_frame::<HostMessage>,
        &["HostMessage", "HostMessage: hello", "HostMessage: order", "HostMessage: order, a force"],
    );
    with(with_frame::<HostMessage>, &upload_and_calibrate);
    with(with_frame::<HostMessage>, &["HostMessage: order, part of a feel", "HostMessage: keep the feel"]);
    with(with_frame::<Request>, &["Request"]);
    with(with_frame::<Finding>, &["Finding: Identity", "Finding: Line", "Finding: Ticks"]);
    assert_eq!(page.matches("\nFrame: `").count(), 25, "a section that is not compared");
    compare(PAGE, &page);
}

/// The page has one of them as an example, and the others by their numbers.
#[test]
fn reasons_of_a_refused_calibration_have_their_documented_numbers() {
    let errors = [
        CalibrationError::Absent,
        CalibrationError::Interrupted,
        CalibrationError::Damaged,
        CalibrationError::Version { version: 7 },
        CalibrationError::Joints { joints: 7 },
        CalibrationError::Channels,
        CalibrationError::NotFinite { joint: 7 },
        CalibrationError::Encoder { joint: 7 },
        CalibrationError::Zero { joint: 7 },
        CalibrationError::Torque { joint: 7 },
        CalibrationError::Friction { joint: 7 },
        CalibrationError::ZeroOf { joint: 7 },
        CalibrationError::Stiffness,
        CalibrationError::Damping,
        CalibrationError::Force { joint: 7 },
    ];
    for (number, error) in (0..).zip(errors) {
        let mut buffer = [0; MAX_FRAME];
        let packed =
            postcard::to_slice(&DeviceMessage::Calibrated(Calibrated::Refused(error)), &mut buffer).expect("it fits");
        let which: &[u8] = if packed.len() > 3 { &[7] } else { &[] };
        assert_eq!(*packed, [&[5, 2, number], which].concat(), "{error:?}");
    }
}
