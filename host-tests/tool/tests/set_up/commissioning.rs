//! Commissioning of simulated devices in which something was planted: each fault is found, the file that is written is
//! that of the very device, and with it the servo runs the device in closed loop without a fault.
//!
//! The device's side is the loop of every board, from the bytes on its line to the duties at its pins.

use palpate::device::{Counts, Device, Kinematics};
use palpate::servo::{Config, Fault, Input, Phase, Servo, Settings};
use palpate::wire::Calibrated;
use palpate_sim::devices::{BridgeEntry, HomingEntry, MechanismEntry, OwnDevice};
use palpate_sim::devices::{DEVICES, Preset, ShippedDevice};
use palpate_sim::plant::{
    Direction, HandSettings, JointSettings, Plant, PlantSettings, TouchingPath, TouchingSettings,
};
use palpate_sim::wall::WALL;
use palpate_tool::commission::{
    Device as Commissioned, HostLine, KeyHeld, Lab, Line, Planted, PlantedFault, SimulatedHands, Weights, World, Zero,
    begin_within, calibration, find, find_mounting,
};
use std::cell::RefCell;

const RATE: f64 = 4_000.0;

/// The devices of three joints, with what their files are.
fn devices() -> impl Iterator<Item = (&'static ShippedDevice, OwnDevice)> {
    DEVICES.iter().filter_map(|shipped| {
        let file = shipped.file()?;
        Some((shipped, OwnDevice::new(file, shipped.name).expect("it ships")))
    })
}

/// Eight steps of the plant a tick: what is found takes many ticks each.
fn lab(own: &OwnDevice, mut planted: Planted) -> Lab {
    planted.plant = planted.plant.in_sub_steps(8);
    let world = World::shared(planted).expect("a bench");
    let line = Box::new(HostLine::new(own, &world).expect("a device"));
    let device = Commissioned::connect(line, Box::new(KeyHeld)).expect("it answers");
    Lab { device, hands: Box::new(SimulatedHands::new(&world)) }
}

/// Commissions a device, and gives what was found and the file.
fn commission(own: &OwnDevice, planted: Planted, weighs: bool, by: Zero) -> (Vec<String>, OwnDevice) {
    let mut lab = lab(own, planted);
    let outcome = if weighs {
        find(&mut lab, own, by).map(|(file, findings, weights)| {
            let off = findings.iter().any(|finding| finding.to_string().contains("holding it takes"));
            let Weights { line, doubts } = weights;
            assert!(line.starts_with(if off { "weights differ" } else { "weights agree" }), "{line}");
            assert_eq!(doubts, Vec::<String>::new());
            (file, findings)
        })
    } else {
        find_mounting(&mut lab, own, by)
    };
    let (file, findings) = outcome.unwrap_or_else(|error| panic!("{}: {error:#}", own.file.name));
    let found = OwnDevice::new(file, "found.toml").expect("a device");
    (findings.into_iter().map(|finding| finding.0).collect(), found)
}

/// What is written is what was planted.
fn assert_is(found: &OwnDevice, planted: &Planted) {
    for (index, (joint, truth)) in found.file.joint.iter().zip(&planted.plant.joints).enumerate() {
        let JointSettings { ratio, counts_per_turn, encoder_direction, motor_direction, angle_at_zero, .. } = *truth;
        let per_turn = counts_per_turn * ratio * encoder_direction.sign();
        let (name, encoder, motor) = (&found.file.name, &joint.encoder, &joint.motor);
        // A count at either end of 0.3 rad, of a thousand or more.
        assert!((encoder.counts * encoder.ratio / per_turn - 1.0).abs() < 5e-3, "{name} {index}: encoder");
        assert!((encoder.zero - angle_at_zero).abs() < 5e-3, "{name} {index}: zero {}", encoder.zero);
        assert_eq!(motor.ratio > 0.0, motor_direction == Direction::With, "{name} {index}: motor sign");
        assert_eq!(planted.encoder_on[encoder.channel], index, "{name}: encoder input");
        assert_eq!(planted.motor_on[motor.channel], index, "{name}: motor output");
    }
}

/// A hand that touches a level wall, on the planted device, with what the file says, for two seconds, or up to so many
/// until something was felt. The fault, if there was one, how long the wall was touched, s, and the greatest force, N.
fn runs(own: &OwnDevice, planted: &Planted, seconds: u32) -> (Option<Fault>, f64, f32) {
    match own.preset {
        Preset::SerialArm(device) => runs_on(device, own, planted, seconds),
        Preset::LinkageArm(device) => runs_on(device, own, planted, seconds),
        Preset::Delta(device) => runs_on(device, own, planted, seconds),
        Preset::FiveBar(_) | Preset::Paddle(_) => panic!("three joints"),
    }
}

fn runs_on<K: Kinematics<3>>(
    device: &'static Device<K, 3>,
    own: &OwnDevice,
    planted: &Planted,
    seconds: u32,
) -> (Option<Fault>, f64, f32) {
    let settings = Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: 600.0,
        damping_n_s_per_m: 2.0,
        max_force_n: device.max_force_n,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.1,
        body_origin_m: palpate::math::Vec3::ZERO,
    };
    let servo = Servo::protected(device, &WALL, own.protection, Config { settings, ..Config::DEFAULT });
    let touching = TouchingSettings { duration: 4.0, touches: 4, press_depth: [0.004, 0.008], ..Default::default() };
    let place = |u: f64, v: f64| ([0.03 * (u - 0.5), 0.03 * (v - 0.5), 0.0], [0.0, 0.0, 1.0]);
    let path = TouchingPath::new(place, touching, 1).expect("a path");
    let mut plant = Plant::new(&planted.plant, HandSettings::default(), Box::new(path), RATE).expect("a plant");
    let mut state = servo.start();
    let (mut touched, mut most) = (0, 0.0_f32);
    for tick in 0..4_000 * seconds {
        let at_joints = plant.counts();
        let at_inputs = planted.encoder_on.map(|joint| at_joints[joint]);
        let counts = core::array::from_fn(|joint| Counts(at_inputs[own.file.joint[joint].encoder.channel]));
        let _ = servo.tick(&mut state, Input::Sensors { counts, enable: true });
        let mut at_outputs = [0; 3];
        for (joint, duty) in own.file.joint.iter().zip(state.duties()) {
            at_outputs[joint.motor.channel] = duty.0;
        }
        let mut to_joints = [0; 3];
        for (output, joint) in planted.motor_on.into_iter().enumerate() {
            to_joints[joint] = at_outputs[output];
        }
        plant.advance(to_joints);
        touched += u32::from(state.force().length() > 0.5);
        most = most.max(state.force().length());
        let is_felt = f64::from(touched) > LEAST * RATE && most > 1.0;
        if state.fault().is_some() || (is_felt && tick >= 8_000) {
            break;
        }
    }
    assert!(state.fault().is_some() || state.phase() == Phase::Running);
    (state.fault().map(|(fault, _)| fault), f64::from(touched) / RATE, most)
}

/// Seconds of touch below which a run has felt nothing.
const LEAST: f64 = 0.3;

/// What is planted, and what the findings must say of it.
const HARMS: [(&[PlantedFault], &[&str]); 9] = [
    (&[PlantedFault::EncoderSign(1)], &["joint b: encoder sign"]),
    (&[PlantedFault::MotorSign(2)], &["joint c: motor sign"]),
    (&[PlantedFault::Ratio(0, 1.25)], &["joint a: encoder ratio"]),
    (&[PlantedFault::Zero(1, 0.2)], &["joint b: encoder zero"]),
    (&[PlantedFault::Encoders(0, 1)], &["joint a: encoder on input 1", "joint b: encoder on input 0"]),
    (&[PlantedFault::Motors(1, 2)], &["joint b: motor on output 2", "joint c: motor on output 1"]),
    (&[PlantedFault::EncoderSign(0), PlantedFault::MotorSign(0)], &["joint a: encoder sign", "joint a: motor sign"]),
    (&[PlantedFault::Ratio(2, 0.5), PlantedFault::EncoderSign(2)], &["joint c: encoder ratio"]),
    (
        &[
            PlantedFault::Encoders(0, 2),
            PlantedFault::Motors(0, 1),
            PlantedFault::MotorSign(1),
            PlantedFault::Ratio(1, 1.6),
            PlantedFault::Zero(0, -0.3),
        ],
        &["joint a: encoder on input 2", "joint b: motor on output 0", "joint b: motor sign", "joint b: encoder ratio"],
    ),
];

/// The same, as many at once as do not hide each other.
const TOGETHER: [(&[PlantedFault], &[&str]); 4] = [
    (
        &[PlantedFault::EncoderSign(1), PlantedFault::MotorSign(2), PlantedFault::Ratio(0, 1.25)],
        &["joint b: encoder sign", "joint c: motor sign", "joint a: encoder ratio"],
    ),
    (
        &[PlantedFault::Zero(1, 0.2), PlantedFault::Encoders(0, 1), PlantedFault::Motors(1, 2)],
        &[
            "joint b: encoder zero",
            "joint a: encoder on input 1",
            "joint b: encoder on input 0",
            "joint b: motor on output 2",
            "joint c: motor on output 1",
        ],
    ),
    (
        &[
            PlantedFault::EncoderSign(0),
            PlantedFault::MotorSign(0),
            PlantedFault::Ratio(2, 0.5),
            PlantedFault::EncoderSign(2),
        ],
        &["joint a: encoder sign", "joint a: motor sign", "joint c: encoder ratio"],
    ),
    HARMS[8],
];

/// Every planted fault of a device is found, and with the file that is written the planted device runs.
fn every_planted_fault_is_found_of(name: &str, harms: &[(&[PlantedFault], &[&str])]) {
    let mut spoilt = 0_usize;
    for (shipped, own) in devices().filter(|(shipped, _)| shipped.name == name) {
        for (faults, says) in harms {
            let planted = faults.iter().fold(Planted::sound(shipped.plant), |planted, fault| planted.with(*fault));
            let (before, felt, _) = runs(&own, &planted, 2);
            spoilt += usize::from(before.is_some() || felt < LEAST);
            let (findings, found) = commission(&own, planted, false, Zero::Jig);
            for says in *says {
                assert!(
                    findings.iter().any(|finding| finding.starts_with(says)),
                    "{} {faults:?}: {findings:?}",
                    shipped.name
                );
            }
            assert_is(&found, &planted);
            let (fault, touched, most) = runs(&found, &planted, 4);
            println!(
                "{:<20} {faults:?}: before {before:?} after {felt:.2} s of touch; {} findings; then {touched:.2} s of touch up to {most:.1} N",
                shipped.name,
                findings.len()
            );
            assert_eq!(fault, None, "{} {faults:?}", shipped.name);
            assert!(touched > LEAST && most > 1.0, "{} {faults:?}: {touched} s, {most} N", shipped.name);
        }
    }
    let count = harms.len();
    println!("before, {spoilt} of {count} runs were stopped or felt nothing");
    // A turntable that is turned too little, or the other way, is not felt on a level wall. Most of the rest is, or the
    // runs above say nothing.
    assert!(9 * spoilt >= 4 * count, "{spoilt} of {count}");
}

#[test]
fn every_planted_fault_of_a_wooden_haptics_is_found_and_with_its_new_file_it_runs() {
    every_planted_fault_is_found_of("woodenhaptics-2016", &HARMS);
}

#[test]
fn every_planted_fault_of_a_polhem_is_found_and_with_its_new_file_it_runs() {
    every_planted_fault_is_found_of("polhem-v2", &TOGETHER);
}

#[test]
fn every_planted_fault_of_a_phantom_is_found_and_with_its_new_file_it_runs() {
    every_planted_fault_is_found_of("phantom-premium", &TOGETHER);
}

#[test]
fn every_planted_fault_of_a_falcon_is_found_and_with_its_new_file_it_runs() {
    every_planted_fault_is_found_of("falcon", &TOGETHER);
}

#[test]
#[ignore = "minutes: one fault at a time, of every device"]
fn every_planted_fault_by_itself_is_found_of_every_device() {
    for (shipped, _) in devices() {
        every_planted_fault_is_found_of(shipped.name, &HARMS);
    }
}

#[test]
fn what_is_kept_in_the_device_is_what_was_found_and_is_used_after_a_reset() {
    for (shipped, own) in devices() {
        let faults = HARMS[HARMS.len() - 1].0;
        let planted = faults.iter().fold(Planted::sound(shipped.plant), |planted, fault| planted.with(*fault));
        let mut lab = lab(&own, planted);
        assert_eq!(lab.device.calibrated(), Some(Calibrated::BuiltIn));
        let (file, _) = find_mounting(&mut lab, &own, Zero::Jig).expect("it is found");
        let found = OwnDevice::new(file, "found.toml").expect("a device");
        let kept = calibration(&found).expect("three joints");
        // Whoever holds the button lets go of it first.
        let refusal = lab.device.keep(Some(kept.0)).expect_err("the button is held").to_string();
        assert!(refusal.contains("enable"), "{refusal}");
        lab.hands.enable(false).expect("simulated");
        lab.device.keep(Some(kept.0)).expect("it is kept");
        assert!(lab.device.reset().expect("it starts"));
        assert_eq!(lab.device.calibrated(), Some(Calibrated::Kept { crc: kept.crc() }));
        let reading = lab.device.last();
        assert!(!reading.live, "raw counts and outputs as before, and nothing moves");
        lab.device.keep(None).expect("it is forgotten");
        assert!(lab.device.reset().expect("it starts"));
        assert_eq!(lab.device.calibrated(), Some(Calibrated::BuiltIn), "{}", shipped.name);
    }
}

#[test]
fn a_device_that_is_as_its_file_says_is_left_as_it_is() {
    // As they ship, and with encoders whose counts are smaller than the way a support yields.
    for (counts, (shipped, own)) in
        [None, Some(65_536.0)].into_iter().flat_map(|counts| devices().map(move |of| (counts, of)))
    {
        let mut file = own.file;
        file.joint.iter_mut().for_each(|joint| joint.encoder.counts = counts.unwrap_or(joint.encoder.counts));
        let own = OwnDevice::new(file, shipped.name).expect("a device");
        let by = if matches!(own.preset, Preset::SerialArm(_)) { &[Zero::Jig, Zero::Stops][..] } else { &[Zero::Jig] };
        for by in by {
            let (findings, found) = commission(&own, Planted::sound(own.plant), counts.is_none(), *by);
            println!("{}: {findings:?}", shipped.name);
            assert_eq!(findings, Vec::<String>::new(), "{} {by:?}", shipped.name);
            assert_eq!(found.file, own.file);
        }
    }
}

#[test]
fn torque_and_friction_are_found_to_what_a_weight_and_two_counts_tell() {
    // To lift a Falcon's plate takes a third of full duty of a jog's 0.4: one motor weaker by a fifth is refused.
    for (shipped, own) in devices().filter(|(shipped, _)| shipped.name != "falcon") {
        let faults = [
            PlantedFault::Torque(0, 0.8),
            PlantedFault::Torque(1, 1.3),
            PlantedFault::Friction(1, 2.0),
            PlantedFault::Friction(2, 0.4),
        ];
        let planted = faults.iter().fold(Planted::sound(shipped.plant), |planted, fault| planted.with(*fault));
        // So that whatever is measured is written.
        let mut file = own.file.clone();
        for joint in &mut file.joint {
            joint.friction = 1.0;
            joint.motor.torque_constant *= 1.1;
        }
        let own = OwnDevice::new(file, shipped.name).expect("a device");
        let (_, found) = commission(&own, planted, true, Zero::Jig);
        for (index, (joint, truth)) in found.file.joint.iter().zip(&planted.plant.joints).enumerate() {
            let torque = joint.motor.torque_constant / truth.torque_constant;
            let excess = joint.friction - truth.coulomb_friction;
            println!(
                "{:<20} joint {index}: torque constant {torque:.3} of the true one, friction {:.4} N·m of {:.4}",
                shipped.name, joint.friction, truth.coulomb_friction
            );
            assert!((torque - 1.0).abs() < 0.05, "{} {index}: torque {torque}", shipped.name);
            // The torque constant's uncertainty, and half a step of the ramp either way.
            assert!(
                excess.abs() < 0.05 * truth.coulomb_friction + 5e-4,
                "{} {index}: friction {} of {}",
                shipped.name,
                joint.friction,
                truth.coulomb_friction
            );
        }
    }
}

#[test]
fn an_arm_that_is_heavier_or_lighter_than_its_file_is_weighed() {
    for (shipped, own) in devices() {
        // Of a Falcon a tenth more is beyond the duty that a jog may give.
        let times = if shipped.name == "woodenhaptics-2016" { 1.1 } else { 0.9 };
        let planted = Planted::sound(shipped.plant).with(PlantedFault::Weight(times));
        let (findings, found) = commission(&own, planted, true, Zero::Jig);
        println!("{}: {findings:?}", shipped.name);
        let centre = own.plant.mechanism(0.0).angles([0.0; 3]).expect("within reach");
        let [before, after] = [&own, &found].map(|device| device.plant.mechanism(0.0).gravity_torques(centre));
        for (joint, (before, after)) in before.into_iter().zip(after).enumerate() {
            println!("{:<20} weight {times}: joint {joint} {before:.4} N·m, then {after:.4}", shipped.name);
            // The torque constant's uncertainty, and steps of the duty.
            let is_near = (after - times * before).abs() <= 0.05 * before.abs() + 2e-3;
            assert!(is_near, "{} {times} {joint}: {after} of {before}; {findings:?}", shipped.name);
        }
        let has_weight = before.iter().any(|load| load.abs() > 0.05);
        assert!(!has_weight || findings.iter().any(|finding| finding.contains("holding it takes")), "{findings:?}");
    }
}

/// A light arm of fine encoders, whose motors are on bridges of this resistance, ohms, or on current amplifiers.
fn light_arm(resistance: Option<f64>) -> OwnDevice {
    let mut file = DEVICES.iter().find_map(ShippedDevice::file).expect("one ships");
    let MechanismEntry::SerialArm { first_link, second_link, workspace_centre, end_masses, .. } = &mut file.mechanism
    else {
        panic!("a serial arm")
    };
    (*first_link, *second_link, *workspace_centre, *end_masses) = (0.21, 0.19, [0.21, 0.0, 0.10], [0.16, 0.05]);
    let joints = [(-8.0, 8.0, 0.0042), (-10.0, -10.0, 0.0078), (10.0, 10.0, 0.0032)];
    for (joint, (encoder, motor, inertia)) in file.joint.iter_mut().zip(joints) {
        (joint.encoder.counts, joint.encoder.ratio) = (16_384.0, encoder);
        (joint.motor.ratio, joint.motor.torque_constant, joint.motor.current_at_full) = (motor, 0.060, 3.0);
        (joint.inertia, joint.friction) = (Some(inertia), 0.01);
        let bridge =
            |resistance| BridgeEntry { supply: 24.0, resistance, inductance: Some(3.3e-4), back_emf_share: 0.8 };
        joint.motor.bridge = resistance.map(bridge);
    }
    OwnDevice::new(file, "light-arm.toml").expect("a device")
}

#[test]
fn a_bridge_adds_no_friction_however_fast_back_emf_lets_the_joint_move() {
    // At 0.5 ohm the same excess of duty moves a joint at an eighth of the rate that it has at 4.
    for resistance in [None, Some(4.0), Some(1.3), Some(0.5)] {
        let own = light_arm(resistance);
        // The file's friction is far off, so that whatever is measured is written. The plant's is the truth.
        let truth = Planted::sound(own.plant).with(PlantedFault::Torque(2, 1.2));
        let mut file = own.file;
        file.joint.iter_mut().for_each(|joint| joint.friction = 0.05);
        let wrong = OwnDevice::new(file, "light-arm.toml").expect("a device");
        let (findings, found) = commission(&wrong, truth, true, Zero::Jig);
        for (index, (joint, truth)) in found.file.joint.iter().zip(&truth.plant.joints).enumerate() {
            let excess = joint.friction - truth.coulomb_friction;
            println!("{resistance:?} ohm, joint {index}: {excess:+.4} N·m of friction too much");
            // A step of the ramp is 5e-4 N·m, and the support yields by up to three fifths of the motion that is seen.
            assert!(excess.abs() < 1e-3, "{resistance:?} {index}: {excess}; {findings:?}");
        }
        assert!((found.file.joint[2].motor.torque_constant / 0.072 - 1.0).abs() < 0.05, "{findings:?}");
    }
}

#[test]
fn a_run_that_corrects_a_ratio_weighs_as_one_that_does_not() {
    for (resistance, joint, times) in
        [(Some(1.3), 1, 1.25), (None, 1, 1.25), (Some(1.3), 1, 0.8), (Some(1.3), 0, 1.6), (Some(1.3), 2, 0.5)]
    {
        let own = light_arm(resistance);
        let planted = Planted::sound(own.plant).with(PlantedFault::Ratio(joint, times));
        let (findings, found) = commission(&own, planted, true, Zero::Jig);
        let [finding] = &findings[..] else { panic!("{resistance:?} {joint} {times}: {findings:?}") };
        assert!(finding.contains("encoder ratio"), "{finding}");
        assert_eq!(found.file.mechanism, own.file.mechanism);
    }
}

/// Hands with a known mass of which they state a multiple.
struct Misread(SimulatedHands, f64);

impl palpate_tool::commission::Hands for Misread {
    fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        self.0.place(angles)
    }
    fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
        self.0.pose(angles)
    }
    fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<()> {
        self.0.pass(joint, angles)
    }
    fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()> {
        self.0.rest(joint, towards)
    }
    fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
        Ok(self.1 * self.0.pull(force)?)
    }
    fn enable(&mut self, pressed: bool) -> anyhow::Result<()> {
        self.0.enable(pressed)
    }
}

#[test]
fn a_known_mass_that_contradicts_the_arms_own_weight_changes_no_torque() {
    let own = light_arm(Some(1.3));
    let planted = Planted::sound(own.plant).with(PlantedFault::Ratio(1, 1.25));
    let world = World::shared(planted).expect("a bench");
    let line = Box::new(HostLine::new(&own, &world).expect("a device"));
    let device = Commissioned::connect(line, Box::new(KeyHeld)).expect("it answers");
    let hands = Box::new(Misread(SimulatedHands::new(&world), 2.0));
    let (file, findings, weights) = find(&mut Lab { device, hands }, &own, Zero::Jig).expect("it is measured");
    println!("{findings:?} {weights:?}");
    // The turntable lifts nothing that could contradict; its torque constant, of the same mass, is not written either.
    let [b, c] = &weights.doubts[..] else { panic!("{weights:?}") };
    assert!(
        b.starts_with("joint b: by the known mass its torque constant is 0.1") && c.starts_with("joint c"),
        "{b} {c}"
    );
    assert!(weights.line.starts_with("weights differ"), "{}", weights.line);
    assert_eq!(file.mechanism, own.file.mechanism);
    for (joint, before) in file.joint.iter().zip(&own.file.joint) {
        assert_eq!((&joint.motor, joint.friction), (&before.motor, before.friction));
    }
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert!((file.joint[1].encoder.ratio / -12.5 - 1.0).abs() < 2e-3, "encoders are written");
}

#[test]
fn zero_and_ratio_are_found_by_the_stops_too() {
    // Of the others no joint reaches the end of its range while the rest stay where they are.
    for (shipped, own) in devices().filter(|(_, own)| matches!(own.preset, Preset::SerialArm(_))) {
        let planted = Planted::sound(shipped.plant).with(PlantedFault::Zero(2, 0.1)).with(PlantedFault::Ratio(1, 2.0));
        let (findings, found) = commission(&own, planted, false, Zero::Stops);
        assert_is(&found, &planted);
        assert_eq!(findings.len(), 2, "{findings:?}");
    }
}

/// The angle at a joint's mark, up to turns of its shaft, and those turns: rad.
fn at_mark(planted: &Planted, joint: usize) -> (f64, f64) {
    let JointSettings { ratio, counts_per_turn, encoder_direction, angle_at_zero, .. } = planted.plant.joints[joint];
    let turn = std::f64::consts::TAU / (ratio * encoder_direction.sign());
    let mark = f64::from(planted.marks[joint].expect("a mark"));
    (angle_at_zero + (mark + 0.5) * turn / counts_per_turn, turn.abs())
}

#[test]
fn zero_is_found_by_the_marks_wherever_the_counters_began() {
    // The second joint of the Polhem cannot be turned by a whole turn of its encoder while the others stay.
    for (shipped, own) in devices().filter(|(shipped, _)| shipped.name != "polhem-v2") {
        for faults in [
            &[][..],
            &[PlantedFault::Zero(1, 0.2), PlantedFault::Zero(2, -0.1)],
            &[PlantedFault::EncoderSign(0), PlantedFault::Encoders(0, 2)],
        ] {
            // The hands hold a joint to a count only while nothing pulls at it.
            let sound = Planted::sound(PlantSettings { gravity: 0.0, ..shipped.plant });
            let planted = faults.iter().fold(sound, |planted, fault| planted.with(*fault));
            let (_, found) = commission(&own, planted, false, Zero::Index);
            assert_eq!(found.file.homing, HomingEntry::Index);
            for (index, joint) in found.file.joint.iter().enumerate() {
                let count = std::f64::consts::TAU / (joint.encoder.counts * joint.encoder.ratio);
                let ((mark, turn), is) = (at_mark(&planted, index), joint.encoder.zero + 0.5 * count);
                let off = (is - mark + 0.5 * turn).rem_euclid(turn) - 0.5 * turn;
                // Half a count of each end of the jig's, and a mark's own.
                assert!(off.abs() <= 1.6 * count.abs(), "{} {faults:?} {index}: {off} of {count}", shipped.name);
            }
            let said = begin_within(&found.file);
            assert!(said.len() == 3 && said[0].contains("joint a: its mark comes once in"), "{said:?}");
        }
    }
}

/// What is wrong with marks.
type Loosen = fn(&mut Planted);

#[test]
fn marks_that_cannot_be_believed_are_refused_by_their_joints_name() {
    let (shipped, own) = devices().next().expect("one ships");
    let wrong: [(Loosen, &str); 3] = [
        (|planted| planted.marks[1] = None, "joint b: no index mark came on input 1"),
        (|planted| planted.mark_play = 5, "joint a: its index mark came at counts"),
        (
            |planted| planted.mark_on.swap(0, 2),
            "joint a: its encoder is on input 0, and its index mark came on input 2",
        ),
    ];
    for (loosen, says) in wrong {
        let mut planted = Planted::sound(shipped.plant);
        loosen(&mut planted);
        let refusal = find_mounting(&mut lab(&own, planted), &own, Zero::Index).expect_err("no mark").to_string();
        assert!(refusal.starts_with(says), "{refusal}");
    }
}

#[test]
fn a_motor_too_weak_for_its_load_is_refused_by_its_joints_name() {
    let (shipped, own) = devices().find(|(shipped, _)| shipped.name == "falcon").expect("it ships");
    let planted = Planted::sound(shipped.plant).with(PlantedFault::Friction(1, 4.0));
    let refusal = find(&mut lab(&own, planted), &own, Zero::Jig).expect_err("too much friction").to_string();
    assert!(refusal.contains("joint b"), "{refusal}");
}

#[test]
fn nothing_is_found_without_the_enable_button_or_the_key() {
    /// Hands that never press the button.
    struct Idle(SimulatedHands);
    impl palpate_tool::commission::Hands for Idle {
        fn place(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
            self.0.place(angles)
        }
        fn pose(&mut self, angles: [f64; 3]) -> anyhow::Result<()> {
            self.0.pose(angles)
        }
        fn pass(&mut self, joint: usize, angles: [f64; 3]) -> anyhow::Result<()> {
            self.0.pass(joint, angles)
        }
        fn rest(&mut self, joint: usize, towards: f64) -> anyhow::Result<()> {
            self.0.rest(joint, towards)
        }
        fn pull(&mut self, force: [f64; 3]) -> anyhow::Result<f64> {
            self.0.pull(force)
        }
        fn enable(&mut self, _: bool) -> anyhow::Result<()> {
            Ok(())
        }
    }
    struct LetGo;
    impl palpate_tool::commission::Key for LetGo {
        fn is_held(&mut self) -> bool {
            false
        }
    }
    thread_local!(static REFUSALS: RefCell<Vec<String>> = const { RefCell::new(Vec::new()) });
    let (shipped, own) = devices().next().expect("one ships");
    for button in [false, true] {
        let world = World::shared(Planted::sound(shipped.plant)).expect("a bench");
        let line = Box::new(HostLine::new(&own, &world).expect("a device"));
        let key: Box<dyn palpate_tool::commission::Key> = if button { Box::new(LetGo) } else { Box::new(KeyHeld) };
        let device = Commissioned::connect(line, key).expect("it answers");
        let hands = SimulatedHands::new(&world);
        let hands: Box<dyn palpate_tool::commission::Hands> =
            if button { Box::new(hands) } else { Box::new(Idle(hands)) };
        let refusal = find_mounting(&mut Lab { device, hands }, &own, Zero::Jig).expect_err("nobody holds it");
        REFUSALS.with(|refusals| refusals.borrow_mut().push(refusal.to_string()));
    }
    REFUSALS.with(|refusals| println!("{:?}", refusals.borrow()));
}

#[test]
fn a_key_stays_held_whose_messages_a_loaded_machine_delivers_late() {
    /// A line that stalls now and then, for longer than a key may be silent, unless somebody waits for ten messages.
    struct Loaded {
        line: HostLine,
        sent: Vec<u8>,
        looks: u32,
        stalls: bool,
    }
    impl Line for Loaded {
        fn send(&mut self, bytes: &[u8]) -> anyhow::Result<()> {
            self.sent.extend(bytes);
            Ok(())
        }
        fn receive(&mut self) -> anyhow::Result<Vec<u8>> {
            self.looks += 1;
            self.stalls = self.looks % 500 > 100 && (self.stalls || self.looks % 500 == 400);
            if !self.stalls {
                self.line.send(&std::mem::take(&mut self.sent))?;
            }
            self.line.receive()
        }
        fn settle(&mut self, behind: u32) {
            self.stalls &= behind < 10;
        }
        fn press(&mut self, pressed: bool) -> anyhow::Result<bool> {
            self.line.press(pressed)
        }
    }
    let (shipped, own) = devices().next().expect("one ships");
    let world = World::shared(Planted::sound(shipped.plant)).expect("a bench");
    let line = HostLine::new(&own, &world).expect("a device");
    let line = Box::new(Loaded { line, sent: Vec::new(), looks: 0, stalls: false });
    let device = Commissioned::connect(line, Box::new(KeyHeld)).expect("it answers");
    let hands = Box::new(SimulatedHands::new(&world));
    let found = find_mounting(&mut Lab { device, hands }, &own, Zero::Jig).map(|(_, findings)| findings);
    assert!(found.as_ref().is_ok_and(Vec::is_empty), "{found:?}");
}

#[test]
fn a_fault_to_plant_is_read_from_its_words() {
    let read = |text: &str| text.parse::<PlantedFault>();
    assert_eq!(read("encoder-sign:0"), Ok(PlantedFault::EncoderSign(0)));
    assert_eq!(read("zero:1=-0.2"), Ok(PlantedFault::Zero(1, -0.2)));
    assert_eq!(read("motors:1-2"), Ok(PlantedFault::Motors(1, 2)));
    assert_eq!(read("weight:1.1"), Ok(PlantedFault::Weight(1.1)));
    for wrong in ["", "zero", "zero:1", "zero:3=0.1", "ratio:0=-1", "ratio:0=inf", "motors:1", "encoder-sign:x", "x:0"]
    {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

/// The plant of a shipped device is what is planted in when nothing is.
#[test]
fn nothing_planted_is_the_device_that_ships() {
    let plant = PlantSettings::polhem_v2();
    assert_eq!(Planted::sound(plant).plant, plant);
}
