//! A zero that was found and kept, and a board that is reset elsewhere: homed, it has the angles that the joints have.

use palpate::commission::Wiring;
use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Device as Built, Homing, Reference, SerialArm};
use palpate::servo::{Config, Phase, ResetReason, Servo};
use palpate::wire::Calibrated;
use palpate_sim::devices;
use palpate_sim::devices::{HomingEntry, OwnDevice};
use palpate_sim::plant::{HandSettings, Plant, PlantSettings, StillHand};
use palpate_sim::rig::{Made, RATE, Rig, SETTINGS, WALL, settings as rig_settings};
use palpate_tool::commission::{
    Device, HostLine, KeyHeld, Lab, Planted, PlantedFault, SimulatedHands, World, Zero, calibration, find_mounting,
};
use std::f64::consts::TAU;

static BUILT: Built<SerialArm, 3> = DEVICE;

/// An arm whose pose is not the one that its file has, with an encoder the other way round. It carries itself, for the
/// hands of these tests hold a joint to a count only while nothing pulls at it.
fn planted() -> (OwnDevice, Planted) {
    let shipped = devices::named("woodenhaptics-2016").expect("it ships");
    let own = OwnDevice::new(shipped.file().expect("three joints"), shipped.name).expect("a device");
    let faults = [PlantedFault::Zero(0, -0.15), PlantedFault::Zero(1, 0.2), PlantedFault::EncoderSign(2)];
    let sound = Planted::sound(PlantSettings { gravity: 0.0, ..shipped.plant });
    (own, faults.iter().fold(sound, |planted, fault| planted.with(*fault)))
}

/// The device as it is after it was commissioned from where it stood, and what was found was kept and is in use.
fn kept(own: &OwnDevice, planted: Planted, by: Zero) -> &'static Built<SerialArm, 3> {
    let world = World::shared(planted).expect("a bench");
    let line = Box::new(HostLine::new(own, &world).expect("a device"));
    let device = Device::connect(line, Box::new(KeyHeld)).expect("it answers");
    let mut lab = Lab { device, hands: Box::new(SimulatedHands::new(&world)) };
    let (file, _) = find_mounting(&mut lab, own, by).expect("it is found");
    let found = calibration(&OwnDevice::new(file, "found").expect("a device")).expect("three joints");
    lab.hands.enable(false).expect("simulated");
    lab.device.keep(Some(found.0)).expect("it is kept");
    assert!(lab.device.reset().expect("it starts"));
    assert_eq!(lab.device.calibrated(), Some(Calibrated::Kept { crc: found.crc() }));
    Box::leak(Box::new(BUILT.calibrated(&found).expect("this device")))
}

/// How many counts elsewhere each joint stood when the board was reset.
const ELSEWHERE: [i32; 3] = [2_000, -1_100, 900];

/// The loop of a board on a device that stood elsewhere when it was reset, and whose joints are now held at these
/// angles.
fn reset_elsewhere(
    planted: &Planted,
    held: [f64; 3],
    reference: Reference<3>,
    device: &'static Built<SerialArm, 3>,
) -> Rig<SerialArm> {
    // As the boards have it (boards/src/arm.rs).
    let homing = Homing::try_new(BUILT.encoders, reference, (0.1 * RATE) as u32, 4, 40_000).expect("homing");
    let servo =
        Servo::new(&BUILT, &WALL, Config { settings: SETTINGS, homing: Some(homing.when_asked()), ..Config::DEFAULT });
    let mut settings = planted.plant;
    for (joint, elsewhere) in settings.joints.iter_mut().zip(ELSEWHERE) {
        let counts = joint.counts_per_turn * joint.ratio * joint.encoder_direction.sign();
        joint.angle_at_zero += f64::from(elsewhere) * TAU / counts;
    }
    let place = settings.mechanism(0.0).position(held);
    let mut plant = Plant::new(&settings, HandSettings::NONE, Box::new(StillHand(place)), RATE).expect("a plant");
    held.into_iter().enumerate().for_each(|(joint, angle)| plant.move_stops(joint, [angle; 2]));
    Rig::made(Made(servo.calibrated(device), false, Wiring::STRAIGHT), plant, &rig_settings(), ResetReason::PowerOn)
}

/// It is homed, nothing was driven, and it has the joints' angles to a count: half of one of each jig, pose and joint.
fn assert_is_homed(rig: &Rig<SerialArm>) {
    assert_eq!((rig.state().phase(), rig.state().homed(), rig.fault()), (Phase::Armed, true, None));
    for (joint, (angle, is)) in rig.state().angles().into_iter().zip(rig.world.borrow().plant.angles()).enumerate() {
        let count = f64::from(BUILT.encoders[joint].radians_per_count.abs());
        assert!((f64::from(angle) - is).abs() <= 1.6 * count, "joint {joint}: {angle} {is}, a count is {count}");
    }
}

#[test]
fn a_kept_zero_is_right_wherever_the_arm_stood_at_either_reset() {
    let (own, planted) = planted();
    let device = kept(&own, planted, Zero::Jig);
    // The very pose in which it was measured.
    let pose = planted.plant.joints.map(|joint| joint.angle_at_zero);
    let mut rig = reset_elsewhere(&planted, pose, Reference::Pose(BUILT.angles_at_zero()), device);
    rig.ticks_off(400);
    rig.set(|world| world.button = true);
    rig.ticks_off(2_000);
    assert_is_homed(&rig);
}

#[test]
fn a_zero_kept_of_the_marks_is_found_again_by_moving_each_joint_past_its_mark_and_nothing_is_driven() {
    let (own, planted) = planted();
    let mut file = own.file;
    file.homing = HomingEntry::Index;
    let own = OwnDevice::new(file, "by marks").expect("a device");
    let device = kept(&own, planted, Zero::Index);
    let marks = device.encoders.map(|encoder| f64::from(encoder.angle_at_zero_rad));
    let start = marks.map(|mark| mark - 0.05);
    let mut rig = reset_elsewhere(&planted, start, Reference::Index(BUILT.angles_at_zero()), device);
    rig.ticks_off(400);
    // Whoever carried it past some mark before pressing the button did not home it.
    rig.set(|world| world.caught = [Some(77); 3]);
    rig.ticks_off(10);
    rig.set(|world| world.button = true);
    rig.ticks_off(10);
    for joint in 0..3 {
        assert!(!rig.state().homed());
        // Half a radian a second.
        for tick in 0..800 {
            let angle = start[joint] + f64::from(tick) * 0.5 / RATE;
            rig.set(|world| world.plant.move_stops(joint, [angle; 2]));
            let before = rig.world.borrow().plant.counts();
            rig.ticks_off(1);
            let now = rig.world.borrow().plant.counts();
            let turn = planted.plant.joints[joint].counts_per_turn as i32;
            let mark = planted.marks[joint].expect("a mark") - ELSEWHERE[joint];
            let [from, to] = [before, now].map(|counts| (counts[joint] - mark).div_euclid(turn));
            if from != to {
                rig.set(|world| world.caught[joint] = Some(mark + from.max(to) * turn));
            }
        }
    }
    rig.ticks_off(800);
    assert_is_homed(&rig);
}
