//! Homing on a board: by the button, and by the motors.

use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Homing, Reference, SerialArm};
use palpate::servo::{Config, Fault, Output, Phase, ResetReason, Servo};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, StillHand};
use palpate_sim::rig::{RATE, Rig, SETTINGS, STOPS, WALL, settings};

/// The arm with its counters at zero somewhere, as after power-on.
fn put_down_anywhere() -> PlantSettings {
    let mut settings = PlantSettings::wooden_haptics_2016();
    for (joint, off) in settings.joints.iter_mut().zip([0.31, -0.47, 0.22]) {
        joint.angle_at_zero += off;
    }
    settings
}

fn rig(reference: Reference<3>, timeout: u32, plant: Plant) -> Rig<SerialArm> {
    let homing = Homing::try_new(WOODEN_HAPTICS_2016.encoders, reference, 400, 4, timeout).unwrap().when_asked();
    let servo =
        Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, homing: Some(homing), ..Config::DEFAULT });
    Rig::new(servo, plant, &settings(), ResetReason::PowerOn)
}

#[test]
fn homing_by_stops_drives_the_motors_while_the_loop_calibrates() {
    let plant = Plant::new(&put_down_anywhere(), HandSettings::NONE, Box::new(StillHand([0.0; 3])), RATE).unwrap();
    let mut rig = rig(Reference::Stops(STOPS), 60_000, plant);
    // Not by itself, and not with a button that is held from before.
    rig.set(|world| world.button = true);
    rig.ticks_off(860);
    rig.set(|world| world.button = false);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    let mut drove = 0;
    while !rig.state().homed() {
        rig.tick();
        assert_eq!(rig.fault(), None);
        drove += u32::from(!rig.is_off());
        // Let go of for a while: it waits.
        if rig.state().ticks() % 5_000 == 0 {
            rig.set(|world| world.button = false);
            rig.ticks_off(100);
            rig.set(|world| world.button = true);
        }
    }
    assert!(drove > 4_000, "{drove} ticks");
    let angles = (rig.state().angles_at_zero(), rig.world.borrow().plant.angles());
    assert!(angles.0.iter().all(|angle| angle.is_finite()), "{angles:?}");
    // The press that homed it asks for no force.
    rig.ticks_off(2_000);
    assert_eq!(rig.state().phase(), Phase::Armed);
    for (angle, true_angle) in rig.state().angles().into_iter().zip(rig.world.borrow().plant.angles()) {
        // A stop yields a milliradian under half a newton metre and the weight; a count is 0.3 mrad.
        assert!((f64::from(angle) - true_angle).abs() < 2e-3, "{angle} {true_angle}");
    }
}

/// A hand that holds still 4 mm inside the wall for 16 s, and then goes up and comes down on it again.
struct UpAndDown;

impl HandPath for UpAndDown {
    fn target(&self, time: f64) -> [f64; 3] {
        let up = (time - 16.0).clamp(0.0, 0.1).min((16.3 - time).clamp(0.0, 0.1));
        [0.0, 0.0, -0.004 + 0.1 * up]
    }

    fn velocity(&self, _: f64) -> [f64; 3] {
        [0.0; 3]
    }
}

#[test]
fn held_in_its_reference_pose_the_button_says_where_zero_is_and_asks_for_no_force() {
    let mut settings = put_down_anywhere();
    settings.gravity = 0.0;
    let grip = HandSettings { stiffness: 5_000.0, damping: 50.0, mass: 0.0 };
    let plant = Plant::new(&settings, grip, Box::new(UpAndDown), RATE).unwrap();
    let pose = plant.angles().map(|angle| angle as f32);
    let mut rig = rig(Reference::Pose(pose), 40_000, plant);
    // However long nobody presses it: it waits, says so, and drives nothing.
    rig.set(|world| world.button = true);
    rig.ticks_off(5_000);
    rig.set(|world| world.button = false);
    rig.ticks_off(50_000);
    assert_eq!((rig.state().phase(), rig.fault(), rig.state().output()), (Phase::Calibrate, None, Output::Off));
    rig.set(|world| world.button = true);
    rig.ticks_off(5_000);
    assert_eq!((rig.state().phase(), rig.state().homed()), (Phase::Armed, true));
    for (angle, held) in rig.state().angles().into_iter().zip(pose) {
        // A count of 0.3 mrad.
        assert!((angle - held).abs() < 4e-4, "{angle} {held}");
    }
    rig.ticks_off(8_000);
    rig.press_until_it_runs();
    assert!(rig.state().force().z > 1.0, "inside the wall it pushes out: {:?}", rig.state().force());
}

#[test]
fn a_hand_that_does_not_hold_still_is_refused_by_name() {
    struct Shaking;
    impl HandPath for Shaking {
        fn target(&self, time: f64) -> [f64; 3] {
            [0.0, 0.01 * (30.0 * time).sin(), 0.01 * (20.0 * time).sin()]
        }
        fn velocity(&self, time: f64) -> [f64; 3] {
            [0.0, 0.3 * (30.0 * time).cos(), 0.2 * (20.0 * time).cos()]
        }
    }
    let grip = HandSettings { stiffness: 2_000.0, damping: 20.0, mass: 0.0 };
    let plant = Plant::new(&put_down_anywhere(), grip, Box::new(Shaking), RATE).unwrap();
    let mut rig = rig(Reference::Pose([0.0; 3]), 8_000, plant);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    rig.ticks_off(8_100);
    assert_eq!(rig.fault(), Some(Fault::Homing));
}

#[test]
fn a_stop_in_the_midst_of_homing_stops_the_motors_and_homing_goes_on_only_when_asked_again() {
    let plant = Plant::new(&put_down_anywhere(), HandSettings::NONE, Box::new(StillHand([0.0; 3])), RATE).unwrap();
    let mut rig = rig(Reference::Stops(STOPS), 60_000, plant);
    rig.ticks(150);
    rig.set(|world| world.button = true);
    rig.ticks(1_000);
    assert!(!rig.is_off());
    rig.set(|world| world.stop_open = true);
    rig.ticks_off(500);
    rig.set(|world| world.stop_open = false);
    rig.ticks_off(500);
    rig.set(|world| world.button = false);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    rig.ticks(100);
    assert!(!rig.is_off(), "{:?} {:?}", rig.fault(), rig.state().homing().refusal());
}

#[test]
fn without_a_supply_a_device_is_homed_by_hand_all_the_same_and_nothing_is_driven() {
    let grip = HandSettings { stiffness: 5_000.0, damping: 50.0, mass: 0.0 };
    let mut held = put_down_anywhere();
    held.gravity = 0.0;
    let plant = Plant::new(&held, grip, Box::new(StillHand([0.0, 0.0, 0.01])), RATE).unwrap();
    let pose = plant.angles().map(|angle| angle as f32);
    let mut rig = rig(Reference::Pose(pose), 40_000, plant);
    // Before the first step of the bench: no supply, and so no amplifier is ready.
    rig.set(|world| (world.supply, world.button) = (0.0, true));
    rig.ticks_off(2_000);
    assert!(!rig.state().homed(), "a button that is held from before says nothing");
    rig.set(|world| world.button = false);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    rig.ticks_off(2_000);
    assert!(rig.state().homed());
    // The supply comes on with the button still down.
    rig.set(|world| world.supply = 24.0);
    rig.ticks_off(2_000);
    assert_eq!((rig.state().phase(), rig.fault()), (Phase::Armed, None));
    rig.press_until_it_runs();

    // Homing by the motors waits for them.
    let plant = Plant::new(&put_down_anywhere(), HandSettings::NONE, Box::new(StillHand([0.0; 3])), RATE).unwrap();
    let mut rig = self::rig(Reference::Stops(STOPS), 60_000, plant);
    rig.set(|world| world.supply = 0.0);
    rig.ticks_off(150);
    rig.set(|world| world.button = true);
    rig.ticks_off(2_000);
    assert_eq!((rig.state().homing().torques(), rig.fault()), ([0.0; 3], None));
}
