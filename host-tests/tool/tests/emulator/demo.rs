//! The demo's own scene, whole: the host's loop and the firmware's agree bit for bit, tick by tick, while each drives
//! the plant with its own duties.

use crate::running::{boards, is_wanted};
use clap::Parser;
use palpate::servo::Fault;
use palpate_tool::commands::demo::program;
use palpate_tool::commands::options::{RATES, Scene, SceneOptions};
use palpate_tool::commands::rate::in_time;
use palpate_tool::firmware::{Board, Link, Progress, Transport, is_long};
use palpate_tool::report::Summary;
use palpate_tool::simulation::{Trace, run};

#[derive(Parser)]
struct Demo {
    #[command(flatten)]
    options: SceneOptions,
}

fn trace(options: &SceneOptions, scene: &Scene, link: &mut dyn Link) -> Trace {
    let mut plant = options.plant(scene).expect("the plant starts");
    run(link, &mut plant, scene.span(), |_| ()).expect("no frame is lost")
}

/// The firmware's trace and the host's of a scene from the command line, the same in every bit of every tick.
fn traces(arguments: &[&str]) -> [Trace; 2] {
    traces_on(Board::M4, arguments)
}

/// The same on a board.
fn traces_on(board: Board, arguments: &[&str]) -> [Trace; 2] {
    let Demo { options } = Demo::parse_from(arguments);
    let scene = options.scene().expect("the demo's scene");
    let firmware = program(board, &scene, Transport::Fifo, &Progress::new()).expect("the image builds");
    let mut emulator = firmware.start_over(Transport::Fifo).expect("the emulator starts");
    let device = trace(&options, &scene, &mut emulator);
    let host = trace(&options, &scene, scene.host_loop().expect("good settings").as_mut());

    assert_eq!(device.samples.len(), host.samples.len());
    for (there, here) in device.samples.iter().zip(&host.samples) {
        assert_eq!(there.sensors, here.sensors, "the plant saw other duties before tick {}", here.report.tick);
        assert_eq!(there.report.digest, here.report.digest, "the states differ after tick {}", here.report.tick);
    }
    [device, host]
}

/// The board's reports do not carry the count.
#[test]
fn the_contacts_that_a_board_released_are_counted() {
    if !is_wanted("a contact released on the emulated board") {
        return;
    }
    let Demo { options } = Demo::parse_from(["demo", "--max-force", "0.5"]);
    let scene = options.scene().expect("the demo's scene");
    let [mut board, host] = traces(&["demo", "--max-force", "0.5"]);
    assert_eq!((board.contacts_lost, host.contacts_lost), (None, Some(1)));
    let again = scene.host_loop().expect("good settings");
    board.count_contacts_lost({ again }.as_mut(), scene.tool).expect("no frame is lost");
    assert_eq!(board.contacts_lost, Some(1));
}

#[test]
fn every_device_of_three_joints_touches_alike_on_host_and_board() {
    if !is_wanted("the other devices on the emulated board") {
        return;
    }
    // The hand needs two seconds for its touches.
    for name in ["polhem-v2", "phantom-premium", "falcon"] {
        let [board, _] = traces(&["demo", "--device", name, "--seconds", "2"]).map(|trace| Summary::new(&trace));
        assert!(board.touches > 0 && board.fault.is_none() && board.rejected_steps == 0, "{name}: {board}");
        println!("{name}: {:?}", board.rows());
    }
}

#[test]
fn the_protected_demo_touches_alike_on_host_and_board_and_without_an_alarm() {
    if !is_wanted("the protected demo on the emulated board") {
        return;
    }
    let [board, _] = traces(&["demo", "--seconds", "2", "--protected"]).map(|trace| Summary::new(&trace));
    assert!(board.touches > 0 && board.fault.is_none(), "{board}");
}

/// Bodies on paths, and a free one that is pushed; and on the first board bodies with effects.
#[test]
fn a_scene_that_moves_is_felt_alike_on_the_host_and_every_board() {
    if !is_wanted("a scene on the emulated boards") {
        return;
    }
    let [turntable, effects] =
        ["turntable", "effects"].map(|name| format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR")));
    let runs = boards().iter().map(|&board| (board, &turntable)).chain([(Board::M4, &effects)]);
    for (board, scene) in runs {
        let arguments = ["demo", "--model", scene, "--rate", "3000", "--seconds", "3"];
        let [there, _] = traces_on(board, &arguments).map(|trace| Summary::new(&trace));
        assert!(there.touches > 0 && there.fault.is_none(), "{board:?}: {there}");
        println!("{board:?}: {:?}", there.rows());
    }
}

/// A capsule on a gimbal. Its worst tick takes more instructions than the board has at 2 kHz.
#[test]
fn a_tool_with_a_shape_touches_alike_on_host_and_board() {
    if !is_wanted("a tool with a shape on the emulated board") {
        return;
    }
    let arguments = ["demo", "--tool", "capsule", "--rate", "1000", "--seconds", "2"];
    let [board, _] = traces(&arguments).map(|trace| Summary::new(&trace));
    assert!(board.touches > 1 && board.contact_time > 0.5 && board.fault.is_none(), "{board}");
    assert!(board.largest_force > 0.5 && board.frames_lost == 0, "{board}");
    println!("{:?}", board.rows());
}

/// The rates at which a part from CAD is tried, from the first on, with the fault of each, and the last run's figures.
fn felt(part: &str, first: f32) -> (Vec<(f32, Option<Fault>)>, Summary) {
    let model = format!("{}/../suites/data/{part}.toml", env!("CARGO_MANIFEST_DIR"));
    let Demo { options } = Demo::parse_from(["demo", "--model", &model]);
    let mut scene = options.scene().expect("the part's scene");
    options.change_rate(&mut scene, first).expect("a rate");
    let mut tried = Vec::new();
    let run = |scene: &Scene| {
        let firmware = program(Board::M4, scene, Transport::Fifo, &Progress::new()).expect("the image builds");
        let run = trace(&options, scene, &mut firmware.start_over(Transport::Fifo).expect("the emulator starts"));
        tried.push((scene.settings.rate_hz, Summary::new(&run).fault.map(|(fault, _)| fault)));
        Ok(run)
    };
    let last = in_time(&options, &mut scene, run, |run| run).expect("rates that can be run");
    let last = Summary::new(&last);
    println!("{part}: {:?}", last.rows());
    assert!(last.touches > 3 && last.contact_time > 0.5 && last.frames_lost == 0, "{part}: {last}");
    (tried, last)
}

#[test]
fn a_rounded_box_from_cad_is_felt_without_a_fault() {
    if !is_wanted("a rounded box from CAD on the emulated board") {
        return;
    }
    let (tried, last) = felt("rounded_box", RATES[0]);
    assert_eq!(tried, [(4_000.0, None)]);
    assert!(last.ticks == 20_000 && last.features[0] > 10, "{last}");
}

/// Of degree 5: its worst tick takes more than the 1,560 instructions that the board has at 40 kHz.
#[test]
fn a_shell_too_heavy_for_a_rate_is_felt_at_a_lower_one() {
    if !is_wanted("a shell of degree 5 on the emulated board") {
        return;
    }
    let (tried, last) = felt("shell", 40_000.0);
    assert_eq!(tried[0], (40_000.0, Some(Fault::Overrun)));
    let (rate, fault) = tried[tried.len() - 1];
    assert!(RATES.contains(&rate) && fault.is_none(), "{tried:?}");
    // Five seconds of it.
    assert_eq!(last.ticks, 5 * rate as usize);
}

#[test]
fn host_and_firmware_agree_in_every_bit_of_every_tick_of_the_demo() {
    if !is_wanted("the demo on the emulated board") {
        return;
    }
    let [device, host] = traces(&["demo"]);
    let [device, host] = [device, host].map(|trace| Summary::new(&trace));
    assert_eq!(device.state_hash, host.state_hash);
    // The same on cores of other kinds; those without floats do not reach the demo's rate.
    for board in Board::ALL.into_iter().filter(|_| is_long()) {
        let arguments: &[&str] = if board.has_floats() { &["demo"] } else { &["demo", "--rate", "1000"] };
        let [other, here] = traces_on(board, arguments).map(|trace| Summary::new(&trace));
        assert!(
            other.state_hash == here.state_hash && other.fault.is_none() && other.touches > 3,
            "{board:?}: {other}"
        );
        assert!(!board.has_floats() || other.state_hash == device.state_hash);
    }
    // A demo that touches nothing would agree too.
    assert!(host.ticks == 20_000 && host.touches > 3 && host.mode_changes > 3 && host.contact_time > 1.0, "{host}");
    // What else the README shows of the demo is held to the host's run of it (`docs/readme.rs`): it is the same.
    let readme = include_str!("../../../../README.md");
    let row = format!("  {:<20} {:08x}", "state hash", device.state_hash);
    assert!(readme.contains(&row), "the README does not show {row:?}");
    assert!(device.fault.is_none() && device.frames_lost == 0 && device.rejected_steps == 0, "{device}");
}
