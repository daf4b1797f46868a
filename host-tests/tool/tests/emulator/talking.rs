//! A host that speaks with an emulated board, by the command that speaks with a real one.

use crate::running::is_wanted;
use palpate::wire::hold;
use palpate_link::{Device, SILENCE};
use palpate_tool::firmware::Board;
use palpate_tool::talk::{Emulated, Log, Press};
use std::io::Write as _;
use std::process::{Command, Stdio};
use std::time::Duration;

const SESSION: &str = "wait 0.5\nwhere\nplace 0 0 0 -10\nwait 0.1\nwhere\nlimit 2\nupload 1 capped_box\npush 0 0 1\n\
                       wait 0.3\nwhere\nstop\nwhere\n";

/// What a session with an emulated board prints.
fn talk(arguments: &[&str], lines: &str) -> String {
    let mut run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["talk", "--emulator", "m4"])
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("it starts");
    run.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("it reads");
    let run = run.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    println!("{said}");
    assert!(run.status.success());
    said
}

#[test]
fn a_host_places_pushes_uploads_and_stops_an_emulated_board() {
    if !is_wanted("a_host_places_pushes_uploads_and_stops_an_emulated_board") {
        return;
    }
    let said = talk(&[], SESSION);
    let views: Vec<_> = said.lines().filter(|line| line.starts_with("at ")).collect();
    let [before, after, pushed, stopped] = views[..] else { panic!("four views") };
    let gap = |view: &str| -> f64 {
        let rest = view.split("gap ").nth(1).and_then(|rest| rest.split(' ').next());
        rest.and_then(|gap| gap.parse().ok()).expect("a gap")
    };
    // A body 10 mm lower, less what the tip swings.
    assert!(before.ends_with("running") && (gap(after) - gap(before) - 10.0).abs() < 0.5, "{before}\n{after}");
    assert!(said.contains("4532 of 4532 bytes"));
    assert!(pushed.contains("force 0.00 0.00 1.00 N"), "{pushed}");
    assert!(stopped.ends_with("stopped: stopped by hand"), "{stopped}");
}

/// The list of `docs/howto/knob.md`, whose last line comes while the knob is under force: it is on its way before the
/// device sees the button released.
#[test]
fn a_feel_is_kept_though_the_button_is_released_only_then() {
    if !is_wanted("a_feel_is_kept_though_the_button_is_released_only_then") {
        return;
    }
    let again = "press\nwait 0.5\nkeep-feel\n".repeat(2);
    let said = talk(
        &["--device", "knob"],
        &format!("free\ndamping 0.3\nclicks 15 30 -5 5\nnotch 10 20 20\ndial 0.1\nkeep-feel\n{again}"),
    );
    assert_eq!(said.matches("kept: the knob starts with this feel").count(), 3);
}

#[test]
fn a_log_of_an_emulated_board_has_the_values_of_its_ticks() {
    if !is_wanted("a_log_of_an_emulated_board_has_the_values_of_its_ticks") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("log.csv");
    let line = Emulated::start(Board::M4).expect("the emulator starts");
    let button = line.button();
    let mut device = Device::over(line).expect("it greets");
    // It asks for a button that it has seen released.
    while device.view(SILENCE).expect("a view").hold & hold::RELEASE_FIRST != 0 {}
    button(Press::Down);
    let mut log = Log::create(&path, &device.hello(), None).expect("a log");
    let (first, _) = device.line().take_probes();
    device.take_views();
    let until = device.now() + Duration::from_secs(2);
    while device.now() < until {
        // It moves the hand by some millimetres, once force may be given.
        device.push([0.0, 0.0, 1.5]).expect("a push");
        device.view(SILENCE).expect("a view");
        log.take(&device.take_views()).expect("rows");
    }
    let (said, (_, probes)) = (log.end(false).expect("the end"), device.line().take_probes());
    let mut reader = csv::Reader::from_path(&path).expect("a log");
    let rows: Vec<_> = reader.records().map(|row| row.expect("a row")).collect();
    let missing: usize = rows.iter().map(|row| row[2].parse::<usize>().expect("a count")).sum();
    assert!((rows.len() + missing).abs_diff(probes.len() / 4) <= 3, "{} + {missing}: {}", rows.len(), probes.len());
    let (mut worst, mut compared, mut highest) = (0.0_f64, 0, f64::NEG_INFINITY);
    for row in &rows {
        let tick: u32 = row[0].parse().expect("a tick");
        let Some(probe) = tick.checked_sub(first).and_then(|index| probes.get(index as usize)) else { continue };
        let logged = [10, 11, 12].map(|column| row[column].parse::<f64>().expect("a number"));
        worst = (0..3).map(|axis| (logged[axis] - probe[axis]).abs()).fold(worst, f64::max);
        (compared, highest) = (compared + 1, highest.max(probe[2] - probes[0][2]));
    }
    println!("{said}: {} ticks, {:.1} um off, moved {:.2} mm", probes.len(), worst * 1e6, highest * 1e3);
    // A count or two of the encoders, 20 um each; and the arm moves by no more in a tick.
    assert!(worst < 60e-6 && highest > 1e-3 && compared > 1_000, "{worst} {highest} {compared} of {}", rows.len());
}
