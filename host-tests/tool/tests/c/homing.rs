//! A loop in C that homes by itself, beside the same loop in Rust, tick by tick over the counts of a run: by the stops
//! of the simulated arm, which the motors look for, by index marks, and in a pose.

use crate::everything::numbers;
use crate::running::{capped_box, is_wanted, program, run, with_capped_box};
use palpate::body::Body;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Homing, Reference, Refusal, SerialArm, StopSearch};
use palpate::math::vec3;
use palpate::servo::{Config, Event, Fault, Input, Phase, Servo, Settings};
use palpate_sim::plant::{HandSettings, Plant, PlantSettings, StillHand};
use std::fs;

const RATE: f32 = 4_000.0;
/// For a tenth of a second within two counts.
const STILL: [u32; 2] = [400, 2];
/// The stops of the simulated arm, from where it hangs once nothing holds it.
const STOPS: [StopSearch; 3] = [
    StopSearch { angle_rad: 1.55, speed_rad_per_s: 1.0, torque_n_m: 0.2, clearance_rad: 0.2, travel_rad: 3.3 },
    StopSearch { angle_rad: 2.15, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
    StopSearch { angle_rad: 1.75, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
];

/// A way of homing, its number in the header, and how many ticks it may take.
struct Way {
    by: u32,
    reference: Reference<3>,
    timeout: u32,
}

impl Way {
    fn homing(&self) -> Homing<3> {
        let [ticks, counts] = STILL;
        Homing::try_new(WOODEN_HAPTICS_2016.encoders, self.reference, ticks, counts, self.timeout).expect("a homing")
    }

    /// As the header's structure has it.
    fn bytes(&self) -> Vec<u8> {
        let none = |angle| StopSearch {
            angle_rad: angle,
            speed_rad_per_s: 0.0,
            torque_n_m: 0.0,
            clearance_rad: 0.0,
            travel_rad: 0.0,
        };
        let joints = match self.reference {
            Reference::Pose(angles) | Reference::Index(angles) => angles.map(none),
            Reference::Stops(stops) => stops,
            _ => panic!("not in C"),
        };
        let mut words = vec![self.by, STILL[0], STILL[1], self.timeout, 0];
        for StopSearch {
            angle_rad: angle,
            speed_rad_per_s: speed,
            torque_n_m: torque,
            clearance_rad: clearance,
            travel_rad: travel,
        } in joints
        {
            words.extend([angle, speed, torque, clearance, travel].map(f32::to_bits));
        }
        bytemuck::cast_slice(&words).to_vec()
    }
}

/// What a run comes to: the hash of its states, when it was armed, how many ticks of homing drove the first joint.
#[derive(Debug, Default)]
struct Run {
    hash: u32,
    armed: u32,
    driven: u32,
    fault: Option<Fault>,
    refusal: Option<Refusal>,
    counts: Vec<[i32; 3]>,
    marks: Vec<[i32; 2]>,
}

/// The loop in Rust against the simulated arm, its counters at zero somewhere, as after power-on.
fn in_rust(body: &Body<'_>, way: &Way, ticks: usize) -> Run {
    let settings = Settings {
        rate_hz: RATE,
        stiffness_n_per_m: 1_000.0,
        damping_n_s_per_m: 2.0,
        max_force_n: 5.0,
        velocity_corner_hz: 150.0,
        soft_start_s: 0.1,
        body_origin_m: vec3(-0.03, -0.02, -0.01675),
    };
    let servo: Servo<'_, _, SerialArm, 3> =
        Servo::try_new(&WOODEN_HAPTICS_2016, body, Config { settings, ..Config::DEFAULT }).expect("settings");
    let servo = Servo::new(servo.device(), servo.surface(), Config { homing: Some(way.homing()), ..servo.config() });
    let mut simulated = PlantSettings::wooden_haptics_2016();
    for (joint, off) in simulated.joints.iter_mut().zip([0.31, -0.47, 0.22]) {
        joint.angle_at_zero += off;
    }
    let mut plant =
        Plant::new(&simulated, HandSettings::NONE, Box::new(StillHand([0.0; 3])), RATE.into()).expect("a plant");
    let (mut state, mut run) = (servo.start(), Run::default());
    for tick in 0..ticks {
        let counts = plant.counts();
        if way.by == 2 && tick < 3 {
            let mark = counts[tick] - 17;
            run.marks.push([tick as i32, mark]);
            servo.note(&mut state, Event::IndexPassed { joint: tick, counts: Counts(mark) });
        }
        let _ = servo.tick(&mut state, Input::Sensors { counts: counts.map(Counts), enable: true });
        run.counts.push(counts);
        run.hash = (run.hash ^ state.digest()).wrapping_mul(0x0100_0193);
        if run.armed == 0 && matches!(state.phase(), Phase::Armed | Phase::Running) {
            run.armed = tick as u32;
        }
        run.driven += u32::from(state.phase() == Phase::Calibrate && state.duties()[0].0 != 0);
        plant.advance(state.duties().map(|duty| duty.0));
    }
    run.refusal = state.homing().refusal();
    run.fault = state.fault().map(|(fault, _)| fault);
    run
}

#[test]
fn a_loop_finds_its_joints_as_in_rust() {
    if !is_wanted("homing in C") {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    program("tests/home.c", folder.path(), &[]);
    let words = run(&mut std::process::Command::new(path("program")));
    let refusals = Refusal::ALL.map(|refusal| refusal.to_string());
    let faults = Fault::ALL.map(|fault| fault.to_string());
    let each = |words: &[String]| [&["none".to_owned()], words, &["unknown".to_owned()]].concat();
    assert_eq!(words.lines().collect::<Vec<_>>(), [each(&refusals), each(&faults)].concat());
    // Arm and device, without what protects it.
    let numbers = numbers();
    fs::write(path("numbers"), bytemuck::cast_slice::<f32, u8>(&numbers)).expect("numbers");
    let pose = [0.1, 0.4, 0.2];
    for (name, way, ticks, homes) in [
        ("stops", Way { by: 3, reference: Reference::Stops(STOPS), timeout: 60_000 }, 40_000, true),
        (
            "stops, given too little time",
            Way { by: 3, reference: Reference::Stops(STOPS), timeout: 4_000 },
            6_000,
            false,
        ),
        ("index marks", Way { by: 2, reference: Reference::Index(pose), timeout: 60_000 }, 2_000, true),
        ("a pose", Way { by: 1, reference: Reference::Pose(pose), timeout: 60_000 }, 20_000, true),
    ] {
        let rust = with_capped_box(|body| in_rust(body, &way, ticks));
        assert_eq!(rust.armed != 0, homes, "{name}: {:?} after {} ticks", rust.fault, rust.counts.len());
        assert_eq!(rust.driven > 0, way.by == 3, "{name}: driven for {} ticks", rust.driven);
        assert_eq!(rust.fault == Some(Fault::Homing), !homes, "{name}: {:?}", rust.fault);
        fs::write(path("homing"), way.bytes()).expect("homing");
        fs::write(path("counts"), bytemuck::cast_slice::<[i32; 3], u8>(&rust.counts)).expect("counts");
        fs::write(path("marks"), bytemuck::cast_slice::<[i32; 2], u8>(&rust.marks)).expect("marks");
        let mut home = std::process::Command::new(path("program"));
        home.arg(capped_box()).args(["numbers", "homing", "counts"].map(path));
        if !rust.marks.is_empty() {
            home.arg(path("marks"));
        }
        // In a pose that is not the arm's it is soon out of its range.
        let none = || "none".to_owned();
        let refusal = rust.refusal.map_or_else(none, |refusal| refusal.to_string());
        let ended = format!("{}: {refusal}", rust.fault.map_or_else(none, |fault| fault.to_string()));
        assert_eq!(rust.refusal.is_some(), !homes, "{name}: {refusal}");
        let wanted = format!("{:08x} {} {} {ended}", rust.hash, rust.armed, rust.driven);
        assert_eq!(run(&mut home).trim(), wanted, "{name}");
        println!("homed by {name}: {:08x} in C and in Rust, armed after {} ticks, {ended}", rust.hash, rust.armed);
    }
}
