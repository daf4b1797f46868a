//! A device that is set up over an emulated board's serial port, by the command that sets up a real one.

use crate::running::is_wanted;
use palpate::servo::{Fault, Phase};
use palpate::wire::frame::{Received, Receiver};
use palpate::wire::{Calibrated, DeviceMessage, Record, Sensors};
use palpate_sim::devices::{self, OwnDevice};
use palpate_sim::plant::{HandPath, HandSettings, Plant, Vector};
use palpate_tool::commission::{
    Device, EmulatedLine, KeyHeld, Lab, Planted, PlantedFault, RATE, SimulatedHands, World, Zero, calibration,
    find_mounting,
};
use palpate_tool::firmware::{Choice, Link as _, Program, Progress};
use std::io::Read as _;
use std::process::Command;

/// A hand that goes up and down through the middle of the capped box's cap.
struct UpAndDown;

impl HandPath for UpAndDown {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, 0.02 + 0.012 * (7.0 * time).sin()]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, 0.084 * (7.0 * time).cos()]
    }
}

/// What two seconds at a board come to.
#[derive(Debug)]
struct Felt {
    calibrated: Option<Calibrated>,
    /// The last record.
    record: Record,
    /// The greatest force told, N, and how many ticks a motor was driven.
    force: f32,
    driven: u32,
}

/// Two seconds of a board with this in its flash, at the pins of a planted device: the button is pressed after a tenth.
fn run(program: &Program, flash: &[u8], planted: &Planted) -> Felt {
    let (mut pins, mut port) = program.start_with_flash(flash).expect("it starts");
    port.set_nonblocking(true).expect("a socket");
    let hand = HandSettings { stiffness: 800.0, damping: 10.0, mass: 0.0 };
    let mut plant = Plant::new(&planted.plant, hand, Box::new(UpAndDown), f64::from(RATE)).expect("a device");
    let mut felt = Felt { calibrated: None, record: Record::default(), force: 0.0, driven: 0 };
    let mut receiver = Receiver::new();
    for tick in 0..8_000 {
        let joints = plant.counts();
        let counts = planted.encoder_on.map(|joint| joints[joint]);
        let report = pins.exchange(&Sensors { tick, counts, enable: tick >= 400 }).expect("the board answers");
        felt.driven += u32::from(report.duties != [0; 3]);
        let mut duties = [0; 3];
        for (duty, joint) in report.duties.into_iter().zip(planted.motor_on) {
            duties[joint] = duty;
        }
        plant.advance(duties);
        let mut buffer = [0; 4_096];
        let came = port.read(&mut buffer).unwrap_or(0);
        for byte in &buffer[..came] {
            match receiver.feed(*byte) {
                Some(Received::Message(DeviceMessage::Calibrated(calibrated))) => felt.calibrated = Some(calibrated),
                Some(Received::Message(DeviceMessage::Record(record))) => {
                    felt.record = record;
                    let [x, y, z] = record.force;
                    felt.force = felt.force.max((x * x + y * y + z * z).sqrt());
                }
                _ => {}
            }
        }
    }
    felt
}

#[test]
fn a_board_whose_device_is_not_what_it_was_built_for_runs_right_once_it_keeps_what_was_found() {
    if !is_wanted("a_board_whose_device_is_not_what_it_was_built_for_runs_right_once_it_keeps_what_was_found") {
        return;
    }
    let shipped = devices::named("woodenhaptics-2016").expect("it ships");
    let own = OwnDevice::new(shipped.file().expect("three joints"), shipped.name).expect("a device");
    let faults = [
        PlantedFault::Encoders(0, 2),
        PlantedFault::Motors(0, 1),
        PlantedFault::EncoderSign(1),
        PlantedFault::MotorSign(2),
        PlantedFault::Ratio(1, 2.0),
        PlantedFault::Zero(0, 0.2),
    ];
    let planted = faults.iter().fold(Planted::sound(shipped.plant), |planted, fault| planted.with(*fault));
    let folder = tempfile::tempdir().expect("a folder");
    let settings = folder.path().join("settings.rs");
    std::fs::write(&settings, devices::settings_source(&own, RATE)).expect("it is written");
    let choice = Choice { settings: Some(settings), ..Choice::default() };
    let built = || Program::prepare_with(&choice, "bench", &[], &Progress::new()).expect("it builds");
    // As it was built.
    let program = built();
    let before = run(&program, &[], &planted);
    println!("before: {before:?}");
    assert_eq!(before.calibrated, Some(Calibrated::BuiltIn));
    assert!(before.record.fault != 0 || before.force < 0.5, "{before:?}");
    // Measured over its line, and kept.
    let world = World::shared(planted).expect("a bench");
    let line = EmulatedLine::start(built(), &world).expect("it starts");
    let device = Device::connect(Box::new(line), Box::new(KeyHeld)).expect("it answers");
    let mut lab = Lab { device, hands: Box::new(SimulatedHands::new(&world)) };
    let (file, _) = find_mounting(&mut lab, &own, Zero::Jig).expect("it is found");
    let kept = calibration(&OwnDevice::new(file, "found").expect("a device")).expect("three joints");
    lab.hands.enable(false).expect("simulated");
    lab.device.keep(Some(kept.0)).expect("it is kept");
    assert!(lab.device.reset().expect("it starts"));
    assert_eq!(lab.device.calibrated(), Some(Calibrated::Kept { crc: kept.crc() }));
    let flash: Vec<u8> = kept.to_words().into_iter().flat_map(u32::to_le_bytes).collect();
    // The page as that board has it.
    let mut page = vec![0xff; 2_048];
    page[..flash.len()].copy_from_slice(&flash);
    let after = run(&program, &page, &planted);
    println!("after: {after:?}");
    assert_eq!(after.calibrated, Some(Calibrated::Kept { crc: kept.crc() }));
    assert_eq!((after.record.fault, after.record.phase), (0, Phase::Running as u8));
    assert!(after.force > 1.0 && after.driven > 1_000, "{after:?}");
    // A bit of it flipped: nothing is driven, and it says why.
    page[17] ^= 8;
    let spoilt = run(&program, &page, &planted);
    println!("spoilt: {spoilt:?}");
    assert!(matches!(spoilt.calibrated, Some(Calibrated::Refused(_))), "{spoilt:?}");
    assert_eq!((spoilt.record.fault, spoilt.driven), (Fault::Calibration.code(), 0));
}

#[test]
fn what_is_planted_in_the_device_at_an_emulated_board_is_found_over_its_line() {
    if !is_wanted("what_is_planted_in_the_device_at_an_emulated_board_is_found_over_its_line") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("found.toml");
    let run = Command::new(env!("CARGO_BIN_EXE_palpate"))
        .args(["commission", "--emulator", "m4", "--device", "phantom-premium", "--plant", "encoder-sign:1"])
        .args(["--plant", "motors:0-2", "--out"])
        .arg(&out)
        .output()
        .expect("it runs");
    let (said, complained) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    println!("{said}{complained}");
    assert!(run.status.success());
    for finding in ["joint b: encoder sign", "joint a: motor on output 2", "joint c: motor on output 0"] {
        assert!(said.contains(finding), "{finding}");
    }
    assert!(said.contains("3 found"), "and nothing else");
    let found = OwnDevice::read(&out).expect("a device file");
    assert_eq!(found.file.joint.iter().map(|joint| joint.motor.channel).collect::<Vec<_>>(), [2, 1, 0]);
}
