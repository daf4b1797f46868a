//! A zero that was found and kept, and a board that is reset elsewhere: homed, it has the angles that the joints have.

use crate::rig::{Made, RATE, Rig, SETTINGS, WALL, settings};
use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Device as Built, Homing, Reference, SerialArm};
use palpate::servo::{Phase, ResetReason, Servo};
use palpate::track::Controller;
use palpate::wire::Calibrated;
use palpate_plant::{HandSettings, Plant, PlantSettings, StillHand};
use palpate_tool::commission::{
    Device, HostLine, KeyHeld, Lab, Planted, PlantedFault, SimulatedHands, World, Zero, calibration, find_mounting,
};
use palpate_tool::devices;
use palpate_tool::own::OwnDevice;

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

/// The loop of a board on a device that stood elsewhere when it was reset, in a hand that holds its joints at these
/// angles.
fn reset_elsewhere(
    planted: &Planted,
    held: [f64; 3],
    reference: Reference<3>,
    device: &'static Built<SerialArm, 3>,
) -> Rig<SerialArm> {
    // As the boards have it (boards/hosted.rs).
    let homing = Homing::try_new(BUILT.encoders, reference, (0.1 * RATE) as u32, 4, 40_000).expect("homing");
    let servo = Servo::new(&BUILT, &WALL, Controller::SECOND_ORDER, SETTINGS).homing(homing.when_asked());
    let mut plant = planted.plant;
    for (joint, elsewhere) in plant.joints.iter_mut().zip([0.4, -0.3, 0.25]) {
        joint.angle_at_zero += elsewhere;
    }
    let (grip, place) =
        (HandSettings { stiffness: 5_000.0, damping: 50.0, mass: 0.0 }, plant.mechanism(0.0).position(held));
    let plant = Plant::new(&plant, grip, Box::new(StillHand(place)), RATE).expect("a plant");
    Rig::made(Made(servo.calibrated(device), false), plant, &settings(), ResetReason::PowerOn)
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
