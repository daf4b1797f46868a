//! Homing through the loop: the motors look for the simulated device's end stops, and what they will not believe.

use crate::surfaces::WALL;
use crate::traces::{RATE, SETTINGS};
use palpate::device::presets::{HAPLY_2DIY_V3, WOODEN_HAPTICS_2016};
use palpate::device::{Counts, Device, Duty, Homing, Kinematics, Reference, Refusal, StopSearch};
use palpate::servo::{Config, Event, Fault, Input, Phase, SafeOutput, Safety, Servo, ServoState};
use palpate::wire::Report;
use palpate_sim::plant::{Direction, HandPath, HandSettings, Plant, PlantSettings, StillHand, Vector};
use std::f32::consts::PI;

/// The stops of the simulated arm, from where it hangs once nothing holds it.
const ARM_STOPS: [StopSearch; 3] = [
    StopSearch { angle_rad: 1.55, speed_rad_per_s: 1.0, torque_n_m: 0.2, clearance_rad: 0.2, travel_rad: 3.3 },
    StopSearch { angle_rad: 2.15, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
    StopSearch { angle_rad: 1.75, speed_rad_per_s: 0.8, torque_n_m: 0.5, clearance_rad: 0.2, travel_rad: 0.5 },
];

/// What homing needs at most, ticks: each joint a few seconds.
const TICKS: u32 = 60_000;

fn homing<K, const JOINTS: usize>(
    device: &Device<K, JOINTS>,
    stops: [StopSearch; JOINTS],
    timeout: u32,
) -> Homing<JOINTS> {
    // A tenth of a second within two counts.
    Homing::try_new(device.encoders, Reference::Stops(stops), 400, 2, timeout).unwrap()
}

/// The arm with its counters at zero somewhere, as after power-on.
fn arm_plant() -> PlantSettings {
    let mut settings = PlantSettings::wooden_haptics_2016();
    for (joint, off) in settings.joints.iter_mut().zip([0.31, -0.47, 0.22]) {
        joint.angle_at_zero += off;
    }
    settings
}

fn start(settings: &PlantSettings, path: impl HandPath + 'static) -> Plant {
    Plant::new(settings, HandSettings::NONE, Box::new(path), RATE).unwrap()
}

struct Run<const JOINTS: usize> {
    state: ServoState<JOINTS>,
    /// Ticks until it was homed or stopped.
    ticks: u32,
    /// The greatest joint torque, N·m, and the greatest speed of a driven joint, rad/s.
    torque: f32,
    speed: f64,
}

/// Homes, `meddle` before each tick, until the loop is armed or stopped.
fn home<K: Kinematics<JOINTS>, const JOINTS: usize>(
    servo: &Servo<'_, palpate::patch::SplinePatch, K, JOINTS>,
    plant: &mut Plant,
    mut meddle: impl FnMut(u32, &mut Plant),
) -> Run<JOINTS> {
    let mut run = Run { state: servo.start(), ticks: 0, torque: 0.0, speed: 0.0 };
    for tick in 0..TICKS {
        meddle(tick, plant);
        let counts = plant.counts();
        let counts = core::array::from_fn(|joint| Counts(counts[joint]));
        let _ = servo.tick(&mut run.state, Input::Sensors { counts, enable: true });
        let mut duties = [0; 3];
        for (joint, duty) in duties.iter_mut().enumerate().take(JOINTS) {
            *duty = run.state.duties()[joint].0;
            if run.state.phase() == Phase::Calibrate && *duty != 0 {
                let torque = run.state.homing().torques()[joint].abs();
                (run.torque, run.speed) = (run.torque.max(torque), run.speed.max(plant.rates()[joint].abs()));
            }
        }
        run.ticks = tick;
        if run.state.homed() || run.state.phase() == Phase::Fault {
            break;
        }
        plant.advance(duties);
    }
    run
}

fn arm_servo(
    stops: [StopSearch; 3],
    timeout: u32,
) -> Servo<'static, palpate::patch::SplinePatch<'static>, palpate::device::SerialArm, 3> {
    Servo::new(
        &WOODEN_HAPTICS_2016,
        &WALL,
        Config { settings: SETTINGS, homing: Some(homing(&WOODEN_HAPTICS_2016, stops, timeout)), ..Config::DEFAULT },
    )
}

#[test]
fn an_arm_finds_its_stops_and_then_its_angles() {
    let servo = arm_servo(ARM_STOPS, TICKS);
    let mut plant = start(&arm_plant(), StillHand([0.0; 3]));
    let run = home(&servo, &mut plant, |_, _| ());
    let mut state = run.state;
    println!(
        "homed after {:.2} s, {:.2} N·m and {:.2} rad/s at most",
        f64::from(run.ticks) / RATE,
        run.torque,
        run.speed
    );
    assert_eq!((state.fault(), state.homed(), state.duties()), (None, true, [Duty::ZERO; 3]));
    assert!(run.torque <= 0.5 && run.speed < 3.2, "{} N·m, {} rad/s", run.torque, run.speed);
    for _ in 0..2_000 {
        let counts = plant.counts().map(Counts);
        let _ = servo.tick(&mut state, Input::Sensors { counts, enable: true });
        let encoders = WOODEN_HAPTICS_2016.encoders;
        for joint in 0..3 {
            let off = (f64::from(state.angles()[joint]) - plant.angles()[joint]).abs();
            // The stop yields 1 mrad a N·m, of which the weight adds 0.3; and both readings, there and here, are a
            // count.
            let bound = f64::from(ARM_STOPS[joint].torque_n_m + 0.3) * 1e-3
                + 1.1 * f64::from(encoders[joint].radians_per_count.abs());
            assert!(off < bound, "joint {joint}: {off} rad off, bound {bound}");
        }
        plant.advance(state.duties().map(|duty| duty.0));
    }
    assert_eq!((state.phase(), state.fault()), (Phase::Running, None));
    // And now that it knows where it is, it carries itself.
    assert!(state.duties()[1].0.abs() > 2_000, "{:?}", state.duties());
}

#[test]
fn a_pantograph_finds_the_stops_its_source_states() {
    let stops = [
        StopSearch {
            angle_rad: 168.0 * PI / 180.0,
            speed_rad_per_s: 1.0,
            torque_n_m: 0.04,
            clearance_rad: 0.15,
            travel_rad: 1.5,
        },
        StopSearch {
            angle_rad: 12.0 * PI / 180.0,
            speed_rad_per_s: -1.0,
            torque_n_m: 0.04,
            clearance_rad: 0.15,
            travel_rad: 1.5,
        },
    ];
    let servo = Servo::new(
        &HAPLY_2DIY_V3,
        &WALL,
        Config {
            settings: palpate::servo::Settings { stiffness_n_per_m: 200.0, damping_n_s_per_m: 0.5, ..SETTINGS },
            homing: Some(homing(&HAPLY_2DIY_V3, stops, TICKS)),
            ..Config::DEFAULT
        },
    );
    let mut settings = PlantSettings::haply_2diy_v3();
    settings.joints[0].angle_at_zero -= 0.8;
    let mut plant = start(&settings, StillHand([0.0; 3]));
    let run = home(&servo, &mut plant, |_, _| ());
    println!(
        "homed after {:.2} s, {:.3} N·m and {:.2} rad/s at most",
        f64::from(run.ticks) / RATE,
        run.torque,
        run.speed
    );
    assert_eq!((run.state.fault(), run.state.homed()), (None, true), "{:?}", run.state.homing());
    let off = f64::from(run.state.angles_at_zero()[0] - HAPLY_2DIY_V3.encoders[0].angle_at_zero_rad) + 0.8;
    let count = f64::from(HAPLY_2DIY_V3.encoders[0].radians_per_count);
    assert!(off.abs() < 1.1 * count, "{off} rad, a count is {count}");
}

/// Homing an arm that is not as it should be.
fn refused(
    settings: &PlantSettings,
    path: impl HandPath + 'static,
    timeout: u32,
    meddle: impl FnMut(u32, &mut Plant),
) -> (Refusal, f64) {
    let servo = arm_servo(ARM_STOPS, timeout);
    let mut plant = start(settings, path);
    let run = home(&servo, &mut plant, meddle);
    let mut state = run.state;
    // In that very tick, named with its reason, and for good.
    assert_eq!((state.phase(), state.fault().map(|(fault, _)| fault)), (Phase::Fault, Some(Fault::Homing)));
    let refusal = state.homing().refusal().expect("there is a reason");
    let report = Report::new(&state, 0);
    assert_eq!((report.fault, report.refusal), (Fault::Homing.code(), refusal.code()));
    assert!(!refusal.to_string().is_empty() && Refusal::from_code(refusal.code()) == Some(refusal));
    for _ in 0..50 {
        assert_eq!(state.duties(), [Duty::ZERO; 3]);
        plant.advance([0; 3]);
        servo.note(&mut state, Event::Homed);
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        assert_eq!((state.phase(), state.homing().refusal(), state.homed()), (Phase::Fault, Some(refusal), false));
    }
    println!("{refusal} after {:.2} s, {:.2} rad/s at most", f64::from(run.ticks) / RATE, run.speed);
    (refusal, run.speed)
}

/// A hand that shakes the arm from side to side, 0.1 m twice a second.
struct Shake;

impl HandPath for Shake {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.1 * (12.6 * time).sin(), 0.0]
    }
    fn velocity(&self, time: f64) -> Vector {
        [0.0, 1.26 * (12.6 * time).cos(), 0.0]
    }
}

#[test]
fn what_homing_will_not_believe_it_refuses_and_says_why() {
    let still = StillHand([0.0; 3]);
    let plain = arm_plant();
    let jam = |tick: u32, plant: &mut Plant| {
        let at = plant.angles()[0];
        if tick == 0 {
            plant.move_stops(0, [at - 0.02, at + 0.02]);
        }
    };
    assert_eq!(refused(&plain, still, TICKS, jam).0, Refusal::Jammed);

    let broken = |tick: u32, plant: &mut Plant| {
        if tick == 0 {
            plant.move_stops(0, [f64::NEG_INFINITY, f64::INFINITY]);
        }
    };
    assert_eq!(refused(&plain, still, TICKS, broken).0, Refusal::NoStop);

    let shaken = |tick: u32, plant: &mut Plant| {
        if tick == 1_000 {
            plant.hold(HandSettings::default());
        }
    };
    let (refusal, _) = refused(&plain, Shake, TICKS, shaken);
    assert!(matches!(refusal, Refusal::TooFast | Refusal::WrongDirection), "{refusal}");

    let mut reversed = plain;
    reversed.joints[0].motor_direction = Direction::Against;
    let (refusal, speed) = refused(&reversed, still, TICKS, |_, _| ());
    assert_eq!(refusal, Refusal::WrongDirection);
    // It never became dangerous: stopped at a tenth of a radian astray or four times the speed asked for.
    assert!(speed < 4.5, "{speed} rad/s");
    let mut miscounting = plain;
    miscounting.joints[0].encoder_direction = Direction::With;
    assert_eq!(refused(&miscounting, still, TICKS, |_, _| ()).0, Refusal::WrongDirection);

    assert_eq!(refused(&plain, still, 2_000, |_, _| ()).0, Refusal::TooLate);
}

#[test]
fn no_motor_moves_until_force_is_asked_for_and_none_after_any_fault() {
    for output in [SafeOutput::Zero, SafeOutput::Damping(4.0)] {
        let found = arm_servo(ARM_STOPS, TICKS);
        let safety = Safety { output, ..Safety::DEFAULT };
        let servo = Servo::new(found.device(), found.surface(), Config { safety, ..found.config() });
        let mut plant = start(&arm_plant(), StillHand([0.0; 3]));
        let mut state = servo.start();
        let mut driven = 0;
        for tick in 0..6_000_u32 {
            // Asked for, but for a pause.
            let enable = tick > 500 && !(2_000..2_500).contains(&tick);
            let counts = plant.counts().map(Counts);
            let sensors = Input::Sensors { counts, enable };
            if tick % 37 == 0 {
                let mut jumped = counts;
                jumped[(tick % 3) as usize].0 += 500;
                let inputs = [Input::Lost, Input::Damaged, Input::Sensors { counts: jumped, enable }];
                for (index, input) in inputs.into_iter().enumerate().skip(if tick == 0 { 3 } else { 0 }) {
                    let mut faulty = state;
                    let _ = servo.tick(&mut faulty, input);
                    assert!(faulty.phase() == Phase::Fault && faulty.duties() == [Duty::ZERO; 3], "{index} {faulty:?}");
                }
                for event in [Event::Stop, Event::DriveFault, Event::Overrun, Event::HomingRefused] {
                    let mut faulty = state;
                    servo.note(&mut faulty, event);
                    assert!(faulty.phase() == Phase::Fault && faulty.duties() == [Duty::ZERO; 3], "{event:?}");
                    for _ in 0..5 {
                        let _ = servo.tick(&mut faulty, sensors);
                        assert_eq!(
                            faulty.duties(),
                            [Duty::ZERO; 3],
                            "where it is nobody knows, so nothing is damped either"
                        );
                    }
                }
            }
            let _ = servo.tick(&mut state, sensors);
            assert!(enable || state.duties() == [Duty::ZERO; 3], "tick {tick}");
            assert!(
                !state.homed() && state.fault().is_none() && state.phase() == Phase::Calibrate,
                "tick {tick} {state:?}"
            );
            driven += u32::from(state.duties() != [Duty::ZERO; 3]);
            plant.advance(state.duties().map(|duty| duty.0));
        }
        assert!(driven > 4_000, "{driven}");
    }
}
