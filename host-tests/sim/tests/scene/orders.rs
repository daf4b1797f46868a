//! What a host orders while it is felt.

use crate::common::{LIMITS, MATERIAL, PERIOD, RATE, Random, double, part, single};
use glam::{DQuat, DVec3};
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::scene::Commanded;
use palpate::scene::{BodyPose, Command, HOLD, Motion, Part, Path, Scene, SceneError};
use palpate::servo::Surface;
use palpate::track::{Contact, Controller, Placement, Probe};

const ORDERS: u32 = 100_000;

fn pose(position: DVec3, orientation: DQuat) -> BodyPose {
    BodyPose { position: single(position).to_array(), orientation: orientation.as_quat().to_array() }
}

/// A number that a host might send: mostly sensible, now and then not.
fn number(random: &mut Random, low: f64, high: f64) -> f32 {
    match random.below(40) {
        0 => f32::NAN,
        1 => f32::INFINITY,
        2 => -1e30,
        _ => random.between(low, high) as f32,
    }
}

fn numbers(random: &mut Random, size: f64) -> [f32; 3] {
    [0; 3].map(|_| number(random, -size, size))
}

/// Any order, of its kinds each as often.
fn any_order(random: &mut Random) -> Command {
    let body = random.below(4) as u8;
    let orientation = DQuat::from_axis_angle(random.direction(), random.between(0.0, 0.05));
    let at = DVec3::new(-0.03, -0.02, -0.033) + random.vector(0.003);
    let mut pose = pose(at, orientation);
    if random.below(20) == 0 {
        pose.orientation[random.below(4)] = number(random, -1.0, 1.0);
    }
    let (velocity, angular_velocity) = (numbers(random, 0.05), numbers(random, 0.5));
    let seconds = number(random, 0.0, 0.02);
    match random.below(10) {
        0 => Command::Place { body, pose },
        1 => Command::Lead { body, pose, velocity, angular_velocity, seconds },
        2 => Command::Move { body, velocity, angular_velocity, seconds },
        3 => Command::Switch { groups: random.below(8) as u32 },
        4 => Command::Choose { index: random.below(40) as u8 },
        5 => Command::Harden { body, stiffness: number(random, 0.0, 900.0), damping: number(random, 0.0, 3.0) },
        6 => {
            let friction = [0.0, 600.0, 1.0, 0.4, 0.3];
            let scale = number(random, 0.0, 1.2);
            let numbers = [friction[1] * scale, friction[2], friction[3], friction[4] * scale];
            Command::Rub { body, friction: (random.below(3) > 0).then_some(numbers) }
        }
        7 => Command::Tip { radius: number(random, 0.0, 0.004) },
        8 => Command::Limit { force: number(random, 0.5, 5.0) },
        _ => Command::Push { force: numbers(random, 2.0) },
    }
}

/// Three bodies that rest where the tool is, one a group.
fn scene() -> Scene<'static, Body<'static>, 3> {
    let place = |x: f32| Placement { origin: Vec3::new(-0.03 + x, -0.02, -0.033), ..Placement::IDENTITY };
    let mut parts = [0.0, 0.01, -0.01].map(|x| part(Motion::Resting(place(x)), MATERIAL));
    for (index, part) in parts.iter_mut().enumerate() {
        part.group = index as u8;
    }
    Scene::new(LIMITS, parts)
}

/// Whatever is ordered, at whatever instant: what changes a body leaves the force where it was, a force or a limit of
/// the host's leaves it where it would have been without it, but for what is let go of in a tick of the bodies' force,
/// the host's and the limit. What is refused changes nothing.
#[test]
fn no_order_steps_the_force() {
    let mut random = Random::new(17);
    let scene = scene();
    let mut state = scene.rest();
    let (mut given, mut refused, mut touched, mut felt) = (0, 0, 0, 0);
    let (mut worst, mut last) = (0.0_f64, DVec3::ZERO);
    let mut probe = DVec3::new(0.0, 0.0, 0.02);
    let (mut tick, mut until) = (0_u32, 2_000);
    while given < ORDERS {
        tick += 1;
        let phase = f64::from(tick % 600) / 600.0;
        let depth = 0.008 - 0.012 * (1.0 - (phase * core::f64::consts::TAU).cos()) * 0.5;
        let step = depth - probe.z;
        probe.z += step;
        let velocity = DVec3::new(0.0, 0.0, step / f64::from(PERIOD));
        let seen = Probe { position: single(probe), velocity: single(velocity) };
        let mut expected = None;
        if tick > until {
            until = tick + random.below(20) as u32;
            let order = any_order(&mut random);
            let before = state;
            given += 1;
            expected = match order {
                Command::Push { .. } | Command::Limit { .. } => {
                    let mut without = before;
                    scene.follow(&Controller::SecondOrder, &mut without, seen, PERIOD);
                    Some(double(without.force()))
                }
                _ => Some(last),
            };
            if scene.apply(&mut state, &order).is_err() {
                refused += 1;
                // By every bit: what is not a number differs from itself.
                assert_eq!(words(&state), words(&before), "{order:?}");
            }
            if words(&state) == words(&before) {
                // Refused, or as it was: the force goes on as it would have.
                expected = None;
            }
            felt += u32::from(last.length() > 0.0);
        }
        scene.follow(&Controller::SecondOrder, &mut state, seen, PERIOD);
        let force = double(state.force());
        assert!(force.is_finite(), "{force}");
        touched += u32::from(state.part(state.felt()).unwrap().contact() == Contact::Touching);
        if let Some(expected) = expected {
            worst = worst.max((force - expected).length());
        }
        last = force;
    }
    let limit = 3.0 * f64::from(LIMITS.release_n_per_s * PERIOD);
    println!(
        "{given} orders, {refused} refused, {felt} while a force was felt, touched {touched} of {tick} ticks: {worst:.4} \
         N a tick, of {limit:.4} N of bodies, host and limit together"
    );
    // Rounding of forces up to 10 N.
    assert!(worst <= limit + 2e-6, "{worst}");
    assert!(touched > tick / 25 && refused > given / 20 && refused < given / 2 && felt > given / 4);
}

fn words(state: &impl palpate::servo::Tracked) -> Vec<u32> {
    let mut words = Vec::new();
    state.for_each_word(|word| words.push(word));
    words
}

/// A body that moves along: its origin on a straight line, turning about it, and at rest once its time is over.
#[test]
fn a_body_moves_along_as_it_was_told() {
    let mut random = Random::new(5);
    let scene = scene();
    let mut worst = [0.0_f64; 2];
    for _ in 0..20 {
        let mut state = scene.rest();
        let (from, turned) = (random.vector(0.1), DQuat::from_axis_angle(random.direction(), random.between(0.0, 3.0)));
        let (velocity, spin) = (random.vector(0.05), random.vector(3.0));
        let seconds = random.between(0.5, 3.0);
        let order = Command::Place { body: 1, pose: pose(from, turned) };
        scene.apply(&mut state, &order).unwrap();
        let order = Command::Move {
            body: 1,
            velocity: single(velocity).to_array(),
            angular_velocity: single(spin).to_array(),
            seconds: seconds as f32,
        };
        scene.apply(&mut state, &order).unwrap();
        for _ in 0..(4.0 * RATE) as u32 {
            scene.follow(&Controller::SecondOrder, &mut state, Probe::at(Vec3::ZERO), PERIOD);
        }
        let placement = state.part(1).unwrap().placement();
        let passed = (seconds * f64::from(RATE)).floor() / f64::from(RATE);
        let wanted = DQuat::from_axis_angle(spin.normalize(), spin.length() * passed) * turned;
        let off = (double(placement.origin) - (from + velocity * passed)).length();
        let turned_off = (double(placement.axes[0]) - wanted * DVec3::X).length();
        worst = [worst[0].max(off), worst[1].max(turned_off)];
        assert_eq!((placement.velocity, placement.angular_velocity), (Vec3::ZERO, Vec3::ZERO));
    }
    println!("moved along for up to 3 s: off by {:.1e} m and {:.1e} rad at most", worst[0], worst[1]);
    // Half a unit in the last place of 0.25 m, and of 1, in each of 12,000 steps, all one way; the Cayley turn of a
    // tick is short by a twelfth of the cube of its angle, 1.3 mrad at most: 2e-10 of it a tick.
    assert!(worst[0] < 12_000.0 * 1.5e-8 && worst[1] < 12_000.0 * (6e-8 + 2e-10), "{worst:?}");
}

#[test]
fn a_force_of_the_host_s_fades_when_it_is_no_longer_asked_for() {
    let scene = scene();
    let mut state = scene.rest();
    let follow = |state: &mut _, ticks: u32| {
        for _ in 0..ticks {
            scene.follow(&Controller::SecondOrder, state, Probe::at(Vec3::new(0.0, 0.0, 0.2)), PERIOD);
        }
        state.force()
    };
    let push = Command::Push { force: [0.0, 2.0, 0.0] };
    scene.apply(&mut state, &push).unwrap();
    // 2 N at 100 N/s.
    let up = (2.0 / LIMITS.release_n_per_s * RATE) as u32 + 1;
    assert_eq!(follow(&mut state, up), Vec3::new(0.0, 2.0, 0.0));
    assert_eq!(follow(&mut state, (HOLD * RATE) as u32 + up), Vec3::ZERO);
    // Asked for again and again it stays.
    for _ in 0..100 {
        scene.apply(&mut state, &push).unwrap();
        follow(&mut state, (HOLD * RATE) as u32);
    }
    assert_eq!(state.force(), Vec3::new(0.0, 2.0, 0.0));
}

#[test]
fn what_cannot_be_is_refused_by_its_reason() {
    let moving = Path::new(Placement::IDENTITY).turning(Vec3::Z, Vec3::ZERO, 1.0, RATE);
    let resting = part(Motion::Resting(Placement::IDENTITY), MATERIAL);
    let parts = [resting, Part { motion: Motion::Prescribed(moving), ..resting }];
    let scene = Scene::new(LIMITS, parts);
    let mut state = scene.rest();
    let straight = BodyPose { position: [0.0; 3], orientation: [0.0, 0.0, 0.0, 1.0] };
    let (velocity, angular_velocity, seconds) = ([0.0; 3], [0.0; 3], 1.0);
    let before = words(&state);
    for (order, error) in [
        (Command::Place { body: 2, pose: straight }, SceneError::Missing(2)),
        (Command::Place { body: 1, pose: straight }, SceneError::Placement(1)),
        (
            Command::Place { body: 0, pose: BodyPose { orientation: [0.0, 0.0, 0.0, 1.1], ..straight } },
            SceneError::Placement(0),
        ),
        (Command::Place { body: 0, pose: BodyPose { position: [f32::NAN; 3], ..straight } }, SceneError::Placement(0)),
        (Command::Move { body: 0, velocity: [0.0, 2.1, 0.0], angular_velocity, seconds }, SceneError::TooFast(0)),
        (Command::Move { body: 0, velocity, angular_velocity, seconds: -1.0 }, SceneError::Placement(0)),
        (Command::Move { body: 1, velocity, angular_velocity, seconds }, SceneError::Placement(1)),
        (
            Command::Lead { body: 0, pose: straight, velocity: [f32::NAN; 3], angular_velocity, seconds },
            SceneError::Placement(0),
        ),
        // Two at once push with both: 600 beside it.
        (
            Command::Harden { body: 0, stiffness: 1_401.0, damping: 1.0 },
            SceneError::TooStiff { body: 0, max_n_per_m: 1_400.0 },
        ),
        (Command::Rub { body: 0, friction: Some([500.0, 1.0, 0.2, 0.3]) }, SceneError::Friction(0)),
        (Command::Tip { radius: -1.0 }, SceneError::TipRadius),
        (Command::Choose { index: 32 }, SceneError::Group(32)),
        (Command::Limit { force: 5.1 }, SceneError::Force),
        (Command::Push { force: [0.0, 0.0, 5.1] }, SceneError::Force),
        (Command::Take { body: 0 }, SceneError::NotOffered),
    ] {
        assert_eq!(scene.apply(&mut state, &order), Err(error), "{order:?}");
        assert_eq!(words(&state), before, "{order:?}");
    }
    // Hardened one after the other they are still within it together.
    let harden = |body, stiffness| Command::Harden { body, stiffness, damping: 1.0 };
    assert_eq!(scene.apply(&mut state, &harden(0, 1_400.0)), Ok(()));
    assert_eq!(scene.apply(&mut state, &harden(1, 601.0)), Err(SceneError::TooStiff { body: 1, max_n_per_m: 600.0 }));
    assert_eq!(scene.apply(&mut state, &harden(1, 600.0)), Ok(()));
}
