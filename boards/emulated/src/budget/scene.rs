//! The servo tick over scenes of the capped box: at rest, on a path, free, two at once, four and sixteen.

use core::hint::black_box;

use palpate::body::Body;
use palpate::math::{Vec3, vec3};
use palpate::scene::{Limits, Material, Motion, Part, Path, RigidBody, Scene, Sphere, Tether};
use palpate::servo::{Config, Event, Input, Safety, Servo, ServoState, Surface};
use palpate::track::{Contact, Controller, Placement};

use super::closest::probe;
use super::servo::{APPROACH, Walk};
use super::tables::CAPPED_BOX;
use super::tally::Tally;
use crate::body::{DEVICE, Mechanism, SETTINGS};
use crate::timer::InstructionCounter;

/// Ticks of each path.
const TICKS: u32 = 50_000;
const RATE: f32 = SETTINGS.rate_hz;
const MATERIAL: Material = Material::new(300.0, 1.0);
const LIMITS: Limits = Limits::of(&DEVICE, RATE);
/// The middle of the box, in its frame, and the ball that holds it.
const MIDDLE: Vec3 = vec3(0.03, 0.02, 0.017);
const SPHERE: Sphere = Sphere { centre_m: MIDDLE, radius_m: 0.04 };

const fn part(motion: Motion) -> Part<'static, Body<'static>> {
    Part { sphere: SPHERE, ..Part::new(&CAPPED_BOX, motion, MATERIAL) }
}

const fn at(x: f32, y: f32, z: f32) -> Placement {
    Placement { origin: vec3(x, y, z), ..Placement::IDENTITY }
}

/// About an upright axis through the middle of a box, 0.5 rad/s.
const fn turning(start: Placement, pivot: Vec3) -> Motion {
    Motion::Prescribed(Path::new(start).turning(Vec3::Z, pivot, 0.5, RATE))
}

/// 200 g on a spring in the air.
const fn free() -> Motion {
    let tether = Tether { anchor_m: MIDDLE, slack_m: Vec3::ZERO, stiffness_n_per_m: 400.0, damping_n_s_per_m: 2.0 };
    let body = RigidBody::new(Placement::IDENTITY, 0.2, vec3(4.2e-5, 7.5e-5, 8.7e-5));
    Motion::Free(RigidBody {
        centre_m: MIDDLE,
        gravity_m_per_s2: vec3(0.0, 0.0, -9.81),
        angular_stiffness_n_m_per_rad: 1.0,
        angular_damping_n_m_s_per_rad: 1e-3,
        tether: Some(tether),
        ..body
    })
}

/// Boxes on a square grid, 20 mm apart, each turning about the middle of all.
const fn row<const N: usize>() -> [Part<'static, Body<'static>>; N] {
    let mut parts = [part(Motion::Resting(Placement::IDENTITY)); N];
    let mut index = 0;
    while index < N {
        let (x, y) = ((index % 4) as f32 * 0.02 - 0.03, (index / 4) as f32 * 0.02 - 0.03);
        parts[index] = part(turning(at(x, y, 0.0), MIDDLE));
        index += 1;
    }
    parts
}

/// The scene of this image: one, for loops in one image share code that each alone has for itself.
mod chosen {
    use super::{MIDDLE, Motion, Part, Placement, at, free, part, row, turning};
    use palpate::body::Body;

    pub const COUNT: usize = if cfg!(feature = "scene-sixteen") {
        16
    } else if cfg!(feature = "scene-four") {
        4
    } else if cfg!(feature = "scene-two") {
        2
    } else {
        1
    };

    pub const NAME: &str = if cfg!(feature = "scene-sixteen") {
        "servo tick, a scene of 16 bodies on paths"
    } else if cfg!(feature = "scene-four") {
        "servo tick, a scene of 4 bodies on paths"
    } else if cfg!(feature = "scene-two") {
        "servo tick, a scene of two bodies on paths"
    } else if cfg!(feature = "scene-free") {
        "servo tick, a scene of one free body"
    } else if cfg!(feature = "scene-path") {
        "servo tick, a scene of one body on a path"
    } else {
        "servo tick, a scene of one body at rest"
    };

    pub const PARTS: [Part<'static, Body<'static>>; COUNT] = {
        let mut parts = row();
        if COUNT == 2 {
            // One in the other, a little off.
            parts = [part(turning(Placement::IDENTITY, MIDDLE)); COUNT];
            parts[1 % COUNT] = part(turning(at(0.004, 0.003, 0.002), MIDDLE));
        } else if cfg!(feature = "scene-free") {
            parts = [part(free()); COUNT];
        } else if cfg!(feature = "scene-path") {
            parts = [part(turning(Placement::IDENTITY, MIDDLE)); COUNT];
        } else if COUNT == 1 {
            parts = [part(Motion::Resting(Placement::IDENTITY)); COUNT];
        }
        parts
    };
}

use chosen::{COUNT, NAME, PARTS};

static SCENE: Scene<Body, COUNT> = Scene::new(LIMITS, PARTS);

type Loop = Servo<'static, Scene<'static, Body<'static>, COUNT>, Mechanism, 3>;
type State = ServoState<3, <Scene<'static, Body<'static>, COUNT> as Surface>::Witness>;

/// The path leads right through, deeper than any hand presses: nothing ends contact.
static SERVO: Loop = Servo::new(
    &DEVICE,
    &SCENE,
    Config { settings: SETTINGS, safety: Safety { contact: None, ..Safety::DEFAULT }, ..Config::DEFAULT },
);

#[inline(never)]
fn tick(state: &mut State, input: Input<3>) {
    let _ = SERVO.tick(state, input);
}

/// Counts the ticks of the image's scene.
///
/// # Errors
/// A fault on the path, or too little contact.
pub fn run(counter: &mut InstructionCounter) -> Result<(), &'static str> {
    let mut state = SERVO.start();
    let mut walk = Walk::start();
    for _ in 0..APPROACH {
        walk.counts(probe(0) + SETTINGS.body_origin_m);
    }
    let (mut ticks, mut both, mut touched) = (Tally::new(), Tally::new(), 0);
    for index in 0..TICKS {
        let position = probe(index) + SETTINGS.body_origin_m;
        let input = black_box(Input::Sensors { counts: walk.counts(position), enable: true });
        SERVO.note(&mut state, Event::LinkAlive);
        let ((), instructions) = counter.count(|| tick(&mut state, input));
        ticks.add(instructions);
        touched += u32::from(state.contact() == Contact::Touching);
        let scene = state.witness();
        let touches = |index: usize| scene.part(index).is_some_and(|part| part.contact() == Contact::Touching);
        if scene.tracked().into_iter().all(touches) {
            both.add(instructions);
        }
    }
    ticks.print(NAME);
    both.print_as(NAME, "two touched");
    if state.fault().is_some() {
        return Err("the servo found a fault on its path");
    }
    if touched < TICKS / 100 { Err("the path hardly touches the scene") } else { Ok(()) }
}
