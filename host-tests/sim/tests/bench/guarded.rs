//! A board whose servo is guarded: what protects motors and hand reaches the pins.

use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Endurance, Protection};
use palpate::servo::{Config, Fault, Guard, ResetReason, Servo};
use palpate_sim::plant::HandSettings;
use palpate_sim::rig::{Rig, SETTINGS, WALL, held_at, settings};

const PRESSED: [f64; 3] = [0.0, 0.0, -0.008];

/// Lets go of a device under force; what is found wrong then.
fn let_go<G: Guard<3> + 'static>(
    servo: Servo<'static, palpate::patch::SplinePatch<'static>, palpate::device::SerialArm, 3, G>,
) -> Option<Fault> {
    let mut rig = Rig::new(servo, held_at(PRESSED), &settings(), ResetReason::PowerOn);
    // The hand comes down fast: force is asked for once it is there.
    rig.ticks(400);
    rig.press_until_it_runs();
    rig.set(|world| world.plant.hold(HandSettings::NONE));
    for _ in 0..400 {
        rig.tick();
        // From the tick of the fault on.
        assert_eq!(rig.is_off(), rig.fault().is_some());
    }
    rig.fault()
}

#[test]
fn a_device_that_is_let_go_under_force_is_disabled_in_the_tick_that_sees_it() {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    let slow = Protection { max_probe_speed_m_per_s: 0.3, polarity: None, ..WOODEN_HAPTICS_2016_PROTECTION };
    assert_eq!(let_go(Servo::protected(servo.device(), servo.surface(), slow, servo.config())), Some(Fault::Overspeed));
    assert_eq!(let_go(servo), None, "without a guard nobody looks");
}

#[test]
fn a_motor_that_is_warm_is_given_less_at_its_pin() {
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &WALL, Config { settings: SETTINGS, ..Config::DEFAULT });
    // Warm from the start, as after any reset.
    let continuous = 0.05;
    let motors = [Endurance { continuous, time_constant_s: 16.0 }; 3];
    let servo = Servo::protected(
        servo.device(),
        servo.surface(),
        Protection { motors, polarity: None, ..WOODEN_HAPTICS_2016_PROTECTION },
        servo.config(),
    );
    let mut rig = Rig::new(servo, held_at(PRESSED), &settings(), ResetReason::PowerOn);
    rig.press_until_it_runs();
    assert!(servo.guard().folds(rig.state().guard()));
    for current in rig.world.borrow().currents() {
        // A hundredth for what rests warmed it down meanwhile, and the steps of width and duty.
        assert!(current.abs() <= f64::from(continuous) + 0.01, "{current} of full scale");
    }
}
