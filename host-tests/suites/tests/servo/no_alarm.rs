//! The polarity check raises no alarm where a hand presses on a sound device.

use crate::protected::{Bench, FALCON, PHANTOM, POLHEM, RATE, WOODEN_HAPTICS, settings};
use crate::surfaces::WALL;
use crate::touch::Press;
use palpate::device::{Counts, Kinematics};
use palpate::math::Vec3;
use palpate::servo::recommended::{self, Recommended};
use palpate::servo::{Config, Input, Rendering, Servo, Settings};
use palpate::track::Contact;
use palpate_sim::plant::{HandSettings, Plant};

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
        let mut plant = Plant::new(&bench.plant, hand, Box::new(path), RATE).unwrap();
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
