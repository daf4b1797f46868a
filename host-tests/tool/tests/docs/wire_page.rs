//! `docs/reference/wire.md` documents the frames byte by byte: golden bytes of what the library packs and takes.
//!
//! `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs wire_page` writes the frames of the tables' bytes.

use crate::byte_tables::{Row, hexadecimal, numbers, table, written};
use crate::pages::{compare, text};
use palpate::commission::CalibrationError;
use palpate::render::{Detents, DialFriction, Ends, FeelPart, Notch, Spring, Wave};
use palpate::wire::acceptance::{Finding, Request};
use palpate::wire::frame::{MAX_FRAME, pack};
use palpate::wire::{Calibrated, DeviceMessage, HostMessage, Report, Sensors};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::{Debug, Write as _};

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

/// Rows of the parts of a feel: the number on the wire, the struct, and its fields in order.
fn parts() -> String {
    let wave = Wave { pitch_rad: 0.25, torque_n_m: 0.5, centre_rad: 0.75 };
    let clicks = Detents {
        pitch: 0.25,
        stiffness: 0.5,
        damping: 0.75,
        snap: 1.25,
        first: -1,
        last: 2,
        wall_stiffness: 1.5,
        max_force: 1.75,
    };
    let spring = Spring { stiffness_n_m_per_rad: 0.25, rest_rad: 0.5, max_torque_n_m: 0.75 };
    let ends = Ends { between_rad: [0.25, 0.5], stiffness_n_m_per_rad: 0.75, damping_n_m_s_per_rad: 1.25 };
    let friction = DialFriction { torque_n_m: 0.25, whole_at_rad_per_s: 0.5 };
    let notch = Notch { at_rad: 0.25, width_rad: 0.5, torque_n_m: 0.75 };
    let parts = [
        FeelPart::Detents(Some(wave)),
        FeelPart::Clicks(Some(clicks)),
        FeelPart::Texture(Some(wave)),
        FeelPart::Spring(Some(spring)),
        FeelPart::Ends(Some(ends)),
        FeelPart::Damping(0.25),
        FeelPart::Friction(Some(friction)),
        FeelPart::Notch(Some(notch)),
        FeelPart::Free,
    ];
    let mut rows =
        String::from("| number | part | struct | fields in order, f32 but where stated |\n|---|---|---|---|\n");
    for (number, part) in (0..).zip(parts) {
        let shown = format!("{part:?}");
        let (name, rest) = shown.split_once('(').unwrap_or((&shown, ""));
        let is_optional = rest.starts_with("Some");
        let of = rest.trim_start_matches("Some(").split_once(" {").map_or("", |(of, _)| of);
        let fields = rest.split_once('{').map_or(rest, |(_, fields)| fields).trim_matches([' ', '}', ')']);
        let (mut bytes, mut columns) = (vec![number], Vec::new());
        bytes.extend(is_optional.then_some(1));
        for field in fields.split(", ").filter(|field| !field.is_empty()) {
            let (name, value) = field.split_once(": ").unwrap_or(("", field));
            let value = value.trim_matches(['[', ']']);
            let kind = if let Ok(integer) = value.parse::<i32>() {
                bytes.extend(postcard::to_slice(&integer, &mut [0; 5]).expect("it fits").iter());
                ", zig-zag"
            } else {
                bytes.extend(value.parse::<f32>().expect("a number").to_le_bytes());
                ""
            };
            match columns.last_mut() {
                _ if !name.is_empty() => columns.push(format!("`{name}`{}{kind}", unit_of(name))),
                None => columns.push(unit_of("damping").trim_start().to_owned()),
                Some(pair) => pair.push_str(" twice"),
            }
        }
        let mut buffer = [0; MAX_FRAME];
        assert_eq!(
            hexadecimal(postcard::to_slice(&part, &mut buffer).expect("it fits")),
            hexadecimal(&bytes),
            "{shown}"
        );
        let _ = writeln!(rows, "| {number} | {} | {of} | {} |", name.to_lowercase(), columns.join(", "));
    }
    rows
}

/// From a name's ending, or of clicks, whose names have none.
fn unit_of(name: &str) -> &'static str {
    let endings = [
        ("_n_m_s_per_rad", " N·m·s/rad"),
        ("_n_m_per_rad", " N·m/rad"),
        ("_rad_per_s", " rad/s"),
        ("_rad", " rad"),
        ("_n_m", " N·m"),
        ("pitch", " rad"),
        ("stiffness", " N·m/rad"),
        ("damping", " N·m·s/rad"),
        ("max_force", " N·m"),
        ("snap", " pitches"),
        ("first", ""),
        ("last", ""),
    ];
    endings.into_iter().find(|(end, _)| name.ends_with(end)).unwrap_or_else(|| panic!("{name} has no unit")).1
}

#[test]
fn every_part_of_a_feel_is_documented() {
    const MARK: &str = "<!-- generated: parts of a feel, by the test wire_page -->\n\n";
    let page = text(PAGE);
    let (before, rest) = page.split_once(MARK).expect("a generated block");
    let (_, after) = rest.split_once("\n<!-- end -->").expect("its end");
    compare(PAGE, &format!("{before}{MARK}{}\n<!-- end -->{after}", parts()));
}
