//! The books of free bodies: energy and momentum, over a million ticks.

use crate::common::{LIMITS, MIDDLE, PERIOD, Random, double, part, single};
use glam::DVec3;
use palpate::math::{Vec3, vec3};
use palpate::scene::{Joint, Material, Motion, RigidBody, Scene, Tether, Wrench};
use palpate::servo::Surface;
use palpate::track::{Contact, Controller, Placement, Probe};

const TICKS: u32 = 1_000_000;

/// The box as a block of 100 g: 60 × 40 × 30 mm, centre of mass in its middle.
fn block(start: Placement) -> RigidBody {
    let (a, b, c) = (0.06_f32, 0.04_f32, 0.03_f32);
    let mass = 0.1;
    let inertia = vec3(b * b + c * c, a * a + c * c, a * a + b * b) * (mass / 12.0);
    RigidBody { centre_m: single(MIDDLE), ..RigidBody::new(start, mass, inertia) }
}

fn moving(velocity: Vec3, angular_velocity: Vec3) -> Placement {
    Placement { velocity, angular_velocity, ..Placement::IDENTITY }
}

/// What a free body has after so many ticks under these pushes, and what the books say that it may.
struct Books {
    /// The most that its energy was above what came in, J.
    excess: f64,
    /// The same of the momentum: what it is apart from what came in, kg·m/s.
    momentum: f64,
    /// Its energy at the end, of that at the start and what came in.
    left: f64,
}

/// `push` gives the force in the world, and where on the body it acts, from the centre of mass.
fn keep(body: &RigidBody, ticks: u32, mut push: impl FnMut(u32, &palpate::scene::Moving) -> (Vec3, Vec3)) -> Books {
    let mut state = body.rest();
    let mut placement = body.placement(&state);
    let mut came_in = f64::from(body.energy(&state));
    let mut momentum = double(state.velocity()) * f64::from(body.mass_kg);
    let mut books = Books { excess: f64::NEG_INFINITY, momentum: 0.0, left: 0.0 };
    for tick in 0..ticks {
        let (force, arm) = push(tick, &state);
        let wrench = Wrench { force, torque: arm.cross(force) };
        let before = double(placement.direction_to_b(arm));
        let at = double(state.position()) + double(arm);
        body.step(&mut state, &wrench, PERIOD);
        let next = body.placement(&state);
        // Where the point of the body that was pushed is now.
        let [a, b, c] = next.axes.map(double);
        let now = double(state.position()) + a * before.x + b * before.y + c * before.z;
        came_in += double(force).dot(now - at);
        momentum += (double(force) + double(body.gravity_m_per_s2) * f64::from(body.mass_kg)) * f64::from(PERIOD);
        placement = next;
        let energy = f64::from(body.energy(&state));
        books.excess = books.excess.max(energy - came_in);
        let off = double(state.velocity()) * f64::from(body.mass_kg) - momentum;
        books.momentum = books.momentum.max(off.length());
        books.left = energy / came_in;
    }
    books
}

#[test]
fn thrown_and_spun_without_anything_else_it_keeps_what_it_has() {
    let body = block(moving(vec3(0.3, -0.2, 0.1), vec3(4.0, -7.0, 5.0)));
    let mut state = body.rest();
    let (energy, spin) = (f64::from(body.energy(&state)), double(state.momentum()));
    for _ in 0..TICKS {
        body.step(&mut state, &Wrench::default(), PERIOD);
    }
    let (left, turned) =
        (f64::from(body.energy(&state)) / energy, (double(state.momentum()) - spin).length() / spin.length());
    println!("spun: energy {left:.7} of what it was, momentum off by {turned:.1e} of itself");
    assert!(left <= 1.0 + 1e-6, "{left}");
    // A rounding a tick at random, 3e-8 of it, and what is scaled down where the third order would raise the energy.
    assert!(left > 0.99 && turned < 1e-2, "{left} {turned}");
    let placement = body.placement(&state);
    let orthonormal = placement.axes[0].dot(placement.axes[1]).abs() + (placement.axes[2].length() - 1.0).abs();
    assert!(orthonormal < 1e-6, "{orthonormal}");
}

/// What comes in is the work of the pushes. A tick's quantum is what single precision cannot say: the position is
/// rounded by up to 4 nm below 63 mm, which the greatest spring force turns into energy; a million of them at random.
fn is_passive(name: &str, body: &RigidBody, seed: u64, strength: f64) {
    let mut random = Random::new(seed);
    let mut force = DVec3::ZERO;
    let mut greatest = 0.0_f64;
    let books = keep(body, TICKS, |tick, state| {
        if tick % 400 == 0 {
            // Shoved, and let go.
            force = if tick % 800 == 0 { random.direction() * strength } else { DVec3::ZERO };
        }
        greatest = greatest.max(f64::from(body.energy(state)));
        (single(force), vec3(0.02, -0.01, 0.01))
    });
    let pull = body.tether.map_or(0.0, |tether| (2.0 * f64::from(tether.stiffness_n_per_m) * greatest).sqrt());
    let quantum = pull * 4e-9 + greatest * 1.2e-7;
    println!(
        "{name}: energy above what came in by at most {:.1e} J of {greatest:.2e} ({:.1} quanta), at the end {:.3} of it",
        books.excess,
        books.excess / quantum,
        books.left
    );
    assert!(books.excess <= 2.0 * f64::from(TICKS).sqrt() * quantum, "{name}: {} of {greatest}", books.excess);
}

#[test]
fn shoved_at_random_no_body_gives_more_than_it_was_given() {
    let start = moving(Vec3::ZERO, vec3(1.0, 2.0, 3.0));
    // The air takes what turns it beyond some 20 rad/s.
    let block = |start| RigidBody { angular_damping_n_m_s_per_rad: 5e-4, ..block(start) };
    let room = Tether {
        anchor_m: vec3(0.03, 0.02, 0.015),
        slack_m: Vec3::splat(0.05),
        stiffness_n_per_m: 2_000.0,
        damping_n_s_per_m: 0.0,
    };
    let spring = Tether { slack_m: Vec3::ZERO, stiffness_n_per_m: 300.0, ..room };
    let free = RigidBody { damping_n_s_per_m: 0.05, ..block(start) };
    is_passive("free", &free, 1, 0.5);
    is_passive(
        "in a room",
        &RigidBody { tether: Some(room), gravity_m_per_s2: vec3(0.0, 0.0, -9.81), ..block(start) },
        2,
        0.5,
    );
    is_passive(
        "on a spring",
        &RigidBody { tether: Some(spring), angular_stiffness_n_m_per_rad: 0.05, ..block(start) },
        3,
        0.5,
    );
    // Far stiffer than a tick can follow: √(10⁶/0.1) rad/s is 0.8 rad a tick.
    let stiff = Tether { stiffness_n_per_m: 1e6, ..spring };
    is_passive("on a stiff spring", &RigidBody { tether: Some(stiff), ..block(start) }, 4, 0.5);
    let axis = vec3(0.48, 0.6, 0.64);
    is_passive("slider", &RigidBody { joint: Joint::Slider(axis), tether: Some(spring), ..block(start) }, 5, 0.5);
    let hinge = Joint::Hinge { axis, pivot: vec3(0.0, 0.01, 0.05) };
    is_passive("hinge", &RigidBody { joint: hinge, gravity_m_per_s2: vec3(0.0, 0.0, -9.81), ..block(start) }, 6, 0.2);
}

#[test]
fn momentum_is_what_the_pushes_gave() {
    let body = RigidBody { gravity_m_per_s2: vec3(0.0, 0.0, -9.81), ..block(moving(Vec3::ZERO, Vec3::ZERO)) };
    let mut random = Random::new(7);
    let books = keep(&body, TICKS, |_, state| {
        // What keeps it from falling for ever, and a shove.
        let back = state.position() * -2.0 - state.velocity() * 0.1 + vec3(0.0, 0.0, 0.981);
        (back + single(random.vector(0.2)), Vec3::ZERO)
    });
    // A rounding of some 0.1 kg·m/s a tick: a million of 4e-9 at random are 4e-6.
    println!("momentum apart from what came in by at most {:.1e} kg·m/s", books.momentum);
    assert!(books.momentum < 5e-5, "{}", books.momentum);
}

/// The stylus presses the block into the corner of its room, lets go, and comes back, at every stiffness that is
/// allowed.
#[test]
fn pressed_into_a_corner_it_neither_drifts_nor_explodes() {
    let start = Placement { origin: single(-MIDDLE), ..Placement::IDENTITY };
    let room =
        Tether { anchor_m: Vec3::ZERO, slack_m: Vec3::splat(0.005), stiffness_n_per_m: 500.0, damping_n_s_per_m: 0.2 };
    for (stiffness, damping) in [(200.0, 0.5), (600.0, 1.0), (1_500.0, 2.0)] {
        let body = RigidBody {
            tether: Some(room),
            angular_stiffness_n_m_per_rad: 0.2,
            angular_damping_n_m_s_per_rad: 1e-4,
            ..block(start)
        };
        let part = part(Motion::Free(body), Material::new(stiffness, damping));
        let scene = Scene::try_new(LIMITS, [part]).unwrap();
        let mut state = scene.rest();
        let (mut most, mut touched, mut given, mut last) = (0.0_f64, 0, 0.0, DVec3::ZERO);
        let mut force = DVec3::ZERO;
        for tick in 0..TICKS {
            // Down on a corner of the top, 8 mm deep, and up again, twice a second.
            let phase = f64::from(tick) * f64::from(PERIOD) * 4.0 * core::f64::consts::PI;
            let probe = DVec3::new(0.004, 0.003, 0.022 - 0.012 * phase.sin());
            given += force.dot(probe - last);
            last = probe;
            let velocity = DVec3::new(0.0, 0.0, -0.012 * phase.cos() * 4.0 * core::f64::consts::PI);
            let seen = Probe { position: single(probe), velocity: single(velocity) };
            scene.follow(&Controller::SecondOrder, &mut state, seen, PERIOD);
            force = double(state.force());
            let part = state.part(0).unwrap();
            touched += u32::from(part.contact() == Contact::Touching);
            most = most.max(f64::from(body.energy(part.moving())));
        }
        let part = state.part(0).unwrap();
        let off = double(part.moving().position()).length();
        println!(
            "{stiffness} N/m: touched {touched} ticks, energy at most {most:.1e} J, off by {:.1} mm, gave {given:.1e} J",
            off * 1e3
        );
        assert!(touched > TICKS / 20, "{touched}");
        // A room of 5 mm, and what 5 N do to its walls: 10 mm.
        assert!(off < 0.03 && most < 0.1, "{off} {most}");
        // The hand is never given more than it gave: but for what a cycle's end leaves in spring and block.
        assert!(given < 2e-3, "{given}");
    }
}

#[test]
fn a_block_too_light_for_its_stiffness_is_refused() {
    use palpate::scene::SceneError;
    let light = RigidBody { mass_kg: 1e-5, ..block(Placement::IDENTITY) };
    let part = part(Motion::Free(light), Material::new(600.0, 1.0));
    assert_eq!(Scene::try_new(LIMITS, [part]).unwrap_err(), SceneError::Light(0));
}

/// The damper that a spring pulled at a tick's start needs: without it this one, 0.8 rad a tick, explodes.
#[test]
fn a_spring_that_no_tick_can_follow_never_gains() {
    let tether =
        Tether { anchor_m: single(MIDDLE), slack_m: Vec3::ZERO, stiffness_n_per_m: 1e6, damping_n_s_per_m: 0.0 };
    let body = RigidBody { tether: Some(tether), ..block(moving(vec3(0.3, -0.2, 0.1), Vec3::ZERO)) };
    let mut state = body.rest();
    let energy = body.energy(&state);
    for _ in 0..10_000 {
        body.step(&mut state, &Wrench::default(), PERIOD);
        // Roundings of the position, 4 nm of a spring that pulls with 120 N, at random.
        assert!(body.energy(&state) < energy * 1.05, "{} {energy}", body.energy(&state));
    }
}
