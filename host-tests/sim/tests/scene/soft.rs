//! Bodies that deform, in a scene: as one alone, in the frame that the scene gives it, with its modes' own time.

use crate::common::{
    BOX, FOAM, LIMITS, MATERIAL, MIDDLE, MOTION, PERIOD, RATE, Random, STIFF, double, part, single, soft,
};
use glam::DVec3;
use palpate::field::{MAX_MODES, Modal};
use palpate::math::{Vec3, vec3};
use palpate::render::{Hertz, Penalty};
use palpate::scene::{Command, Commanded, Material, Motion, Part, Path, RigidBody, Scene, SceneError, SceneState};
use palpate::servo::{Carrier, Hertzian, SoftBody, SoftContact, Surface, ToolContact, Tracked as _};
use palpate::track::{Contact, Controller, Placement, Probe};
use std::f64::consts::TAU;

const TICKS: u32 = 20_000;

/// A stroke that presses the dome repeatedly, in the box's frame: some millimetres deep, at up to 0.08 m/s.
fn stroke(tick: u32) -> DVec3 {
    let time = f64::from(tick) * f64::from(PERIOD);
    let height = 0.0335 + 0.004 * (TAU * 3.1 * time).sin();
    DVec3::new(0.03 + 0.015 * (TAU * 0.7 * time).sin(), 0.02 + 0.01 * (TAU * 0.9 * time).cos(), height)
}

/// Its velocity, by the difference.
fn stroke_velocity(tick: u32) -> DVec3 {
    (stroke(tick + 1) - stroke(tick)) / f64::from(PERIOD)
}

fn probe(tick: u32) -> Probe {
    Probe { position: single(stroke(tick)), velocity: single(stroke_velocity(tick)) }
}

const WALL: Penalty = Penalty {
    stiffness_n_per_m: MATERIAL.stiffness_n_per_m,
    damping_n_s_per_m: MATERIAL.damping_n_s_per_m,
    max_force_n: LIMITS.max_force_n,
};

/// A tick of the foam by itself, as the loop has it; returns the push and its direction.
fn alone(state: &mut SoftContact, probe: Probe) -> (f32, Vec3) {
    let touched = FOAM.follow(&Controller::SecondOrder, state, probe, PERIOD);
    let (normal, velocity, carrier) = (touched.normal, probe.velocity, Carrier::FIXED);
    let touch = ToolContact { gap_m: state.gap(), normal, velocity, carrier, period_s: PERIOD };
    let touch = (state.contact() == Contact::Touching).then_some(touch);
    (FOAM.push(state, &WALL, touch), normal)
}

#[test]
fn a_soft_body_where_it_was_made_is_the_one_alone_in_every_bit() {
    let scene = Scene::new(LIMITS, [soft(&FOAM, Motion::Resting(Placement::IDENTITY), MATERIAL)]);
    let (mut state, mut own) = (scene.rest(), FOAM.rest());
    let (mut touched, mut most) = (0, 0.0_f32);
    for tick in 0..TICKS {
        scene.follow(&Controller::SecondOrder, &mut state, probe(tick), PERIOD);
        let (push, normal) = alone(&mut own, probe(tick));
        let part = state.part(0).unwrap();
        assert_eq!(part.witness(), &own, "tick {tick}");
        assert_eq!(part.force(), normal * push, "tick {tick}");
        touched += u32::from(push > 0.0);
        most = most.max(own.q()[0].abs());
    }
    assert!(touched > TICKS / 10 && most > 1e-4, "{touched} ticks in contact, {most} m");
}

#[test]
fn a_body_without_modes_among_soft_ones_is_the_rigid_one_in_every_bit() {
    let at = |x: f32| Motion::Resting(Placement { origin: vec3(x, 0.0, 0.0), ..Placement::IDENTITY });
    let turns = Path::new(Placement::IDENTITY).turning(Vec3::Z, vec3(0.03, 0.02, 0.0), 0.5, RATE);
    let motions = [Motion::Prescribed(turns), at(0.07), at(-0.07)];
    let rigid = Scene::new(LIMITS, motions.map(|motion| part(motion, MATERIAL)));
    let stiff = Scene::new(LIMITS, motions.map(|motion| soft(&STIFF, motion, MATERIAL)));
    let (mut expected, mut found) = (rigid.rest(), stiff.rest());
    for tick in 0..TICKS {
        rigid.follow(&Controller::SecondOrder, &mut expected, probe(tick), PERIOD);
        stiff.follow(&Controller::SecondOrder, &mut found, probe(tick), PERIOD);
        for index in 0..motions.len() {
            let (a, b) = (expected.part(index).unwrap(), found.part(index).unwrap());
            assert_eq!(a.witness(), &b.witness().track().body, "tick {tick}, body {index}");
        }
        assert_eq!(expected.force(), found.force(), "tick {tick}");
    }
}

/// A tool that moves with a body touches it as it touches one that stands: forces turn with the body, and its motion
/// does no work of its own on the modes.
#[test]
fn a_moved_soft_body_gives_the_force_of_a_standing_one_in_its_own_frame() {
    let turned = Placement { axes: [Vec3::Y, Vec3::Z, Vec3::X], origin: vec3(0.1, -0.05, 0.02), ..Placement::IDENTITY };
    let path = Path::new(Placement { axes: [Vec3::Z, Vec3::X, Vec3::Y], ..Placement::IDENTITY })
        .turning(vec3(0.6, 0.0, 0.8), vec3(0.02, 0.03, 0.0), 1.5, RATE)
        .swaying(vec3(0.004, -0.006, 0.003), 9.0, RATE);
    for motion in [Motion::Resting(turned), Motion::Prescribed(path)] {
        let scene = Scene::new(LIMITS, [soft(&FOAM, motion, MATERIAL)]);
        let (mut state, mut standing) = (scene.rest(), FOAM.rest());
        let (mut force_off, mut q_off, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
        for tick in 0..TICKS {
            let place = match motion {
                Motion::Prescribed(path) => path.at(tick + 1),
                _ => turned,
            };
            let of_body = probe(tick);
            let position = place.point_to_a(of_body.position);
            let velocity = place.direction_to_a(of_body.velocity) + place.velocity_at(position);
            scene.follow(&Controller::SecondOrder, &mut state, Probe { position, velocity }, PERIOD);
            let (push, normal) = alone(&mut standing, of_body);
            let part = state.part(0).unwrap();
            let expected = place.direction_to_a(normal * push);
            force_off = force_off.max((double(part.force()) - double(expected)).length());
            most = most.max(f64::from(push));
            for (a, b) in part.witness().q().iter().zip(standing.q()) {
                q_off = q_off.max(f64::from((a - b).abs()));
            }
        }
        println!("{force_off:.1e} N of {most:.2} N, {q_off:.1e} m");
        // A tool's place in the scene is rounded, 7e-9 m a coordinate, and the frame's axes by 6e-8 of its 0.1 m: some
        // 2e-8 m of depth at 600 N/m; of its velocity 1e-7 m/s. Contact that starts a tick later: K v T, 30 mN at most,
        // which modes answer by that over their stiffness of 600 N/m, for a tick: less than 1e-6 m.
        assert!(most > 1.0 && force_off < 0.03 && q_off < 1e-6, "{force_off:e} N of {most} N, {q_off:e} m");
    }
}

/// A mode's free motion in closed form, from `[q, v]`.
fn ringing(modal: &Modal, [q, v]: [f32; 2], seconds: f64) -> f64 {
    let [m, c, k] = [modal.mass_kg, modal.damping_n_s_per_m, modal.stiffness_n_per_m].map(f64::from);
    let decay = 0.5 * c / m;
    let rate = (k / m - decay * decay).sqrt();
    let [q, v] = [q, v].map(f64::from);
    (-decay * seconds).exp() * (q * (rate * seconds).cos() + (v + decay * q) / rate * (rate * seconds).sin())
}

/// Time passes for the modes of a body that is off, and of one that is looked at seldom.
#[test]
fn modes_ring_on_while_the_body_is_off_or_far() {
    let far = |x: f32| Motion::Resting(Placement { origin: vec3(x, 0.0, 0.0), ..Placement::IDENTITY });
    let here = soft(&FOAM, far(0.0), MATERIAL);
    let parts = [here, soft(&STIFF, far(0.3), MATERIAL), soft(&STIFF, far(0.4), MATERIAL)];
    let scene = Scene::new(
        LIMITS,
        parts.map(|mut part| {
            part.group = u8::from(part.motion != here.motion);
            part
        }),
    );
    let press = |state: &mut SceneState<SoftContact, 3>| {
        // Deep at 0.5 m/s, then out in a tick: the modes keep what they have.
        let above = vec3(0.045, 0.028, 0.035);
        for tick in 0..3_060_u32 {
            let deep = 1.25e-4 * tick.saturating_sub(3_000) as f32;
            scene.follow(&Controller::SecondOrder, state, Probe::at(above - Vec3::Z * deep), PERIOD);
        }
        scene.follow(&Controller::SecondOrder, state, Probe::at(above + Vec3::Z * 0.01), PERIOD);
    };
    let modes = |state: &SceneState<SoftContact, 3>| -> [[f32; 2]; MAX_MODES] {
        let witness = state.part(0).unwrap().witness();
        core::array::from_fn(|mode| [witness.q()[mode], witness.rates()[mode]])
    };
    for (unseen, is_off) in [(1_u32, true), (7, true), (100, true), (501, true), (70_000, true), (400, false)] {
        let mut state = scene.rest();
        press(&mut state);
        let start = modes(&state);
        let contact = state.part(0).unwrap().contact();
        assert!(start[0][0].abs() > 3e-5 && contact != Contact::Touching, "{contact:?} {start:?}");
        // At the far bodies' side all the time: the foam is off, or the third nearest.
        let aside = vec3(0.33, 0.02, 0.06);
        if is_off {
            scene.switch(&mut state, 2);
        }
        for _ in 0..unseen {
            scene.follow(&Controller::SecondOrder, &mut state, Probe::at(aside), PERIOD);
        }
        assert!(!is_off || modes(&state) == start, "it is off and yet it was asked for");
        assert!(is_off || !state.tracked().contains(&0), "it is the nearest and yet far");
        let asked = if is_off {
            scene.switch(&mut state, 3);
            unseen
        } else {
            // Until it is next looked at.
            let before = modes(&state);
            let mut more = 0;
            while modes(&state) == before {
                scene.follow(&Controller::SecondOrder, &mut state, Probe::at(aside), PERIOD);
                more += 1;
                assert!(more < 1_000, "it is never looked at");
            }
            unseen + more
        };
        if is_off {
            scene.follow(&Controller::SecondOrder, &mut state, Probe::at(aside), PERIOD);
        }
        // The tick in which it is asked for moves its modes on too.
        let seconds = f64::from(asked + u32::from(is_off)) * f64::from(PERIOD);
        for (mode, (modal, start)) in MOTION.iter().zip(start).enumerate() {
            let (expected, found) = (ringing(modal, start, seconds), f64::from(modes(&state)[mode][0]));
            // Constants of f32 over some thousand ticks, of 1 mm.
            assert!((found - expected).abs() < 1e-7, "mode {mode} after {asked} ticks: {found:e} m, {expected:e} m");
        }
    }
}

/// Energy of the modes, J.
fn modal(motion: &[Modal], state: &SoftContact) -> f64 {
    let each = motion.iter().zip(state.q()).zip(state.rates());
    let of = |((modal, q), v): ((&Modal, f32), f32)| {
        let [q, v] = [q, v].map(|number| f64::from(number).powi(2));
        0.5 * (f64::from(modal.stiffness_n_per_m) * q + f64::from(modal.mass_kg) * v)
    };
    each.map(of).sum()
}

/// A free body of 20 g that is hit: what the tool has spent it has afterwards, with its modes' energy, J, and the impulse
/// is its momentum. Returns the energy that modes had in all, and that the bound leaves open.
fn hit<S: Surface>(surface: &S, stiffness: f32, modes: impl Fn(&S::Witness) -> f64) -> [f64; 2] {
    let body =
        RigidBody { centre_m: single(MIDDLE), ..RigidBody::new(Placement::IDENTITY, 0.02, vec3(4e-6, 8e-6, 9e-6)) };
    let Part { sphere, group, .. } = soft(&FOAM, Motion::Free(body), MATERIAL);
    let part = Part { surface, motion: Motion::Free(body), material: Material::new(stiffness, 0.0), sphere, group };
    let scene = Scene::new(LIMITS, [part]);
    let mut random = Random::new(38);
    let (mut spent, mut of_modes, mut open, mut worst) = (0.0, 0.0, 0.0, 0.0_f64);
    for _ in 0..40 {
        let mut state = scene.rest();
        let speed = random.between(0.05, 0.2);
        let start = DVec3::new(random.between(0.015, 0.045), random.between(0.01, 0.03), 0.04);
        let (mut work, mut momentum) = (0.0, DVec3::ZERO);
        let way = speed * f64::from(PERIOD);
        for tick in 0..3_000_u32 {
            // Waits until it is found, and stands still once it has pushed the body away.
            let tool = start - DVec3::Z * way * f64::from(tick.clamp(500, 1_500) - 500);
            let step = if (500..1_500).contains(&tick) { DVec3::NEG_Z * way } else { DVec3::ZERO };
            let probe = Probe { position: single(tool), velocity: single(step / f64::from(PERIOD)) };
            scene.follow(&Controller::SecondOrder, &mut state, probe, PERIOD);
            let force = double(state.part(0).unwrap().force());
            work -= force.dot(step);
            momentum -= force * f64::from(PERIOD);
        }
        let part = state.part(0).unwrap();
        let (has, moves) = (f64::from(body.energy(part.moving())), double(part.moving().velocity()) * 0.02);
        let in_modes = modes(part.witness());
        // A sampled wall's known gain ½ K Δp Δd, at a steady speed, is that of the ticks in which contact starts and ends.
        let kinks = f64::from(stiffness) * way * way;
        worst = worst.max((has + in_modes - work).abs() / kinks);
        // A rounding of the momentum in each of some hundred ticks.
        let off = (moves - momentum).length() / momentum.length();
        assert!(off < 1e-6, "{speed} m/s: {off:e}");
        (spent, of_modes, open) = (spent + work, of_modes + in_modes, open + kinks);
    }
    println!(
        "{spent:.2e} J spent, {of_modes:.2e} J in modes; of a hit at most {worst:.2} of {open:.1e} J is unexplained"
    );
    assert!(worst <= 1.0, "{worst}");
    [of_modes, open]
}

#[test]
fn a_free_body_that_is_hit_has_the_momentum_and_the_energy_that_came_in() {
    // Modes without damping.
    let motion = MOTION.map(|modal| Modal { damping_n_s_per_m: 0.0, ..modal });
    let clear = SoftBody::new(*FOAM.soft(), &motion, RATE).unwrap();
    let [of_modes, open] = hit(&clear, MATERIAL.stiffness_n_per_m, |state| modal(&motion, state));
    assert!(of_modes > open, "{of_modes:e} J, {open:e} J");
    // And with a dent of its own, on a rigid body and on one that deforms.
    let stiffness = DENT.steepest_n_per_m(LIMITS.max_force_n);
    hit(&Hertzian::new(&BOX, DENT), stiffness, |_| 0.0);
    hit(&Hertzian::new(&clear, DENT), stiffness, |state| modal(&motion, state));
}

/// Of a ball of 10 mm on 25 kPa, of which 573 N/m are left at 5 N.
const DENT: Hertz = Hertz::new(2.5e4, 0.01);

/// A dent under the tool is a potential: led round in it, the tool comes back with the work it went with.
#[test]
fn a_hertzian_surface_gives_the_closed_form_s_force_and_no_work_on_a_round() {
    let surface = Hertzian::new(&BOX, DENT);
    let Part { motion, sphere, group, .. } = soft(&STIFF, Motion::Resting(Placement::IDENTITY), MATERIAL);
    let material = Material::new(DENT.steepest_n_per_m(LIMITS.max_force_n), 0.0);
    let scene = Scene::new(LIMITS, [Part { surface: &surface, motion, material, sphere, group }]);
    let (mut state, rounds) = (scene.rest(), 20_000_u32);
    let at = |tick: u32| {
        let angle = TAU * f64::from(tick) / f64::from(rounds);
        // From 2 mm above the dome to 4 mm inside and back, over some 20 mm of it.
        let depth = 0.001 - 0.003 * angle.cos();
        DVec3::new(0.034 + 0.01 * (angle + 0.4).sin(), 0.017 + 0.008 * (2.0 * angle + 1.0).sin(), 0.0335 - depth)
    };
    for _ in 0..100 {
        scene.follow(&Controller::SecondOrder, &mut state, Probe::at(single(at(0))), PERIOD);
    }
    let (mut work, mut way, mut off, mut last, mut place) = (0.0, 0.0, 0.0_f64, DVec3::ZERO, at(0));
    for tick in 1..=rounds {
        let probe = single(at(tick));
        scene.follow(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
        let part = state.part(0).unwrap();
        let force = double(part.force());
        let depth = f64::from(-part.gap()).max(0.0);
        let expected = 4.0 / 3.0 * 2.5e4 * 0.01_f64.sqrt() * depth.powf(1.5);
        off = off.max((force.length() - expected).abs());
        let step = double(probe) - place;
        let mean = 0.5 * (force + last);
        (work, way) = (work + mean.dot(step), way + mean.dot(step).abs());
        (last, place) = (force, double(probe));
    }
    println!("{work:.1e} J on a round of {way:.1e} J, the force off by {off:.1e} N");
    // Two roundings of a coordinate in each of some 10,000 ticks of contact, at random, 4e-9 m, times the force.
    assert!(way > 1e-3 && work.abs() < 1e-6, "{work:e} J of {way:e} J");
    // The force's own, of 3 N; and it is no more than the wall may be stiff.
    assert!(off < 3e-6, "{off:e} N");
}

/// One that is too steep within the maximum force is refused as a wall is.
#[test]
fn a_dent_that_is_too_stiff_is_refused_as_a_wall_is() {
    let try_new = |contact: Hertz| {
        let surface = Hertzian::new(&BOX, contact);
        let Part { motion, sphere, group, .. } = soft(&STIFF, Motion::Resting(Placement::IDENTITY), MATERIAL);
        let material = Material::new(contact.steepest_n_per_m(LIMITS.max_force_n), 0.0);
        Scene::try_new(LIMITS, [Part { surface: &surface, motion, material, sphere, group }]).err()
    };
    // ∛(6 E*² R f) = 2,000 N/m at E* = 163.3 kPa.
    assert_eq!(try_new(Hertz::new(1.63e5, 0.01)), None);
    assert_eq!(try_new(Hertz::new(1.64e5, 0.01)), Some(SceneError::Stiffness(0)));
    assert_eq!(try_new(Hertz::new(-1.0, 0.01)), Some(SceneError::Stiffness(0)));
}

/// A body file has no modes.
#[test]
fn nothing_is_uploaded_in_the_place_of_a_soft_body() {
    let parts = [&FOAM, &STIFF].map(|body| soft(body, Motion::Resting(Placement::IDENTITY), MATERIAL));
    let scene = Scene::new(LIMITS, parts);
    let mut state = scene.rest();
    for command in [Command::Take { body: 0 }, Command::PutBack { body: 0 }] {
        assert_eq!(scene.apply(&mut state, &command), Err(SceneError::Deforms(0)));
    }
    assert_eq!(scene.apply(&mut state, &Command::Take { body: 1 }), Err(SceneError::NotOffered));
    assert_eq!(state, scene.rest());
    assert!(SceneError::Deforms(0).to_string().contains("body file has no modes"));
}
