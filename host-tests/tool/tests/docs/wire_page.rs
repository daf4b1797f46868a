//! The page that documents the frames byte by byte, against frames as they are.
//!
//! What the page says is put together here with other means than the library's: the bytes of its tables, a CRC of one
//! line and COBS by its definition. `PALPATE_WRITE=1 cargo test -p palpate-tool --test docs wire_page` writes the
//! tables anew.

use palpate::commission::{CalibrationError, Jog, JointCalibration, KEY};
use palpate::device::ZeroOf;
use palpate::scene::{Order, Pose, SceneError};
use palpate::wire::acceptance::{Counted, Finding, Identity, Line, Request, Ticks};
use palpate::wire::frame::{MAX_FRAME, pack};
use palpate::wire::{
    Answer, CHUNK, Calibrated, Command, Hello, Marked, PROTOCOL, Reading, Record, Refused, Report, Sensors, Told,
    Upload, View,
};
use serde::Serialize;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

/// A field as it is documented.
struct Field {
    name: &'static str,
    kind: &'static str,
    value: String,
    bytes: Vec<u8>,
}

fn var(mut number: u64) -> Vec<u8> {
    let mut bytes = Vec::new();
    while number >= 128 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
    bytes
}

fn zig_zag(number: i64) -> Vec<u8> {
    var(if number >= 0 { 2 * number } else { -2 * number - 1 } as u64)
}

fn field(name: &'static str, kind: &'static str, value: impl ToString, bytes: Vec<u8>) -> Field {
    Field { name, kind, value: value.to_string(), bytes }
}

fn vars(name: &'static str, number: u32) -> Field {
    field(name, "var", number, var(number.into()))
}

fn byte(name: &'static str, number: u8) -> Field {
    field(name, "u8", number, vec![number])
}

fn floats(name: &'static str, numbers: &[f32]) -> Field {
    let kind = match numbers.len() {
        1 => "f32",
        2 => "two f32",
        3 => "three f32",
        _ => "four f32",
    };
    let value: Vec<String> = numbers.iter().map(f32::to_string).collect();
    field(name, kind, value.join(", "), numbers.iter().flat_map(|number| number.to_le_bytes()).collect())
}

fn zig_zags(name: &'static str, numbers: [i64; 3]) -> Field {
    let value: Vec<String> = numbers.iter().map(i64::to_string).collect();
    field(name, "three zig-zag", value.join(", "), numbers.into_iter().flat_map(zig_zag).collect())
}

/// CRC-32, bit by bit.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 })
    })
}

/// The frame of a message's bytes.
fn frame(message: &[u8]) -> Vec<u8> {
    let mut whole = [message, &crc(message).to_le_bytes()].concat();
    whole.push(0);
    let mut frame = Vec::new();
    for stretch in whole.split_inclusive(|byte| *byte == 0) {
        assert!(stretch.len() < 255, "no message is so long");
        frame.push(stretch.len() as u8);
        frame.extend(&stretch[..stretch.len() - 1]);
    }
    frame.push(0);
    frame
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ")
}

/// A message's table and frame, as the page has them.
fn section(fields: &[Field]) -> String {
    let mut text = String::from("| at | bytes | field | kind | value |\n|---|---|---|---|---|\n");
    let mut message = Vec::new();
    for Field { name, kind, value, bytes } in fields {
        let _ = writeln!(text, "| {} | `{}` | `{name}` | {kind} | {value} |", message.len(), hexadecimal(bytes));
        message.extend(bytes);
    }
    let _ = write!(text, "\nFrame: `{}`\n", hexadecimal(&frame(&message)));
    text
}

/// The page with a message's section as it should be.
fn with_section(page: &str, title: &str, wanted: &str) -> String {
    let heading = format!("## {title}\n");
    let start = page.find(&heading).unwrap_or_else(|| panic!("the page has no section {title}")) + heading.len();
    let end = page[start..].find("\n## ").map_or(page.len(), |at| start + at);
    let table = start + page[start..end].find("| at |").unwrap_or_else(|| panic!("section {title} has no table"));
    format!("{}{wanted}{}", &page[..table], &page[end..])
}

/// Asserts that the library's frame of a message is that of its documented fields, and gives the section.
fn documented<M: Serialize>(message: &M, fields: &[Field]) -> String {
    let bytes: Vec<u8> = fields.iter().flat_map(|field| field.bytes.clone()).collect();
    let mut buffer = [0; MAX_FRAME];
    assert_eq!(hexadecimal(pack(message, &mut buffer).expect("it fits")), hexadecimal(&frame(&bytes)));
    section(fields)
}

/// Frames of a device and a host that speak with it.
fn dialogue() -> [(&'static str, String); 7] {
    let hello = Hello {
        protocol: PROTOCOL,
        rate: 4_000.0,
        max_force: 5.0,
        room: 66_560,
        faces: 240,
        edges: 600,
        flash: 65_536,
        kept: 0x1234_5678,
    };
    let hello = documented(
        &Told::Hello(hello),
        &[
            vars("told", 0),
            vars("protocol", hello.protocol.into()),
            floats("rate", &[hello.rate]),
            floats("max_force", &[hello.max_force]),
            vars("room", hello.room),
            vars("faces", hello.faces.into()),
            vars("edges", hello.edges.into()),
            vars("flash", hello.flash),
            vars("kept", hello.kept),
        ],
    );
    let refused = Some(Refused::Order(SceneError::Stiffness(1)));
    let answer = documented(
        &Told::Answer(Answer { number: 300, refused }),
        &[
            vars("told", 3),
            vars("number", 300),
            field("is_refused", "flag", 1, vec![1]),
            vars("refused", 1),
            vars("order", 2),
            byte("body", 1),
        ],
    );
    let view = View {
        tick: 70_000,
        phase: 3,
        fault: 0,
        hold: 0,
        body: 1,
        contact: 2,
        feature: 0x4003,
        gap: -0.0015,
        position: [0.05, 0.06, 0.0725],
        velocity: [0.0, -0.1, 0.02],
        force: [0.0, 0.25, 0.875],
    };
    let view = documented(
        &Told::View(view),
        &[
            vars("told", 4),
            vars("tick", view.tick),
            byte("phase", view.phase),
            byte("fault", view.fault),
            byte("hold", view.hold),
            byte("body", view.body),
            byte("contact", view.contact),
            vars("feature", view.feature.into()),
            floats("gap", &[view.gap]),
            floats("position", &view.position),
            floats("velocity", &view.velocity),
            floats("force", &view.force),
        ],
    );
    let begin =
        documented(&Command::Hello { protocol: PROTOCOL }, &[vars("command", 5), vars("protocol", PROTOCOL.into())]);
    let pose = Pose { position: [0.01, 0.0, -0.02], orientation: [0.0, 0.0, 0.6, 0.8] };
    let place = documented(
        &Command::Order { number: 300, order: Order::Place { body: 1, pose } },
        &[
            vars("command", 6),
            vars("number", 300),
            vars("order", 0),
            byte("body", 1),
            floats("position", &pose.position),
            floats("orientation", &pose.orientation),
        ],
    );
    let force = [0.0, 0.5, -1.0];
    let push = documented(
        &Command::Order { number: 301, order: Order::Push { force } },
        &[vars("command", 6), vars("number", 301), vars("order", 9), floats("force", &force)],
    );
    let mut bytes = [[0; 16]; CHUNK / 16];
    bytes[0][..4].copy_from_slice(b"\x01\x02\x03\x04");
    let part = documented(
        &Command::Upload { number: 302, part: Upload::Bytes { at: 128, bytes } },
        &[
            vars("command", 7),
            vars("number", 302),
            vars("part", 1),
            vars("at", 128),
            field("bytes", "64 bytes", "1, 2, 3, 4, 0, …", bytes.as_flattened().to_vec()),
        ],
    );
    [
        ("Hello", hello),
        ("Command: hello", begin),
        ("Command: order", place),
        ("Command: order, a force", push),
        ("Answer", answer),
        ("View", view),
        ("Command: upload", part),
    ]
}

/// A calibration that is damaged, or of another device.
fn refused_calibration() -> String {
    // In the order of their numbers.
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
    ];
    let mut section = String::new();
    for (number, error) in (0..).zip(errors) {
        let what = [vars("told", 5), vars("calibrated", 2), vars("error", number)];
        let which = match error {
            CalibrationError::Version { .. } | CalibrationError::Joints { .. } => Some(vars("which", 7)),
            CalibrationError::Absent
            | CalibrationError::Interrupted
            | CalibrationError::Damaged
            | CalibrationError::Channels => None,
            _ => Some(byte("which", 7)),
        };
        section = documented(
            &Told::Calibrated(Calibrated::Refused(error)),
            &what.into_iter().chain(which).collect::<Vec<_>>(),
        );
    }
    section
}

/// What commissioning found, to be kept.
fn calibrate() -> String {
    let joint = |joint: u8| JointCalibration {
        input: joint,
        output: joint,
        radians_per_count: 0.000_25,
        zero_of: ZeroOf::Pose,
        angle_at_zero_rad: 0.5,
        torque_at_full_n_m: -0.9,
        dry_friction_n_m: 0.01,
    };
    let joints = [joint(0), joint(1), joint(2)];
    let mut fields = vec![vars("command", 8), vars("number", 303), field("is_kept", "flag", 1, vec![1])];
    for joint in joints {
        fields.push(byte("input", joint.input));
        fields.push(byte("output", joint.output));
        fields.push(floats("radians_per_count", &[joint.radians_per_count]));
        fields.push(vars("zero_of", joint.zero_of as u32));
        fields.push(floats("angle_at_zero", &[joint.angle_at_zero_rad]));
        fields.push(floats("torque_at_full", &[joint.torque_at_full_n_m]));
        fields.push(floats("dry_friction", &[joint.dry_friction_n_m]));
    }
    documented(&Command::Calibrate { number: 303, joints: Some(joints) }, &fields)
}

/// Frames of a device that is being accepted.
fn acceptance() -> [(&'static str, String); 4] {
    let request = documented(&Request::Script { most: 5_000 }, &[vars("request", 1), vars("most", 5_000)]);
    let identity = Identity {
        core: 0x410f_c241,
        clock: 170_000_000,
        counted: Counted::Cycles,
        rate: 4_000.0,
        reset: 1,
        table: 0x89ab_cdef,
        baked: 0x89ab_cdef,
    };
    let identity = documented(
        &Finding::Identity(identity),
        &[
            vars("finding", 0),
            vars("core", identity.core),
            vars("clock", identity.clock),
            vars("counted", identity.counted as u32),
            floats("rate", &[identity.rate]),
            byte("reset", identity.reset),
            vars("table", identity.table),
            vars("baked", identity.baked),
        ],
    );
    let line = Line {
        number: 3,
        ticks: 50_000,
        digest: 0x4213_209a,
        modes: 0x7e,
        phases: 0x1e,
        faults: 0x3fe,
        touching: 4_100,
        longest: 2_412,
    };
    let line = documented(
        &Finding::Line(line),
        &[
            vars("finding", 1),
            vars("number", line.number),
            vars("ticks", line.ticks),
            vars("digest", line.digest),
            vars("modes", line.modes),
            vars("phases", line.phases),
            vars("faults", line.faults),
            vars("touching", line.touching),
            vars("longest", line.longest),
        ],
    );
    let ticks = Ticks {
        number: 12,
        ticks: 4_800,
        began: 0x89ab_cdef,
        shortest: 42_496,
        longest: 42_511,
        took: 9_800,
        overruns: 0,
        bad: [0, 2, 1],
        in_a_row: 1,
        panel: 4,
        supply: 24_050,
    };
    let ticks = documented(
        &Finding::Ticks(ticks),
        &[
            vars("finding", 3),
            vars("number", ticks.number),
            vars("ticks", ticks.ticks),
            vars("began", ticks.began),
            vars("shortest", ticks.shortest),
            vars("longest", ticks.longest),
            vars("took", ticks.took),
            vars("overruns", ticks.overruns),
            field("bad", "three var", "0, 2, 1", vec![0, 2, 1]),
            vars("in_a_row", ticks.in_a_row),
            byte("panel", ticks.panel),
            vars("supply", ticks.supply),
        ],
    );
    [("Request", request), ("Finding: Identity", identity), ("Finding: Line", line), ("Finding: Ticks", ticks)]
}

#[test]
fn every_byte_of_a_frame_is_documented() {
    let sensors = Sensors { tick: 70_000, counts: [-1, 0, 300], enable: true };
    let sensors = documented(
        &sensors,
        &[
            vars("tick", sensors.tick),
            zig_zags("counts", sensors.counts.map(i64::from)),
            field("enable", "flag", 1, vec![1]),
        ],
    );
    let report = Report {
        tick: 70_000,
        duties: [-1_200, 0, 64],
        phase: 3,
        fault: 0,
        fault_tick: 0,
        refusal: 0,
        reset: 1,
        overruns: 2,
        feature: 0x4003,
        mode: 5,
        contact: 2,
        room: 100,
        parameters: [0.5, 0.25],
        probe: [0.05, 0.06, 0.0725],
        gap: -0.0015,
        force: [0.0, 0.25, 0.875],
        frames_lost: 0,
        rejected_steps: 0,
        instructions: 1_366,
        digest: 0x4213_209a,
    };
    let report = documented(
        &report,
        &[
            vars("tick", report.tick),
            zig_zags("duties", report.duties.map(i64::from)),
            byte("phase", report.phase),
            byte("fault", report.fault),
            vars("fault_tick", report.fault_tick),
            byte("refusal", report.refusal),
            byte("reset", report.reset),
            vars("overruns", report.overruns),
            vars("feature", report.feature.into()),
            byte("mode", report.mode),
            byte("contact", report.contact),
            byte("room", report.room),
            floats("parameters", &report.parameters),
            floats("probe", &report.probe),
            floats("gap", &[report.gap]),
            floats("force", &report.force),
            vars("frames_lost", report.frames_lost),
            vars("rejected_steps", report.rejected_steps),
            vars("instructions", report.instructions),
            vars("digest", report.digest),
        ],
    );
    let record = Record {
        tick: 70_000,
        number: 1_750,
        clock: 170_000_000,
        began: 0x89ab_cdef,
        shortest: 42_496,
        longest: 42_511,
        took: 9_800,
        dropped: 0,
        phase: 3,
        fault: 0,
        fault_tick: 0,
        reset: 1,
        overruns: 2,
        bridged: 3,
        hold: 0b1010,
        feature: 0x4003,
        mode: 5,
        contact: 2,
        gap: -0.0015,
        probe: [0.05, 0.06, 0.0725],
        force: [0.0, 0.25, 0.875],
        duties: [-1_200, 0, 64],
    };
    let record = documented(
        &Told::Record(record),
        &[
            vars("told", 1),
            vars("tick", record.tick),
            vars("number", record.number),
            vars("clock", record.clock),
            vars("began", record.began),
            vars("shortest", record.shortest),
            vars("longest", record.longest),
            vars("took", record.took),
            vars("dropped", record.dropped),
            byte("phase", record.phase),
            byte("fault", record.fault),
            vars("fault_tick", record.fault_tick),
            byte("reset", record.reset),
            vars("overruns", record.overruns),
            vars("bridged", record.bridged),
            byte("hold", record.hold),
            vars("feature", record.feature.into()),
            byte("mode", record.mode),
            byte("contact", record.contact),
            floats("gap", &[record.gap]),
            floats("probe", &record.probe),
            floats("force", &record.force),
            zig_zags("duties", record.duties.map(i64::from)),
        ],
    );

    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/reference/wire.md");
    let page = fs::read_to_string(&path).expect("the page is there");
    let command = documented(&Command::Acknowledge, &[vars("command", 2)]);
    let jog = Jog { number: 300, key: KEY, motor: 2, duty: -1_200 };
    let jog = documented(
        &Command::Jog(jog),
        &[
            vars("command", 4),
            vars("number", jog.number),
            vars("key", jog.key),
            byte("motor", jog.motor),
            field("duty", "zig-zag", jog.duty, zig_zag(jog.duty.into())),
        ],
    );
    let reading = Reading {
        tick: 70_000,
        number: 300,
        counts: [-1, 0, 300],
        duties: [0, 0, -1_200],
        live: true,
        enable: true,
        refusal: 0,
        hold: 0,
    };
    let reading = documented(
        &Told::Reading(reading),
        &[
            vars("told", 2),
            vars("tick", reading.tick),
            vars("number", reading.number),
            zig_zags("counts", reading.counts.map(i64::from)),
            zig_zags("duties", reading.duties.map(i64::from)),
            field("live", "flag", 1, vec![1]),
            field("enable", "flag", 1, vec![1]),
            byte("refusal", reading.refusal),
            byte("hold", reading.hold),
        ],
    );
    let mut sections = vec![
        (
            "Calibrated",
            documented(
                &Told::Calibrated(Calibrated::Kept { crc: 300 }),
                &[vars("told", 5), vars("calibrated", 1), vars("crc", 300)],
            ),
        ),
        ("Calibrated: refused", refused_calibration()),
        (
            "Marked",
            documented(
                &Told::Marked(Marked { counts: [-1, 0, 300], passes: [1, 0, 300] }),
                &[
                    vars("told", 6),
                    zig_zags("counts", [-1, 0, 300]),
                    field("passes", "three var", "1, 0, 300", vec![1, 0, 0xac, 2]),
                ],
            ),
        ),
        ("Command: calibrate", calibrate()),
        ("Sensors", sensors),
        ("Report", report),
        ("Record", record),
        ("Command", command),
        ("Command: jog", jog),
        ("Reading", reading),
    ];
    sections.extend(dialogue());
    sections.extend(acceptance());
    let wanted = sections.iter().fold(page.clone(), |page, (title, section)| with_section(&page, title, section));
    if env::var_os("PALPATE_WRITE").is_some() {
        fs::write(&path, &wanted).expect("the page can be written");
    } else {
        assert!(page == wanted, "docs/reference/wire.md is not what the library sends; it should be:\n{wanted}");
    }
}
