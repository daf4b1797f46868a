//! Gains that are changed under a pressed hand: no step of force or duty, no lost contact, and in the end the loop that
//! was asked for.

use crate::surfaces::WALL;
use palpate::device::presets::{WOODEN_HAPTICS_2016 as DEVICE, WOODEN_HAPTICS_2016_PROTECTION as PROTECTION};
use palpate::device::{Counts, Kinematics, SerialArm};
use palpate::patch::SplinePatch;
use palpate::render::{Ease, Friction};
use palpate::servo::{
    Config, Guard, Input, Loop, Rendering, Servo, ServoState, Settings, State, Tunable, Tuning, Unguarded,
};
use palpate::track::Contact;
use palpate_sim::plant::{HandPath, HandSettings, Plant, PlantSettings, StillHand, Vector};
use std::f64::consts::TAU;

const RATE: f64 = 4_000.0;
/// Soft start and ramp: 0.1 s.
const RAMP: usize = 400;
const SETTINGS: Settings = Settings {
    rate_hz: RATE as f32,
    stiffness_n_per_m: 300.0,
    damping_n_s_per_m: 1.0,
    // Enough for the pulses of the polarity check.
    max_force_n: 4.0,
    velocity_corner_hz: 80.0,
    soft_start_s: 0.1,
    ..Settings::DEFAULT
};

type Plain<G> = Servo<'static, SplinePatch<'static>, SerialArm, 3, G>;
type Loop3<G> = Tunable<'static, SplinePatch<'static>, SerialArm, 3, G>;

fn config(rendering: Rendering, tuning: Tuning) -> Config<3> {
    let Tuning { stiffness_n_per_m, damping_n_s_per_m, max_force_n } = tuning;
    let settings = Settings { stiffness_n_per_m, damping_n_s_per_m, max_force_n, ..SETTINGS };
    Config { settings, rendering, ..Config::DEFAULT }
}

fn plant(path: impl HandPath + 'static) -> Plant {
    Plant::new(&PlantSettings::wooden_haptics_2016().in_sub_steps(4), HandSettings::default(), Box::new(path), RATE)
        .unwrap()
}

/// Comes from the front, presses continuously, now more, now less, and slides.
struct Pressing;

impl HandPath for Pressing {
    fn target(&self, time: f64) -> Vector {
        let height = if time < 0.3 { 0.01 } else { -0.0055 + 0.004 * (TAU * 1.5 * time).cos() };
        [0.01 * (TAU * 0.4 * time).sin(), 0.0, height]
    }

    fn velocity(&self, time: f64) -> Vector {
        [0.01 * TAU * 0.4 * (TAU * 0.4 * time).cos(), 0.0, -0.004 * TAU * 1.5 * (TAU * 1.5 * time).sin()]
    }
}

fn random() -> impl FnMut() -> f32 {
    let mut seed = 1_u32;
    move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    }
}

/// How much of the bound the largest steps of force and duty were.
#[derive(Debug, Default)]
struct Tally {
    force: f32,
    duty: f32,
    /// The largest step of force that a ramp added, N.
    step: f32,
    refused: u32,
    touching: u32,
}

/// A hundred random requests under a pressed hand. The step that a ramp adds is the difference to a tick from the same
/// state with the gains of the tick before. `at_once` builds a loop with new gains, which then have no ramp.
fn tallied<G: Guard<3>>(
    tunable: &Loop3<G>,
    most_ticks_between: f32,
    at_once: Option<&dyn Fn(Tuning) -> Plain<G>>,
) -> Tally {
    let rendering = tunable.servo().config().rendering;
    let sticks = 1.0 + rendering.friction.map_or(0.0, |friction| friction.static_coefficient);
    let (mut draw, mut plant, mut state) = (random(), plant(Pressing), tunable.start());
    let mut tally = Tally::default();
    let (mut changes, mut next, mut requests) = ([0.0; 3], 6_000, 0);
    let (mut tick, mut servo) = (0, *tunable.servo());
    while requests < 100 {
        if tick == next {
            let gains = |tuning: Tuning| {
                let force = tuning.max_force_n.min(DEVICE.max_force_n);
                [tuning.stiffness_n_per_m, tuning.damping_n_s_per_m, force]
            };
            let asked = Tuning {
                stiffness_n_per_m: draw() * 1.2 * DEVICE.max_stiffness_n_per_m,
                damping_n_s_per_m: draw() * 1.2 * DEVICE.max_damping_n_s_per_m,
                max_force_n: draw() * 3.0 * DEVICE.max_force_n,
            };
            let now = gains(Tuning::of(servo.settings()));
            match state.request(asked) {
                Ok(()) => changes = std::array::from_fn(|gain| (gains(asked)[gain] - now[gain]).abs() / RAMP as f32),
                Err(_) => tally.refused += 1,
            }
            next += 1 + (draw() * most_ticks_between) as usize;
            requests += 1;
        }
        let input = Input::Sensors { counts: plant.counts().map(Counts), enable: true };
        let mut as_before: ServoState<3, _, _> = *state;
        let _ = servo.tick(&mut as_before, input);
        if let Some(build) = at_once {
            servo = build(state.target());
            let _ = servo.tick(&mut state, input);
        } else {
            let _ = tunable.tick(&mut state, input);
            servo = *state.servo();
        }
        assert_eq!((state.fault(), state.phase()), (None, as_before.phase()));
        // The depth of release falls at once, too.
        assert!(state.contacts_lost() == 0 || at_once.is_some());
        assert!(state.force().length() <= DEVICE.max_force_n * 1.000_001);
        assert!(state.fade() == as_before.fade());
        tally.touching += u32::from(state.contact() == Contact::Touching);
        let (depth, speed) = ((-state.gap()).max(0.0), state.tool().velocity.length());
        let [stiffness, damping, force] = changes;
        let onset = rendering.ease.map_or(0.0, |Ease { onset_n, .. }| DEVICE.max_damping_n_s_per_m * speed / onset_n);
        let bound = sticks * (stiffness * depth * (1.0 + onset) + damping * speed).max(force);
        let step = (state.force() - as_before.force()).length();
        // Roundings of 5 N, and the inverse root's.
        tally.force = tally.force.max((step - 5e-5) / bound.max(1e-9));
        tally.step = tally.step.max(step);
        let columns = DEVICE.kinematics.pose(state.angles()).unwrap().jacobian;
        for joint in 0..3 {
            let [after, before] = [state.duties(), as_before.duties()].map(|duties| f32::from(duties[joint].0));
            let full = DEVICE.motors[joint].torque_at_full_n_m.abs();
            let bound = bound * columns[joint].length() / full * 32_767.0;
            // Each is rounded to a step.
            tally.duty = tally.duty.max(((after - before).abs() - 1.0) / bound.max(1e-9));
        }
        plant.advance(state.duties().map(|duty| duty.0));
        tick += 1;
    }
    tally
}

#[test]
fn no_request_is_a_step_to_a_hand_that_presses() {
    const FRICTION: Friction = Friction {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 0.4,
        // Slipping is a step of its own.
        dynamic_coefficient: 0.4,
    };
    let start = Tuning::of(&SETTINGS);
    let check = |name: &str, tally: Tally| {
        println!("{name}: {tally:?}");
        assert!(tally.force <= 1.0 && tally.duty <= 1.0, "{name}: {tally:?}");
        assert!(tally.refused > 10 && tally.refused < 60 && tally.touching > 10_000 && tally.step > 2e-3, "{tally:?}");
    };
    // Mostly in the middle of the ramp before, and mostly at rest.
    for (name, rendering, between) in [
        ("plain", Rendering::PLAIN, 500.0),
        ("plain, rare", Rendering::PLAIN, 1_500.0),
        ("eased", Rendering::EASED, 500.0),
        ("smooth", Rendering::SMOOTH, 500.0),
        ("rough", Rendering { friction: Some(FRICTION), ..Rendering::PLAIN }, 500.0),
    ] {
        let servo = Servo::new(&DEVICE, &WALL, config(rendering, start));
        check(name, tallied(&Tunable::new(servo), between, None));
    }
    let plain = |tuning| Servo::new(&DEVICE, &WALL, config(Rendering::PLAIN, tuning));
    let at_once = tallied(&Tunable::new(plain(start)), 500.0, Some(&plain));
    println!("at once: {at_once:?}");
    assert!(at_once.force > 50.0 && at_once.duty > 50.0, "gains that change at once must be seen: {at_once:?}");
    let guarded = Servo::protected(&DEVICE, &WALL, PROTECTION, config(Rendering::SMOOTH, start));
    check("protected", tallied(&Tunable::new(guarded), 500.0, None));
}

#[test]
fn after_the_ramp_each_bit_is_that_of_a_loop_built_with_the_new_gains() {
    let asked = Tuning { stiffness_n_per_m: 550.0, damping_n_s_per_m: 2.0, max_force_n: 3.0 };
    let tunable = Tunable::new(Servo::new(&DEVICE, &WALL, config(Rendering::SMOOTH, Tuning::of(&SETTINGS))));
    let built = Servo::new(&DEVICE, &WALL, config(Rendering::SMOOTH, asked));
    let (mut plant, mut state) = (plant(Pressing), tunable.start());
    let mut tick = |state: &mut State<Loop3<Unguarded>>, other: Option<&mut ServoState<3>>| {
        let input = Input::Sensors { counts: plant.counts().map(Counts), enable: true };
        let output = tunable.tick(state, input);
        if let Some(other) = other {
            assert_eq!(built.tick(other, input), output);
        }
        plant.advance(state.duties().map(|duty| duty.0));
    };
    for _ in 0..4_000 {
        tick(&mut state, None);
    }
    state.request(asked).unwrap();
    for _ in 0..RAMP {
        assert!(!state.is_settled());
        tick(&mut state, None);
    }
    assert!(state.is_settled() && state.contact() == Contact::Touching);
    let mut other = *state;
    for _ in 0..8_000 {
        tick(&mut state, Some(&mut other));
        assert_eq!((*state, state.digest()), (other, other.digest()));
    }
}

/// Comes from the front, rests deep in a soft wall, leaves it after 2 s, and comes back.
struct Deep;

impl HandPath for Deep {
    fn target(&self, time: f64) -> Vector {
        [0.0, 0.0, if time < 0.1 || (2.0..3.0).contains(&time) { 0.01 } else { -0.02 }]
    }

    fn velocity(&self, time: f64) -> Vector {
        StillHand(self.target(time)).velocity(time)
    }
}

#[test]
fn a_hand_that_rests_deep_keeps_its_contact_until_it_leaves() {
    // 33 mm until contact is released, and 10 mm in the stiff wall: the hand is at 17 mm.
    let soft = Tuning { stiffness_n_per_m: 60.0, damping_n_s_per_m: 1.0, max_force_n: 1.0 };
    let stiff = Tuning { stiffness_n_per_m: 600.0, ..soft };
    let tunable = Tunable::new(Servo::new(&DEVICE, &WALL, config(Rendering::PLAIN, soft)));
    let (mut plant, mut state) = (plant(Deep), tunable.start());
    let (mut last, mut depth) = (0.0, 0.0_f32);
    for tick in 0..16_000 {
        if tick == 2_000 {
            state.request(stiff).unwrap();
        }
        let _ = tunable.tick(&mut state, Input::Sensors { counts: plant.counts().map(Counts), enable: true });
        plant.advance(state.duties().map(|duty| duty.0));
        if (2_000..8_000).contains(&tick) {
            let force = state.force().length();
            assert!((force - last).abs() < 0.02 && state.contact() == Contact::Touching, "{tick}: {last} {force}");
            depth = depth.max(-state.gap());
        }
        if tick < 12_000 {
            assert_eq!(state.contacts_lost(), 0, "{tick}");
        }
        last = state.force().length();
    }
    assert!(depth > 0.015 && state.is_settled(), "{depth}");
    // As a loop that was built so.
    assert_eq!((state.contacts_lost(), state.fault()), (1, None));
}
