//! A device that moves, with failures planted: on the project's own plant, and on MuJoCo's where that is.

use crate::mujoco::Mujoco;
use crate::surfaces::WALL;
use palpate::device::SerialArm;
use palpate::device::presets::{WOODEN_HAPTICS_2016 as DEVICE, WOODEN_HAPTICS_2016_PROTECTION as PROTECTION};
use palpate::math::{Vec3, vec3};
use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};
use palpate::servo::{
    Config, Fault, Guard, Guarded, Rendering, SafeOutput, Safety, Servo, ServoState, Settings, Surface, recommended,
};
use palpate::track::Contact;
use palpate_sim::motion::{Planted, Sample, Script, play};
use palpate_sim::plant::{HandSettings, Plant, PlantSettings, StillHand, Vector};
use palpate_truth::measured::measured;

const RATE: f64 = 4_000.0;
const FIRM: HandSettings = HandSettings { stiffness: 1_000.0, damping: 20.0, mass: 0.0 };
const SAFETY: Safety = Safety { output: SafeOutput::Damping(2.0), ..Safety::DEFAULT };

/// A wall through the origin, upright, felt from +x.
static UPRIGHT: SplinePatch = SplineTable {
    degree: [1, 1],
    breaks_u: &[0.0, 1.0],
    breaks_v: &[0.0, 1.0],
    coefficients: Coefficients::Polynomial(&[[0.0; 3], [0.0, 0.0, 0.16], [0.0, 0.16, 0.0], [0.0; 3]]),
    shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
    orientation: Orientation::Outward,
    size_m: 0.16,
    crc: None,
}
.checked();

fn protected<S: Surface>(
    surface: &S,
    settings: Settings,
    rendering: Rendering,
) -> Servo<'_, S, SerialArm, 3, Guarded<3>> {
    Servo::protected(&DEVICE, surface, PROTECTION, Config { settings, rendering, safety: SAFETY, ..Config::DEFAULT })
}

/// As recommended, with the surface's origin here.
fn recommended<S: Surface>(surface: &S, body_origin_m: Vec3) -> Servo<'_, S, SerialArm, 3, Guarded<3>> {
    let recommended::Recommended { settings, rendering } = recommended::WOODEN_HAPTICS_2016;
    protected(surface, Settings { body_origin_m, ..settings }, rendering)
}

/// A run: which plant, its samples, and what was looked at after each tick.
struct Played<T> {
    plant: &'static str,
    samples: Vec<Sample>,
    looked: Vec<T>,
}

/// Plays a script on the project's own plant, then on MuJoCo's.
fn on_both<S: Surface, G: Guard<3>, T>(
    servo: &Servo<'_, S, SerialArm, 3, G>,
    plant: &PlantSettings,
    script: &Script,
    look: impl Fn(&ServoState<3, S::Witness, G::State>) -> T,
) -> Vec<Played<T>> {
    let place = (script.path)(0.0);
    let mut own = Plant::new(plant, script.grip, Box::new(StillHand(place)), RATE).unwrap();
    let mujoco = Mujoco::start(plant, own.angles());
    let mut looked = Vec::new();
    let samples = play(servo, script, &mut own, |state| looked.push(look(state)));
    let mut played = vec![Played { plant: "own", samples, looked }];
    if let Some(mut mujoco) = mujoco {
        let mut looked = Vec::new();
        let samples = play(servo, script, &mut mujoco, |state| looked.push(look(state)));
        played.push(Played { plant: "MuJoCo", samples, looked });
    }
    played
}

/// A figure of each run: where both plants are, the row of the page.
fn figures<T>(claim: &str, played: &[Played<T>], figure: impl Fn(&Played<T>) -> f64) {
    let figures: Vec<String> = played.iter().map(|played| format!("{:.1}", figure(played))).collect();
    match &figures[..] {
        [own, mujoco] => measured(claim, format!("{own} / {mujoco}")),
        own => println!("{claim}: {own:?}"),
    }
}

fn length(vector: Vector) -> f64 {
    vector.iter().map(|axis| axis * axis).sum::<f64>().sqrt()
}

fn apart(a: Vector, b: Vector) -> f64 {
    length(core::array::from_fn(|axis| a[axis] - b[axis]))
}

impl<T> Played<T> {
    /// The fault and its time, s.
    fn fault(&self) -> Option<(Fault, f64)> {
        self.samples.iter().find_map(|sample| sample.fault.map(|fault| (fault, sample.time)))
    }

    fn fastest(&self) -> f64 {
        self.samples.iter().map(|sample| length(sample.velocity)).fold(0.0, f64::max)
    }

    fn at(&self, time: f64) -> &Sample {
        self.samples.iter().find(|sample| sample.time >= time).unwrap()
    }
}

/// The place at a time, from one to the next of these times and places.
fn along(places: &[(f64, f64)], time: f64) -> f64 {
    let next = places.iter().position(|(at, _)| *at > time).unwrap_or(places.len());
    match (next.checked_sub(1).map(|last| places[last]), places.get(next)) {
        (Some((start, from)), Some((end, to))) => from + (to - from) * (time - start) / (end - start),
        (Some((_, place)), None) => place,
        (None, first) => first.map_or(0.0, |(_, place)| *place),
    }
}

/// Where a hand aims over a wall, m: twice from the front to 14 mm behind, so that all polarities are seen, then deep.
fn pressed(depth: f64, time: f64) -> f64 {
    let touch = [(0.0, 0.01), (0.2, -0.014), (0.5, -0.014), (0.6, 0.01), (0.8, -0.014), (1.1, -0.014), (1.5, -depth)];
    along(&touch, time)
}

/// s.
const RELEASED: f64 = 1.7;

#[test]
fn an_arm_released_from_the_deepest_press_is_stopped() {
    let stiff = Settings {
        stiffness_n_per_m: DEVICE.max_stiffness_n_per_m,
        damping_n_s_per_m: DEVICE.max_damping_n_s_per_m,
        velocity_corner_hz: 200.0,
        ..recommended::WOODEN_HAPTICS_2016.settings
    };
    // Contact is given up at 20 mm with 500 N/m and at 10 mm with 1,000. The hand's spring of 300 N/m gives way by 5 N.
    let soft: [fn(f64) -> Vector; 2] =
        [|time| [0.0, 0.0, pressed(0.0348, time)], |time| [pressed(0.0325, time), 0.0, 0.0]];
    let hard: [fn(f64) -> Vector; 2] =
        [|time| [0.0, 0.0, pressed(0.0255, time)], |time| [pressed(0.023, time), 0.0, 0.0]];
    for (surface, axis) in [(&WALL, 0), (&UPRIGHT, 1)] {
        for (servo, path) in
            [(recommended(surface, Vec3::ZERO), soft[axis]), (protected(surface, stiff, Rendering::PLAIN), hard[axis])]
        {
            let script =
                Script { path, grip: HandSettings::default(), planted: Planted::Released(RELEASED), seconds: 2.0 };
            let played = on_both(&servo, &PlantSettings::wooden_haptics_2016(), &script, |_| ());
            let (stiffness, along) = (servo.settings().stiffness_n_per_m, ["z", "x"][axis]);
            for Played { plant, samples, .. } in &played {
                let deep = -1e3 * samples.iter().find(|sample| sample.time >= RELEASED).unwrap().gap;
                println!("{plant}: released {deep:.1} mm deep along {along} at {stiffness} N/m");
            }
            for run in &played {
                let fault = run.fault();
                assert!(matches!(fault, Some((Fault::Overspeed, time)) if time > RELEASED), "{} {fault:?}", run.plant);
            }
            figures(&format!("released along {along} at {stiffness} N/m: fault after"), &played, |run| {
                1e3 * (run.fault().unwrap().1 - RELEASED)
            });
            figures(&format!("released along {along} at {stiffness} N/m: maximum speed"), &played, |run| {
                let speed = |sample: &Sample| if sample.time > RELEASED { length(sample.velocity) } else { 0.0 };
                run.samples.iter().map(speed).fold(0.0, f64::max)
            });
        }
    }
}

#[test]
fn a_hand_in_free_air_is_never_too_fast() {
    let servo = recommended(&WALL, vec3(0.0, 0.0, -0.05));
    let path = |time: f64| [-0.08 * (20.0 * time).cos(), 0.0, 0.0];
    let script = Script { path, grip: FIRM, planted: Planted::Nothing, seconds: 1.0 };
    for played in on_both(&servo, &PlantSettings::wooden_haptics_2016(), &script, |_| ()) {
        println!("{:<7} {:.2} m/s", played.plant, played.fastest());
        assert!(played.fastest() > 1.5 && played.fault().is_none(), "{:?}", played.fault());
    }
}

/// Slides over ±45 mm, pressing with 2 N.
fn slides_x(time: f64) -> Vector {
    [0.045 * (5.0 * time).sin(), 0.0, along(&[(0.0, 0.01), (0.4, -0.007)], time)]
}

/// The same across.
fn slides_y(time: f64) -> Vector {
    let [x, _, z] = slides_x(time);
    [0.0, x, z]
}

#[test]
fn a_count_that_stands_still_under_load_is_found_by_default() {
    let servo = recommended(&WALL, Vec3::ZERO);
    type Path = (&'static str, fn(f64) -> Vector);
    let paths: [Path; 2] = [("x", slides_x), ("y", slides_y)];
    for (along, path) in paths {
        for planted in [Planted::Nothing, Planted::Frozen(0, 1.5), Planted::Frozen(1, 1.5), Planted::Frozen(2, 1.5)] {
            let script = Script { path, grip: FIRM, planted, seconds: 5.0 };
            let played = on_both(&servo, &PlantSettings::wooden_haptics_2016(), &script, |_| ());
            for run in &played {
                let (fault, is_given_up) = (run.fault(), run.samples.iter().any(|sample| sample.lost > 0));
                println!("{} along {along}, {planted:?}: {fault:?}, given up {is_given_up}", run.plant);
                match planted {
                    // A level wall does not load the turntable.
                    Planted::Frozen(1 | 2, _) if along == "y" => {
                        assert!(matches!(fault, Some((Fault::JointStuck, time)) if time > 1.5 && time < 2.5));
                    }
                    // Where the joint that is stuck is the one that moves, the wall is soon left behind.
                    Planted::Frozen(1 | 2, _) => assert!(fault.is_some() || is_given_up),
                    _ => assert!(fault.is_none() && !is_given_up, "{fault:?}"),
                }
            }
            if let (Planted::Frozen(joint @ (1 | 2), _), "y") = (planted, along) {
                figures(&format!("count of joint {joint} stands still, sliding across: fault after"), &played, |run| {
                    1e3 * (run.fault().unwrap().1 - 1.5)
                });
            }
        }
    }
}

#[test]
fn a_reversed_encoder_gives_no_force_beyond_its_pulses() {
    let servo = recommended(&WALL, Vec3::ZERO);
    for joint in 0..3 {
        let script =
            Script { path: slides_x, grip: HandSettings::default(), planted: Planted::Reversed(joint), seconds: 3.0 };
        let played = on_both(&servo, &PlantSettings::wooden_haptics_2016(), &script, |_| ());
        let most = |played: &Played<()>| played.samples.iter().map(|sample| sample.force.length()).fold(0.0, f32::max);
        for played in &played {
            println!(
                "{:<7} encoder {joint} reversed: {:.2} N at most, {:?}",
                played.plant,
                most(played),
                played.fault()
            );
            assert!(most(played) < 0.25 * DEVICE.max_force_n);
        }
        figures(&format!("encoder {joint} reversed: largest force"), &played, |played| f64::from(most(played)));
    }
}

#[test]
fn a_contact_given_up_is_located_within_ten_milliseconds_and_gives_no_force_before_the_probe_was_outside() {
    let baked = palpate_suites::body("capped_box");
    let options = baked.locator_options();
    let (baked, _) = baked.located(&options, &|_, _| ()).unwrap();
    let body = baked.to_body().unwrap();
    // The top of its dome 6.5 mm under the middle of the workspace. Through what the contact bears, out, and in again.
    let servo = recommended(&body, vec3(-0.03, -0.02, -0.04));
    let path = |time| {
        let places =
            [(0.0, 0.01), (0.4, -0.012), (0.8, -0.012), (1.0, -0.034), (1.3, -0.034), (1.5, 0.01), (1.7, -0.012)];
        [0.0, 0.0, along(&places, time)]
    };
    let script = Script { path, grip: FIRM, planted: Planted::Nothing, seconds: 2.0 };
    let runs = on_both(&servo, &PlantSettings::wooden_haptics_2016(), &script, |state| state.witness().is_located);
    // Ticks from the end of the contact: located, outside, without force, and with force again.
    let times = |played: &Played<bool>| {
        let samples = &played.samples;
        let given_up = samples.iter().position(|sample| sample.lost > 0).expect("it is given up");
        let after = |start: usize, is: &dyn Fn(usize) -> bool| {
            (start..samples.len()).find(|tick| is(*tick)).map(|tick| tick - given_up).expect("it happens")
        };
        let gone = after(given_up, &|tick| samples[tick].force == Vec3::ZERO);
        [
            after(given_up + 1, &|tick| played.looked[tick]),
            after(given_up, &|tick| samples[tick].contact == Contact::InFront),
            gone,
            after(given_up + gone, &|tick| samples[tick].force != Vec3::ZERO),
        ]
    };
    for played in &runs {
        let [located, outside, gone, forced] = times(played);
        println!("{}: given up, then ticks {located}, {outside}, {gone}, {forced}; {:?}", played.plant, played.fault());
        assert!(located <= 40 && gone < 120 && forced > outside);
    }
    for (index, what) in ["located", "outside", "without force", "with force"].into_iter().enumerate() {
        figures(&format!("a contact given up at 20 mm: {what} after"), &runs, |played| {
            times(played)[index] as f64 / 4.0
        });
    }
}

#[test]
fn a_weight_error_moves_an_arm_that_is_let_go() {
    let recommended::Recommended { settings, rendering } = recommended::WOODEN_HAPTICS_2016;
    let settings = Settings { body_origin_m: vec3(0.0, 0.0, -0.4), ..settings };
    let servo = Servo::new(&DEVICE, &WALL, Config { settings, rendering, ..Config::DEFAULT });
    let places: [fn(f64) -> Vector; 2] = [|_| [0.0; 3], |_| [0.02, 0.02, -0.015]];
    for path in places {
        let script = Script { path, grip: HandSettings::default(), planted: Planted::Released(0.5), seconds: 2.5 };
        for share in [1.0, 1.1, 0.9] {
            let own = PlantSettings::wooden_haptics_2016();
            let plant = PlantSettings { gravity: own.gravity * share, ..own };
            let place = path(0.0).map(|axis| 1e3 * axis);
            figures(
                &format!("links weigh {share} times as much, let go at {place:?} mm: moved in 2 s"),
                &on_both(&servo, &plant, &script, |_| ()),
                |run| 1e3 * apart(run.at(0.5).position, run.samples.last().unwrap().position),
            );
        }
    }
}
