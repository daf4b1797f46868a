//! A scene in the servo loop.

use crate::common::{BOX, LIMITS, Random, part};
use palpate::body::{Body, BodyWitness};
use palpate::device::presets::WOODEN_HAPTICS_2016 as DEVICE;
use palpate::device::{Counts, SerialArm};
use palpate::math::vec3;
use palpate::render::Friction;
use palpate::scene::{Material, Motion, Scene, SceneState};
use palpate::servo::{Config, Input, Phase, Rendering, Servo, ServoState, Settings};
use palpate::track::{Contact, Placement};

const SETTINGS: Settings = Settings {
    rate_hz: 4_000.0,
    stiffness_n_per_m: 600.0,
    damping_n_s_per_m: 1.0,
    max_force_n: 5.0,
    velocity_corner_hz: 200.0,
    soft_start_s: 0.05,
    body_origin_m: vec3(-0.03, -0.02, -0.015),
};
const FRICTION: Friction =
    Friction { stiffness_n_per_m: 800.0, damping_n_s_per_m: 1.0, static_coefficient: 0.6, dynamic_coefficient: 0.4 };

/// Joint counts on slow strokes through the box.
fn strokes(ticks: usize) -> Vec<[Counts; 3]> {
    let reach = [[-0.32, 0.32], [0.0, 0.65], [0.65, 1.2]];
    let mut random = Random::new(11);
    let mut draw = || reach.map(|[low, high]| random.between(low, high));
    let (mut from, mut to) = (draw(), draw());
    let mut at = 0;
    let mut counts = Vec::with_capacity(ticks);
    while counts.len() < ticks {
        let share = f64::from(at) / 1_500.0;
        let angles: [f64; 3] = core::array::from_fn(|joint| from[joint] + share * (to[joint] - from[joint]));
        counts.push(core::array::from_fn(|joint| {
            let encoder = &DEVICE.encoders[joint];
            Counts(
                ((angles[joint] - f64::from(encoder.angle_at_zero_rad)) / f64::from(encoder.radians_per_count)) as i32,
            )
        }));
        at += 1;
        if at == 1_500 {
            (from, to, at) = (to, draw(), 0);
        }
    }
    counts
}

/// What a body is by itself, with the loop's own spring and friction, it is as a scene that rests.
#[test]
fn a_scene_of_one_body_at_rest_feels_as_the_body() {
    static RESTING: Scene<'static, Body<'static>, 1> = Scene::new(
        LIMITS,
        [part(
            Motion::Resting(Placement::IDENTITY),
            Material {
                friction: Some(FRICTION),
                ..Material::new(SETTINGS.stiffness_n_per_m, SETTINGS.damping_n_s_per_m)
            },
        )],
    );
    let rendering = Rendering { max_slew_n_per_s: 400.0, ..Rendering::PLAIN };
    let alone: Servo<Body, SerialArm, 3> = Servo::new(
        &DEVICE,
        &BOX,
        Config {
            settings: SETTINGS,
            rendering: Rendering { friction: Some(FRICTION), ..rendering },
            ..Config::DEFAULT
        },
    );
    let scene = Servo::new(&DEVICE, &RESTING, Config { settings: SETTINGS, rendering, ..Config::DEFAULT });
    let (mut a, mut b) = (alone.start(), scene.start());
    let (mut touched, mut worst) = (0, 0.0_f32);
    for counts in strokes(300_000) {
        let input = Input::Sensors { counts, enable: true };
        let _ = alone.tick(&mut a, input);
        let _ = scene.tick(&mut b, input);
        assert_eq!((a.fault(), a.contact(), a.contacts_lost()), (b.fault(), b.contact(), b.contacts_lost()));
        // A scene fades what is lost by itself: begin anew then.
        if a.fault().is_some() || a.contacts_lost() > 0 {
            (a, b) = (alone.start(), scene.start());
            continue;
        }
        if a.phase() == Phase::Running && a.contact() == Contact::Touching {
            touched += 1;
            worst = worst.max((a.force() - b.force()).length());
        }
    }
    println!("{touched} ticks touched, forces apart by at most {worst:.1e} N");
    assert!(touched > 2_000, "{touched}");
    // A rounding or two of 5 N.
    assert!(worst < 2e-6, "{worst}");
}

/// What a scene takes in RAM, as docs/howto/scenes.md says it.
#[test]
fn a_body_of_a_scene_takes_half_a_kilobyte() {
    let sizes = [
        size_of::<ServoState<3, SceneState<BodyWitness, 1>>>(),
        size_of::<SceneState<BodyWitness, 2>>() - size_of::<SceneState<BodyWitness, 1>>(),
    ];
    println!("{} bytes of the loop with one body, and {} for each further", sizes[0], sizes[1]);
    assert_eq!(sizes, [992, 516]);
}
