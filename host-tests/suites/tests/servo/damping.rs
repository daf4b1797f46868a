//! After which faults nothing is damped, though damping was chosen: those that say that motors cannot be trusted.

use crate::surfaces::WALL;
use palpate::device::presets::{WOODEN_HAPTICS_2016, WOODEN_HAPTICS_2016_PROTECTION};
use palpate::device::{Counts, Duty, Protection, SupplyRange};
use palpate::math::Vec3;
use palpate::servo::{Config, Event, Fault, Input, Output, Rendering, SafeOutput, Safety, Servo, Settings};
use palpate_sim::plant::{Direction, HandPath, HandSettings, Plant, PlantSettings, Vector};
use std::f64::consts::TAU;

const RATE: f64 = 4_000.0;
const PROTECTION: Protection<3> =
    Protection { supply: Some(SupplyRange { min_mv: 20_000, max_mv: 28_000 }), ..WOODEN_HAPTICS_2016_PROTECTION };

/// From 4 mm above the wall to 8 mm below it, again and again.
struct UpAndDown;

impl HandPath for UpAndDown {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, -0.002 + 0.006 * (TAU * 1.5 * time).cos()]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, -0.006 * TAU * 1.5 * (TAU * 1.5 * time).sin()]
    }
}

/// Presses into the wall until the event, or a fault, and gives how many of the ticks after it are driven.
fn driven_after(event: Option<Event>, wrong: bool) -> (Option<Fault>, u32) {
    let device = &WOODEN_HAPTICS_2016;
    let settings = Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: device.max_stiffness_n_per_m,
        damping_n_s_per_m: device.max_damping_n_s_per_m,
        max_force_n: device.max_force_n,
        velocity_corner_hz: 200.0,
        soft_start_s: 0.1,
        body_origin_m: Vec3::ZERO,
    };
    let servo = Servo::protected(
        device,
        &WALL,
        PROTECTION,
        Config {
            settings,
            rendering: Rendering { compensates_gravity: !wrong, ..Rendering::PLAIN },
            safety: Safety { output: SafeOutput::Damping(4.0), ..Safety::DEFAULT },
            ..Config::DEFAULT
        },
    );
    let mut plant = PlantSettings::wooden_haptics_2016();
    if wrong {
        for joint in &mut plant.joints {
            let way = &mut joint.motor_direction;
            *way = if *way == Direction::With { Direction::Against } else { Direction::With };
        }
    }
    let mut plant = Plant::new(&plant, HandSettings::default(), Box::new(UpAndDown), RATE).unwrap();
    let mut state = servo.start();
    let mut after = None;
    // Seven contacts: a wrong sign is told in one of the first.
    for tick in 0..20_000 {
        servo.note(&mut state, Event::Supply { millivolts: 24_000 });
        if tick == 4_000
            && let Some(event) = event
        {
            servo.note(&mut state, event);
        }
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        if state.fault().is_some() {
            let drives = matches!(state.output(), Output::Drive(duties) if duties != [Duty::ZERO; 3]);
            *after.get_or_insert(0) += u32::from(drives);
        }
        plant.advance(state.duties().map(|duty| duty.0));
    }
    (state.fault().map(|(fault, _)| fault), after.unwrap_or(0))
}

#[test]
fn nothing_damps_after_a_fault_of_a_drive_of_the_supply_of_a_sign_or_of_the_calibration() {
    let (fault, driven) = driven_after(Some(Event::Stop), false);
    assert!(fault == Some(Fault::Stopped) && driven > 1_000, "what follows must damp otherwise: {driven} ticks");
    assert_eq!(driven_after(Some(Event::DriveFault), false), (Some(Fault::Drive), 0));
    assert_eq!(driven_after(Some(Event::Supply { millivolts: 12_000 }), false), (Some(Fault::Supply), 0));
    // Which way they would push nobody knows.
    assert_eq!(driven_after(Some(Event::CalibrationRefused), false), (Some(Fault::Calibration), 0));
    // It would push, not brake.
    assert_eq!(driven_after(None, true), (Some(Fault::WrongPolarity), 0));
}
