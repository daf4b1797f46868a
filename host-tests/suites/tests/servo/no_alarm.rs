//! A sound device raises no alarm where a hand presses on it or slides along it.

use crate::protected::{Bench, FALCON, PHANTOM, POLHEM, RATE, WOODEN_HAPTICS, settings};
use crate::surfaces::WALL;
use crate::touch::Press;
use palpate::device::{Counts, Kinematics};
use palpate::math::Vec3;
use palpate::render::Material;
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Fault, Input, Rendering, Servo, Settings};
use palpate::track::Contact;
use palpate_sim::plant::{HandPath, HandSettings, Plant, Vector};

/// Presses on a wall with so many newtons, which the motors bear for ever, for 0.7 s: with the gains that the preset
/// allows at most, and with those that the device is recommended to be driven with.
fn presses<K: Kinematics<3>>(bench: &Bench<K>, recommended: &Recommended, push: f64) {
    let most = settings(bench.device, Vec3::ZERO);
    let felt = Settings { body_origin_m: Vec3::ZERO, ..recommended.settings };
    for (settings, rendering) in [(most, Rendering::PLAIN), (felt, recommended.rendering)] {
        let servo =
            Servo::protected(bench.device, &WALL, bench.protection, Config { settings, rendering, ..Config::DEFAULT });
        let hand = HandSettings::default();
        // What the wall yields and what the hand does.
        let depth = push / f64::from(settings.stiffness_n_per_m) + push / hand.stiffness;
        let path = Press { point: [0.0; 3], normal: [0.0, 0.0, 1.0], depth };
        let mut plant = Plant::new(&bench.plant.in_sub_steps(4), hand, Box::new(path), RATE).unwrap();
        let mut state = servo.start();
        let mut seen_at = None;
        for tick in 0..2_800 {
            let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
            assert_eq!(state.fault(), None, "{} at {} N/m", bench.name, settings.stiffness_n_per_m);
            plant.advance(state.duties().map(|duty| duty.0));
            if state.guard().joints_seen() == [true; 3] {
                seen_at = seen_at.or(Some(f64::from(tick) / RATE));
            }
        }
        let force = state.force().length();
        println!(
            "{:<20} {} N/m: all joints seen at {seen_at:?} s, {force:.2} N",
            bench.name, settings.stiffness_n_per_m
        );
        assert!(seen_at.is_some() && state.contact() == Contact::Touching, "{}", bench.name);
        assert!(f64::from(force) > 0.5 * push, "{}: {force} N", bench.name);
    }
}

#[test]
fn wooden_haptics_is_pressed_without_an_alarm() {
    presses(&WOODEN_HAPTICS, &recommended::WOODEN_HAPTICS_2016, 3.0);
}

#[test]
fn polhem_is_pressed_without_an_alarm() {
    presses(&POLHEM, &recommended::POLHEM_V2, 3.0);
}

#[test]
fn phantom_is_pressed_without_an_alarm() {
    presses(&PHANTOM, &recommended::PHANTOM_PREMIUM, 1.2);
}

#[test]
fn falcon_is_pressed_without_an_alarm() {
    presses(&FALCON, &recommended::NOVINT_FALCON, 6.0);
}

/// To and fro across the arm's plane, where the joint that carries the depth moves least.
struct Slide {
    speed: f64,
    depth: f64,
}

const HALF_WAY: f64 = 0.03;

impl HandPath for Slide {
    fn target(&self, time: f64) -> Vector {
        let way = self.speed * time + HALF_WAY;
        let (stroke, part) = ((way / (2.0 * HALF_WAY)).floor(), way.rem_euclid(2.0 * HALF_WAY) - HALF_WAY);
        let along = if stroke.rem_euclid(2.0) == 0.0 { part } else { -part };
        // Assumed of the steadiest hand: 3 % of its force within some seconds, and the tremor of a surgeon's, 0.1 mm from
        // peak to peak.
        let unsteady = 2e-4 * (4.4 * time).sin() + 5e-5 * (57.0 * time).sin();
        let lowered = (time / 0.4).min(1.0);
        [0.0, along, 0.004 - lowered * (0.004 + self.depth) + unsteady]
    }

    fn velocity(&self, time: f64) -> Vector {
        const STEP: f64 = 1e-5;
        let [before, after] = [time, time + STEP].map(|time| self.target(time));
        core::array::from_fn(|axis| (after[axis] - before[axis]) / STEP)
    }
}

/// Slides, pressing with what the motors bear, on a wall with the friction of wood; then with the count of each joint that
/// carries the load standing still.
fn slides<K: Kinematics<3>>(
    bench: &Bench<K>,
    Recommended { settings, rendering }: &Recommended,
    push: f64,
    carries: &[usize],
) {
    let settings = Settings { body_origin_m: Vec3::ZERO, ..*settings };
    let rendering = Rendering { friction: Some(Material::WOOD.friction), ..*rendering };
    let servo = Servo::new(bench.device, &WALL, Config { settings, rendering, ..Config::DEFAULT });
    let hand = HandSettings::default();
    let depth = push / f64::from(settings.stiffness_n_per_m) + push / hand.stiffness;
    let stuck = |speed: f64, seconds: f64, frozen: Option<usize>| {
        let plant = bench.plant.in_sub_steps(4);
        let mut plant = Plant::new(&plant, hand, Box::new(Slide { speed, depth }), RATE).unwrap();
        let mut state = servo.start();
        let mut last = None;
        for tick in 0..((1.0 + seconds) * RATE) as u32 {
            let mut counts = plant.counts().map(Counts);
            if let (Some(joint), true) = (frozen, f64::from(tick) >= RATE) {
                counts[joint] = *last.get_or_insert(counts[joint]);
            }
            let _ = servo.tick(&mut state, Input::Sensors { counts, enable: true });
            if let Some((fault, at)) = state.fault() {
                return Some((fault, f64::from(at) / RATE - 1.0));
            }
            plant.advance(state.duties().map(|duty| duty.0));
        }
        assert_eq!(state.contact(), Contact::Touching);
        None
    };
    // At 5 mm/s for longer than the check takes.
    for (speed, seconds) in [(0.0, 3.0), (0.005, 9.0), (0.03, 4.0), (0.1, 3.0), (0.3, 3.0)] {
        let found = stuck(speed, seconds, None);
        println!("{:<20} at {speed} m/s: {found:?}", bench.name);
        assert_eq!(found, None, "{} at {speed} m/s", bench.name);
    }
    for (speed, joint) in carries.iter().flat_map(|joint| [(0.03, *joint), (0.3, *joint)]) {
        let found = stuck(speed, 2.0, Some(joint));
        println!("{:<20} joint {joint} stands still at {speed} m/s: {found:?}", bench.name);
        assert!(matches!(found, Some((Fault::JointStuck, time)) if time < 2.0), "{} {joint}: {found:?}", bench.name);
    }
}

#[test]
fn a_slide_along_a_wall_is_no_stuck_sensor() {
    slides(&WOODEN_HAPTICS, &recommended::WOODEN_HAPTICS_2016, 2.0, &[1, 2]);
    slides(&POLHEM, &recommended::POLHEM_V2, 2.0, &[1, 2]);
    // Its second link hangs, and carries no depth.
    slides(&PHANTOM, &recommended::PHANTOM_PREMIUM, 1.2, &[1]);
    slides(&FALCON, &recommended::NOVINT_FALCON, 6.0, &[]);
}
