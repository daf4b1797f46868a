//! The passivity controller on the arm: no debt beyond a quantum, and idle where the wall is passive anyway.

use crate::surfaces::WALL;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::device::{Counts, Device, SerialArm, VelocityMethod};
use palpate::math::Vec3;
use palpate::render::Passivity;
use palpate::servo::{Config, Input, Rendering, Servo, Settings};
use palpate::track::Contact;
use palpate_sim::plant::{HandSettings, Plant, PlantSettings, TouchingPath, TouchingSettings};

const RATE: f64 = 4_000.0;
/// One count of each joint: published as 43, 54 and 64 µm, at right angles or less.
const RESOLUTION: f32 = 94e-6;

/// The arm without the preset's limits on gains.
const FREE: Device<SerialArm, 3> =
    Device { max_stiffness_n_per_m: 100_000.0, max_damping_n_s_per_m: 100.0, ..WOODEN_HAPTICS_2016 };

#[derive(Debug)]
struct Tally {
    ticks: u32,
    touching: u32,
    active: u32,
    /// The greatest debt, in quanta.
    debt: f32,
}

/// Touches the wall for 10 s.
fn touch(kind: Rendering, stiffness: f32, damping: f32, viscous: f64, control: Passivity, seed: u64) -> Tally {
    let settings = Settings {
        rate_hz: RATE as f32,
        stiffness_n_per_m: stiffness,
        damping_n_s_per_m: damping,
        max_force_n: 5.0,
        velocity_corner_hz: if matches!(kind.velocity, VelocityMethod::BetweenCounts) { 80.0 } else { 200.0 },
        soft_start_s: 0.05,
        body_origin_m: Vec3::ZERO,
    };
    let rendering = Rendering { passivity: Some(control), ..kind };
    let servo = Servo::new(&FREE, &WALL, Config { settings, rendering, ..Config::DEFAULT });
    let level = |u: f64, v: f64| ([0.1 * (u - 0.5), 0.1 * (v - 0.5), 0.0], [0.0, 0.0, 1.0]);
    let touching = TouchingSettings { duration: 10.0, touches: 15, ..TouchingSettings::default() };
    let path = TouchingPath::new(level, touching, seed).unwrap();
    let mut device = PlantSettings::wooden_haptics_2016().in_sub_steps(4);
    for joint in &mut device.joints {
        joint.viscous_friction += viscous;
    }
    let mut plant = Plant::new(&device, HandSettings::default(), Box::new(path), RATE).unwrap();
    let mut state = servo.start();
    let mut tally = Tally { ticks: 0, touching: 0, active: 0, debt: 0.0 };
    for _ in 0..40_000 {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        assert_eq!(state.fault(), None);
        plant.advance(state.duties().map(|duty| duty.0));
        tally.ticks += 1;
        tally.touching += u32::from(state.contact() == Contact::Touching);
        tally.active += u32::from(state.energy().is_active());
        tally.debt = tally.debt.max(-state.energy().stored / control.quantum(5.0));
    }
    tally
}

#[test]
fn in_passive_settings_it_is_idle() {
    // Bearings of 0.1 N·m·s on levers of at most 0.3 m: more than 1.1 N·s/m at the probe, in any direction.
    let control = Passivity {
        device_damping_n_s_per_m: 1.1,
        device_friction_n: 0.0,
        max_damping_n_s_per_m: 20.0,
        resolution_m: RESOLUTION,
    };
    // b > K (T/2 + t_d) + B, a period and 0.15 ms of delay: 0.9 > 300 · 0.525 ms + 0.3; and where the position is that
    // between counts, 0.5 ms more: 0.9 > 300 · 1.025 ms + 0.3.
    for (kind, seed) in [Rendering::PLAIN, Rendering::EASED, Rendering::SMOOTH]
        .into_iter()
        .flat_map(|kind| (0..3).map(move |seed| (kind, seed)))
    {
        let tally = touch(kind, 300.0, 0.3, 0.1, control, seed);
        println!("passive, {:?}, {:?}: {tally:?}", kind.velocity, kind.ease);
        assert!(tally.touching > 5_000, "{tally:?}");
        assert!(f64::from(tally.active) < 0.001 * f64::from(tally.ticks), "{tally:?}");
        assert!(tally.debt <= 1.0, "{tally:?}");
    }
}

#[test]
fn no_wall_ever_owes_more_than_a_quantum() {
    // Far beyond the passive bound, up to walls that would not hold by themselves.
    let control = Passivity {
        device_damping_n_s_per_m: 0.0,
        device_friction_n: 0.0,
        max_damping_n_s_per_m: 30.0,
        resolution_m: RESOLUTION,
    };
    let mut active = 0;
    for (stiffness, damping) in [(600.0, 0.0), (1_000.0, 0.0), (1_000.0, 2.0), (3_000.0, 0.0), (6_000.0, 0.0)] {
        for (seed, kind) in [(0, Rendering::PLAIN), (1, Rendering::PLAIN), (2, Rendering::SMOOTH)] {
            let tally = touch(kind, stiffness, damping, 0.0, control, seed);
            println!("{stiffness} N/m, {damping} N·s/m: {tally:?}");
            assert!(tally.debt <= 1.0, "{stiffness} {damping}: {tally:?}");
            active += tally.active;
        }
    }
    assert!(active > 100, "it has something to do: {active}");
}
