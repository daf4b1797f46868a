//! Telemetry from the emulated board over a line that loses and damages frames, through `palpate monitor` into a CSV
//! file.

use crate::path::{TICKS, sensors};
use crate::running::is_wanted;
use nix::fcntl::{FcntlArg, FdFlag, fcntl};
use nix::pty::{OpenptyResult, openpty};
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};
use palpate::wire::frame::DELIMITER;
use palpate::wire::{Report, Sensors};
use palpate_tool::firmware::{Board, Emulator, Link, Program, Progress};
use std::fs::{self, File};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// How long to wait for another process. On a loaded machine seconds; what fails only after this never comes.
const PATIENCE: Duration = Duration::from_secs(120);

/// Moves into the surface with force asked for, pulls the sensors out, and gives every tick's report.
fn drive(mut emulator: Emulator) -> Vec<Report> {
    let mut reports: Vec<Report> =
        (0..TICKS).map(|tick| emulator.exchange(&sensors(tick)).expect("the emulator answers")).collect();
    for tick in TICKS..TICKS + 100 {
        let harmed = if tick == TICKS { Sensors { counts: [i32::MAX; 3], ..sensors(tick) } } else { sensors(tick) };
        reports.push(emulator.exchange(&harmed).expect("the emulator answers"));
    }
    reports
}

/// Reads a line to its end, in frames, each with its delimiter.
fn frames(mut line: TcpStream) -> JoinHandle<Vec<Vec<u8>>> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        // The emulator may be killed in the middle of a byte: what came before it counts.
        let _ = line.read_to_end(&mut bytes);
        bytes.split_inclusive(|byte| *byte == DELIMITER).map(<[u8]>::to_vec).collect()
    })
}

/// What the monitor recorded, by the names of the columns.
fn rows(csv: &str) -> Vec<Vec<(String, f64)>> {
    let mut reader = csv::Reader::from_reader(csv.as_bytes());
    let names: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let row = |row: csv::StringRecord| {
        let numbers = row.iter().map(|field| if field.is_empty() { f64::NAN } else { field.parse().unwrap() });
        names.iter().cloned().zip(numbers).collect()
    };
    reader.records().map(|record| row(record.unwrap())).collect()
}

fn get(row: &[(String, f64)], name: &str) -> f64 {
    row.iter().find(|(column, _)| column == name).unwrap_or_else(|| panic!("no column {name}")).1
}

#[test]
fn what_the_board_tells_is_recorded_though_the_line_is_bad() {
    if !is_wanted("what_the_board_tells_is_recorded_though_the_line_is_bad") {
        return;
    }
    let program = Program::prepare(Board::default(), "telemetry", &[], &Progress::new()).unwrap();
    let (emulator, line) = program.start_with_telemetry().unwrap();
    let frames = frames(line);
    let reports = drive(emulator);
    let mut frames = frames.join().unwrap();
    // Killed in the middle of a frame, perhaps.
    frames.retain(|frame| frame.last() == Some(&DELIMITER));
    assert!(frames.len() as u32 >= reports.len() as u32 / 40, "only {} frames", frames.len());

    // A terminal in the place of a serial port.
    let OpenptyResult { master, slave } = openpty(None, None).unwrap();
    // Else the monitor would hold the other end of its own line, which then never closes.
    for end in [&master, &slave] {
        fcntl(end, FcntlArg::F_SETFD(FdFlag::FD_CLOEXEC)).unwrap();
    }
    let mut settings = tcgetattr(&slave).unwrap();
    cfmakeraw(&mut settings);
    tcsetattr(&slave, SetArg::TCSANOW, &settings).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("record.csv");
    let port = nix::unistd::ttyname(&slave).unwrap();
    let monitor = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .arg("monitor")
        .arg("--port")
        .arg(&port)
        .arg("--csv")
        .arg(&csv)
        // It ends with its line; this only keeps a failure from lasting for ever.
        .args(["--for", "600"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();

    // There is no file before the first record.
    let rows_so_far = || fs::read_to_string(&csv).map_or(0, |text| text.lines().count().saturating_sub(1));
    let wait_for = |what: &str, is_there: &dyn Fn() -> bool| {
        let start = Instant::now();
        while !is_there() {
            assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
            std::thread::sleep(Duration::from_millis(10));
        }
    };
    // Opening a port discards what came before: the first frame is sent until it shows.
    let mut master = File::from(master);
    wait_for("the first record", &|| {
        let mut master = &master;
        master.write_all(&frames[0]).unwrap();
        std::thread::sleep(Duration::from_millis(100));
        rows_so_far() > 0
    });

    let (mut good, mut damaged) = (Vec::new(), 0);
    let last = frames.len() - 1;
    for (number, frame) in frames.iter().enumerate().skip(1) {
        let mut frame = frame.clone();
        if number != last && number % 7 == 3 {
            let middle = frame.len() / 2;
            frame[middle] ^= if frame[middle] == 1 { 2 } else { 1 };
            damaged += 1;
        } else if number != last && number % 11 == 5 {
            frame.clear();
        } else {
            good.push(number);
        }
        master.write_all(&frame).unwrap();
    }
    let last_number = last.to_string();
    wait_for("the last record", &|| {
        let text = fs::read_to_string(&csv).unwrap();
        text.ends_with('\n') && text.lines().last().unwrap().split(',').nth(1) == Some(&last_number)
    });
    drop((master, slave));
    let output = monitor.wait_with_output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}");

    let text = fs::read_to_string(&csv).unwrap();
    let all = rows(&text);
    // The first frame may have been recorded more than once.
    let rows = &all[all.iter().rposition(|row| get(row, "number") == 0.0).unwrap() + 1..];
    assert_eq!(rows.iter().map(|row| get(row, "number") as usize).collect::<Vec<_>>(), good);
    let lost = last - good.len();
    assert!(said.contains(&format!("{lost} lost on the line, {damaged} of them damaged")), "{said}");
    assert!(said.contains("fault") && said.contains("joint angle out of range at tick 2000"), "{said}");

    for row in rows {
        let report = &reports[get(row, "tick") as usize];
        // The shortest text that reads back as the same number: f64 holds it.
        let same =
            |name: &str, number: f32| assert!((get(row, name) as f32).to_bits() == number.to_bits(), "{name}: {row:?}");
        same("gap", report.gap);
        for (name, component) in ["force_x", "force_y", "force_z"].into_iter().zip(report.force) {
            same(name, component);
        }
        for (name, duty) in ["duty_a", "duty_b", "duty_c"].into_iter().zip(report.duties) {
            assert_eq!(get(row, name) as i16, duty);
        }
        let numbers = ["phase", "fault", "mode", "contact"].map(|name| get(row, name) as u8);
        assert_eq!(numbers, [report.phase, report.fault, report.mode, report.contact], "tick {}", report.tick);
        // By the board's clock: each interrupt is late by less than an instruction or two, of 3,906 a period.
        // The first one opens the link before the clock starts.
        if report.tick > 1 {
            assert!((get(row, "rate") - 4_000.0).abs() < 4.0 || get(row, "rate").is_nan(), "{row:?}");
            assert!(get(row, "shortest_us") > 245.0 && get(row, "longest_us") < 255.0, "{row:?}");
        }
        assert!(get(row, "dropped") == 0.0, "{row:?}");
    }
    // It was worth recording: force, and a fault with the tick in which it was seen. The record of that very tick may
    // be one that was spoiled.
    assert!(rows.iter().any(|row| get(row, "force") > 0.5));
    assert!(rows.iter().any(|row| get(row, "fault_tick") == f64::from(TICKS) && get(row, "fault") == 3.0));
}
