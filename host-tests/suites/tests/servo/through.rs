//! Pushed through a thin part by a hand that is stronger than the device: it is named, and the force ends.

use crate::traces::SETTINGS;
use palpate::device::Counts;
use palpate::device::presets::WOODEN_HAPTICS_2016;
use palpate::math::{Vec3, vec3};
use palpate::servo::{Config, ContactLimits, Input, Servo, Settings};
use palpate::track::{Contact, Controller, Probe, Witness};
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, Vector};

const RATE: f64 = 4_000.0;
/// Half a second on the way through, and as long at the end of it.
const TICKS: u32 = 4_000;
/// 10 ms.
const SOON: u32 = 40;

/// Down through the middle of the plate in half a second, and there it stays.
struct Through {
    top: Vector,
    depth: f64,
}

impl HandPath for Through {
    fn target(&self, time: f64) -> Vector {
        let [x, y, z] = self.top;
        [x, y, z + 0.004 - (0.004 + self.depth) * (time / 0.5).min(1.0)]
    }
    fn velocity(&self, time: f64) -> Vector {
        [0.0, 0.0, if time < 0.5 { -(0.004 + self.depth) / 0.5 } else { 0.0 }]
    }
}

#[test]
fn a_hand_that_goes_through_a_thin_plate_is_named_within_ten_milliseconds() {
    let baked = palpate_suites::body("thin_plate");
    let options = baked.locator_options();
    let (baked, _) = baked.located(&options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    // The middle of its top over the middle of the workspace.
    let settings =
        Settings { stiffness_n_per_m: 1_000.0, max_force_n: 5.0, body_origin_m: vec3(-0.03, -0.02, 0.02), ..SETTINGS };
    let servo = Servo::new(&WOODEN_HAPTICS_2016, &body, Config { settings, ..Config::DEFAULT });
    let device = PlantSettings::wooden_haptics_2016().in_sub_steps(4);
    let path = Through { top: [0.0, 0.0, 0.022], depth: 0.046 };
    let mut plant = Plant::new(&device, HandSettings::default(), Box::new(path), RATE).unwrap();
    let mut state = servo.start();
    let limit = f64::from(ContactLimits::DEFAULT.depth * settings.max_force_n / settings.stiffness_n_per_m);
    let limit = limit.max(f64::from(ContactLimits::DEFAULT.min_depth_m));
    let (mut beyond, mut named, mut greatest) = (None, None, 0.0_f32);
    for tick in 0..TICKS {
        let _ = servo.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        plant.advance(state.duties().map(|duty| duty.0));
        assert_eq!(state.fault(), None, "tick {tick}");
        let depth = 0.022 - plant.position()[2];
        if beyond.is_none() && depth > limit {
            beyond = Some(tick);
        }
        if named.is_none() && state.contacts_lost() > 0 {
            named = Some(tick);
        }
        match named {
            None => greatest = greatest.max(state.force().length()),
            Some(since) if tick > since + SOON => {
                assert_eq!(state.force(), Vec3::ZERO, "tick {tick}");
                assert_ne!(state.contact(), Contact::Touching, "tick {tick}");
            }
            Some(_) => {}
        }
    }
    let (beyond, named) = (beyond.expect("it goes through"), named.expect("it is named"));
    println!(
        "beyond {limit} m in tick {beyond}, named in tick {named}; at most {greatest} N; {} lost",
        state.contacts_lost()
    );
    assert!(greatest > 4.9, "all the force there is: {greatest} N");
    assert!(named.abs_diff(beyond) <= SOON, "beyond in tick {beyond}, named in tick {named}");
    assert_eq!(state.contacts_lost(), 1, "once");
}

#[test]
fn a_probe_inside_is_located_within_ten_milliseconds() {
    let mut seed = 1_u32;
    let mut draw = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    for name in ["capped_box", "thin_plate", "rounded_cylinder", "ellipsoid_body"] {
        let baked = palpate_suites::body(name);
        let options = baked.locator_options();
        let (baked, _) = baked.located(&options, &|_, _| ()).unwrap();
        let body = baked.to_body().unwrap();
        let mut longest = 0;
        for _ in 0..500 {
            // From somewhere on the surface, up to a third of the size behind it.
            let face = &body.faces()[(draw() * body.faces().len() as f32) as usize];
            let on = Witness::at(&face.patch, draw(), draw());
            let Some(normal) = on.normal(&face.patch) else { continue };
            let probe = Probe::at(on.surface.point - normal * (draw() * body.size() / 3.0));
            let mut witness = body.start();
            let ticks = (1..1_000).find(|_| {
                body.step(&Controller::SecondOrder, &mut witness, probe, 1.0 / RATE as f32);
                witness.is_located
            });
            longest = longest.max(ticks.unwrap_or(1_000));
        }
        println!("{name}: located after {longest} ticks at most");
        assert!(longest <= SOON, "{name}: {longest}");
    }
}
