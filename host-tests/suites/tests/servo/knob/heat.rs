//! The knob's motor stays cool in each of its phases, wherever the rotor is held, whatever torque is asked for.

use super::{RATE, dial};
use palpate::device::presets::GIMBAL_KNOB;
use palpate::device::{Duty, Endurance, FieldSearch, Protection};
use palpate::render::{Feel, Spring};
use palpate::servo::{Config, Guard, Knob, Phase, Servo, Settings};
use palpate_sim::knob::{FEELS, HostKnob, LET_GO, SEARCH, SETTINGS, TOLD_OF_SUPPLY, device, homing};
use palpate_sim::plant::{DialSettings, Fingers, PhaseHeat, ThermalSettings};
use palpate_truth::measured::measured;
use std::f64::consts::TAU;

/// A winding as slow as is assumed of it, and one as fast as the model takes it for.
const WINDINGS: [ThermalSettings; 2] =
    [PhaseHeat::GIMBAL_MOTOR, ThermalSettings { winding_time_constant: 20.0, ..PhaseHeat::GIMBAL_MOTOR }];

/// All that a feel may ask for, N·m.
const ALL: f32 = GIMBAL_KNOB.max_force_n * GIMBAL_KNOB.kinematics.radius_m;

/// A knob that asks for this torque wherever it is held, running and rested: given all that it asks for.
fn asking(torque: f32) -> HostKnob {
    let feel = Feel {
        spring: Some(Spring {
            stiffness_n_m_per_rad: 1e-5,
            rest_rad: 1e4 * torque.signum(),
            max_torque_n_m: torque.abs(),
        }),
        damping_n_m_s_per_rad: 1e-8,
        ..Feel::FREE
    };
    let feels = Box::leak(Box::new([feel]));
    let knob = Box::leak(Box::new(Knob::new(&GIMBAL_KNOB, feels, LET_GO)));
    let device = Box::leak(Box::new(device(None)));
    let servo = Servo::protected(device, knob, TOLD_OF_SUPPLY, Config { settings: SETTINGS, ..Config::DEFAULT });
    // The winding's time constant is hundreds of ticks' in which nothing but heat changes: large steps do.
    let settings = DialSettings { sub_steps: 4, ..DialSettings::gimbal_knob() };
    let guard = *servo.guard();
    let mut knob = HostKnob::new(servo.with_homing(homing(SEARCH)), dial(settings));
    knob.ticks(SEARCH.ticks() + 100);
    assert!(knob.state().homed(), "{:?}", knob.state().homing().refusal());
    knob.enable = false;
    while guard.folds(knob.state().guard()) {
        knob.tick();
    }
    knob.enable = true;
    knob
}

/// Held at an angle for so many seconds: the hottest of the phases, °C, the torques asked for at the beginning and at
/// the end, and the largest step between two ticks, N·m.
fn held(mut knob: HostKnob, angle: f64, seconds: f64, motor: ThermalSettings) -> [f64; 4] {
    let from = knob.dial.angle();
    for tick in 1..=1_200 {
        knob.dial.hold(Fingers::clamp(from + (angle - from) * f64::from(tick) / 1_200.0));
        knob.tick();
    }
    assert_eq!((knob.state().phase(), knob.state().fault()), (Phase::Running, None));
    let radius = f64::from(GIMBAL_KNOB.kinematics.radius_m);
    let torque = |knob: &HostKnob| f64::from(knob.state().force().x) * radius;
    let (first, mut last) = (torque(&knob), torque(&knob));
    let mut motor = PhaseHeat::cold(motor);
    let (mut hottest, mut step) = (0.0_f64, 0.0_f64);
    for _ in 0..(seconds * RATE) as u32 {
        knob.tick();
        motor.step(knob.dial.currents(), 1.0 / RATE);
        hottest = hottest.max(motor.hottest());
        step = step.max((torque(&knob) - last).abs());
        last = torque(&knob);
    }
    assert_eq!(knob.state().fault(), None);
    [hottest, first, last, step]
}

#[test]
fn a_held_knob_folds_its_torque_back_without_a_step_wherever_its_poles_are() {
    let knob = asking(ALL);
    let (mut hottest, mut step, mut end) = (0.0_f64, 0.0_f64, 0.0_f64);
    // Twelve places of an electrical turn: in one of them or the next every phase has the whole amplitude.
    for place in 0..12 {
        let angle = 0.7 + f64::from(place) / 12.0 * TAU / 11.0;
        let [warm, first, last, largest] = held(knob.clone(), angle, 40.0, WINDINGS[1]);
        assert!((first - f64::from(ALL)).abs() < 1e-6, "at first it is given all: {first}");
        (hottest, step, end) = (hottest.max(warm), step.max(largest), end.max(last));
    }
    measured("knob: torque of a motor that is held, at first", "56");
    measured("knob: the same after 40 s", format!("{:.0}", 1e3 * end));
    measured("knob: largest step of it in a tick", format!("{:.4}", 1e3 * step));
    // A duty's step is 63 mN·m/32,767, and what is bounded may be rounded up and then down.
    assert!(step < 2.0 * 63.3e-3 / 32_767.0, "{step}");
    assert!(end < 0.045 && end > 0.040, "{end}");
    assert!(hottest < WINDINGS[1].greatest, "{hottest} °C");
}

#[test]
fn whatever_torque_is_asked_for_no_phase_gets_too_warm() {
    // Where the first phase has the whole amplitude: the field a quarter turn ahead of the rotor, on its axis.
    let angle = 1.75 * TAU / 11.0;
    for torque in [0.01, 0.03, 0.041, 0.045, 0.05, ALL, -ALL] {
        for motor in WINDINGS {
            let [hottest, first, last, _] = held(asking(torque), angle, 60.0, motor);
            println!("{:.0} mN·m: {:.0} after a minute, {hottest:.0} °C", 1e3 * first, 1e3 * last);
            assert!(hottest < motor.greatest, "{torque} N·m: {hottest} °C");
            // What it bears for ever is given for ever.
            assert!(torque.abs() > 0.04 || (first - last).abs() < 1e-6, "{first} {last}");
        }
    }
}

/// Ticks a second of the law alone.
const LAW_RATE: f64 = 500.0;

/// The law alone for two hours, all that it allows in one phase that has the whole amplitude: the warmest winding, °C.
/// So many seconds on and off, with a reset before each time on or without.
fn allowed(endurance: Endurance, motor: ThermalSettings, (on, off, reset): (f64, f64, bool)) -> f64 {
    let knob = Box::leak(Box::new(Knob::new(&GIMBAL_KNOB, &FEELS, LET_GO)));
    let settings = Settings { rate_hz: LAW_RATE as f32, ..SETTINGS };
    let device = Box::leak(Box::new(device(None)));
    let protection = Protection { motors: [endurance], ..TOLD_OF_SUPPLY };
    let servo = Servo::protected(device, knob, protection, Config { settings, ..Config::DEFAULT });
    // 0.75 A in the scale that keeps the power.
    let amplitude = 0.75 * (2.0_f64 / 3.0).sqrt();
    let (mut worn, mut motor) = (servo.guard().start(), PhaseHeat::cold(motor));
    let (mut hottest, mut was_on) = (0.0_f64, true);
    for tick in 0..(2.0 * 3_600.0 * LAW_RATE) as u32 {
        let is_on = f64::from(tick) / LAW_RATE % (on + off) < on;
        if reset && is_on && !was_on {
            worn = servo.guard().start();
        }
        was_on = is_on;
        let [limit] = worn.limits();
        let bound = limit / GIMBAL_KNOB.motors[0].torque_at_full_n_m.abs();
        let duty = Duty::from_fraction(if is_on { bound } else { 0.0 });
        servo.guard().record_output(&mut worn, &[duty]);
        let current = f64::from(duty.fraction()) * amplitude;
        motor.step([current, -0.5 * current, -0.5 * current], 1.0 / LAW_RATE);
        hottest = hottest.max(motor.hottest());
    }
    hottest
}

/// Held for ever.
const HELD: (f64, f64, bool) = (1e9, 0.0, false);

#[test]
fn no_pattern_of_holding_letting_go_and_resetting_warms_the_worst_phase_too_much() {
    let [endurance] = TOLD_OF_SUPPLY.motors;
    let mut most = 0.0_f64;
    for motor in WINDINGS {
        for pattern in [HELD, (3.0, 3.0, false), (10.0, 20.0, false), (20.0, 0.1, true), (2.0, 2.0, true)] {
            let hottest = allowed(endurance, motor, pattern);
            println!("{pattern:?}: {hottest:.0} of {} °C", motor.greatest);
            assert!(hottest < motor.greatest, "{hottest} °C");
            most = most.max(hottest);
        }
    }
    measured("knob: warmest winding of a motor that is held for hours", format!("{most:.0}"));
}

#[test]
fn to_count_what_three_phases_have_on_average_would_burn_the_worst_of_them() {
    let [Endurance { continuous, time_constant_s: time_constant }] = TOLD_OF_SUPPLY.motors;
    // Half of the square of the amplitude, as of a rotor that turns.
    let shared = Endurance { continuous: continuous * core::f32::consts::SQRT_2, time_constant_s: time_constant };
    let hottest = allowed(shared, PhaseHeat::GIMBAL_MOTOR, HELD);
    assert!(hottest > PhaseHeat::GIMBAL_MOTOR.greatest, "{hottest} °C");
}

#[test]
fn the_alignment_gives_no_more_than_the_motor_bears_for_ever() {
    let FieldSearch { torque_n_m: torque, .. } = SEARCH;
    let [endurance] = TOLD_OF_SUPPLY.motors;
    assert!(torque <= endurance.continuous * GIMBAL_KNOB.motors[0].torque_at_full_n_m);
}
