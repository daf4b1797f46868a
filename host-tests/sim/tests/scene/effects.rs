//! Effects of a body, against their closed forms in double precision: a probe swept over the box's flat bottom.

use crate::common::{LIMITS, MATERIAL, MIDDLE, PERIOD, Random, double, part, single};
use glam::{DMat3, DVec3};
use palpate::math::{Vec3, vec3};
use palpate::render::{Effects, Friction, Magnet, Texture, TextureShape, Viscosity};
use palpate::scene::{Material, Motion, RigidBody, Scene};
use palpate::servo::Surface;
use palpate::track::{Controller, Placement, Probe};
use std::f64::consts::TAU;

const MAGNET: Magnet = Magnet { force_n: 0.8, reach_m: 0.006 };
const VISCOSITY: Viscosity = Viscosity { damping_n_s_per_m: 2.0, reach_m: 0.004 };
const RIDGES: Texture =
    Texture { shape: TextureShape::Ridges { across: vec3(0.6, 0.8, 0.0), pitch_m: 0.004 }, max_fraction: 0.2 };
const BUMPS: Texture = Texture { shape: TextureShape::Bumps { pitch_m: 0.005 }, max_fraction: 0.2 };

/// For a material, which refers to them.
fn kept(effects: Effects) -> Option<&'static Effects> {
    Some(Box::leak(Box::new(effects)))
}

/// The probe in the body's frame at a time, and its velocity: across the bottom, 8 mm in front of it to 3 mm behind.
fn swept(seconds: f64) -> (DVec3, DVec3) {
    let at = |seconds: f64| {
        let z = -0.0025 - 0.0055 * (9.0 * seconds).cos();
        DVec3::new(0.03 + 0.02 * (4.0 * seconds).sin(), 0.02 + 0.008 * (7.0 * seconds).sin(), z)
    };
    (at(seconds), (at(seconds + 1e-6) - at(seconds - 1e-6)) / 2e-6)
}

/// The force of the closed forms, in the body's frame.
fn expected(material: &Material, position: DVec3, velocity: DVec3) -> DVec3 {
    let (gap, normal) = (-position.z, -DVec3::Z);
    let (stiffness, damping) = (f64::from(material.stiffness_n_per_m), f64::from(material.damping_n_s_per_m));
    let push = if gap < 0.0 { (-stiffness * gap - damping * velocity.dot(normal)).clamp(0.0, 5.0) } else { 0.0 };
    let mut force = normal * push;
    let effects = material.effects.unwrap();
    if let Some(Texture { shape, max_fraction }) = effects.texture {
        let share = f64::from(max_fraction) * push;
        let ripple = |along: f64, pitch: f32| (TAU * along / f64::from(pitch)).sin();
        force -= share
            * match shape {
                TextureShape::Ridges { across, pitch_m } => {
                    double(across) * ripple(position.dot(double(across)), pitch_m)
                }
                TextureShape::Bumps { pitch_m } => {
                    DVec3::new(ripple(position.x, pitch_m), ripple(position.y, pitch_m), 0.0) / 3_f64.sqrt()
                }
                TextureShape::Custom(_) => unreachable!(),
            };
    }
    if let Some(Magnet { force_n, reach_m }) = effects.magnet {
        let x = (gap / f64::from(reach_m)).clamp(0.0, 1.0);
        force -= normal * 4.0 * f64::from(force_n) * x * (1.0 - x);
    }
    if let Some(Viscosity { damping_n_s_per_m, reach_m }) = effects.viscosity {
        force -= velocity * f64::from(damping_n_s_per_m) * (1.0 - gap / f64::from(reach_m)).clamp(0.0, 1.0);
    }
    let most = f64::from(effects.max_force_n);
    if force.length() > most { force * (most / force.length()) } else { force }
}

#[test]
fn each_effect_is_its_closed_form_on_a_body_that_is_turned() {
    let turn = DMat3::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 1.1);
    let origin = DVec3::new(0.01, -0.03, 0.02);
    let axes = [turn.x_axis, turn.y_axis, turn.z_axis].map(single);
    let placement = Placement { axes, origin: single(origin), ..Placement::IDENTITY };
    let all = Effects { texture: Some(RIDGES), magnet: Some(MAGNET), viscosity: Some(VISCOSITY), max_force_n: 1.2 };
    for (name, effects) in [
        ("ridges", Effects { texture: Some(RIDGES), ..Effects::NONE }),
        ("bumps", Effects { texture: Some(BUMPS), ..Effects::NONE }),
        ("magnet", Effects { magnet: Some(MAGNET), ..Effects::NONE }),
        ("viscosity", Effects { viscosity: Some(VISCOSITY), ..Effects::NONE }),
        ("limit of force", Effects { max_force_n: 0.7, ..Effects::NONE }),
        ("all", all),
    ] {
        let material = Material { effects: kept(effects), ..MATERIAL };
        let scene = Scene::new(LIMITS, [part(Motion::Resting(placement), material)]);
        let (mut state, mut worst, mut energy, mut strongest) = (scene.rest(), 0.0_f64, f64::NEG_INFINITY, 0.0_f64);
        for tick in 0..16_000 {
            let (position, velocity) = swept(f64::from(tick) * f64::from(PERIOD));
            let seen = Probe { position: single(turn * position + origin), velocity: single(turn * velocity) };
            scene.follow(&Controller::SecondOrder, &mut state, seen, PERIOD);
            let force = double(state.force());
            // The tracker is exact from the second tick on.
            if tick > 0 {
                worst = worst.max((force - turn * expected(&material, position, velocity)).length());
            }
            if effects.viscosity.is_some() && effects.magnet.is_none() && position.z < 0.0 {
                energy = energy.max(force.dot(turn * velocity));
            }
            strongest = strongest.max(force.length());
        }
        println!("{name}: off by {worst:.1e} N of {strongest:.2} N at most");
        // Rounding of places within 0.1 m, 7e-9 m each, on a slope of up to 600 N/m; of a pitch, 2 N/4 mm.
        assert!(worst < 5e-5 && strongest > 0.15, "{name}: {worst} {strongest}");
        assert!(strongest <= f64::from(effects.max_force_n) * (1.0 + 1e-6), "{name}: {strongest}");
        assert!(energy <= 0.0, "{name}: {energy} W");
    }
}

/// Friction and a texture come on top of the push, and of two bodies each has its own limit.
#[test]
fn no_body_exceeds_its_limit_of_force_whatever_adds_up() {
    let friction = Friction {
        stiffness_n_per_m: 900.0,
        damping_n_s_per_m: 1.0,
        static_coefficient: 1.5,
        dynamic_coefficient: 1.2,
    };
    let material = |max_force_n| {
        let effects = Effects { texture: Some(BUMPS), magnet: Some(MAGNET), viscosity: Some(VISCOSITY), max_force_n };
        Material { friction: Some(friction), effects: kept(effects), ..MATERIAL }
    };
    let limits = [0.9_f32, 2.0];
    let beside = Placement { origin: vec3(0.0, 0.001, 0.001), ..Placement::IDENTITY };
    let parts = [(Placement::IDENTITY, limits[0]), (beside, limits[1])];
    let scene = Scene::new(LIMITS, parts.map(|(place, max)| part(Motion::Resting(place), material(max))));
    let (mut state, mut strongest) = (scene.rest(), [0.0_f32; 2]);
    for tick in 0..40_000 {
        let (position, velocity) = swept(f64::from(tick) * f64::from(PERIOD));
        scene.follow(
            &Controller::SecondOrder,
            &mut state,
            Probe { position: single(position), velocity: single(velocity) },
            PERIOD,
        );
        for (index, strongest) in strongest.iter_mut().enumerate() {
            *strongest = strongest.max(state.part(index).unwrap().force().length());
        }
    }
    for (strongest, limit) in strongest.into_iter().zip(limits) {
        assert!(strongest <= limit * (1.0 + 1e-6) && strongest > 0.99 * limit, "{strongest} of {limit}");
    }
}

/// Four magnets, of which two at most are rendered: whichever comes and goes, the force moves on by what the motion
/// explains and the release rate.
#[test]
fn a_magnet_comes_and_goes_without_a_step() {
    let effects = Effects { magnet: Some(Magnet { reach_m: 0.03, ..MAGNET }), ..Effects::NONE };
    let material = Material { effects: kept(effects), ..MATERIAL };
    let place = |x: f32, y: f32| Placement { origin: vec3(x, y, 0.0), ..Placement::IDENTITY };
    let parts = [place(0.01, 0.01), place(-0.07, 0.01), place(-0.03, -0.05), place(-0.03, 0.056)];
    let scene = Scene::new(LIMITS, parts.map(|place| part(Motion::Resting(place), material)));
    let mut random = Random::new(23);
    let (mut state, mut last, mut worst, mut exchanged) = (scene.rest(), DVec3::ZERO, 0.0_f64, 0);
    let (mut position, mut tracked) = (DVec3::new(0.0, 0.0, -0.015), state.tracked());
    for _ in 0..2_000 {
        let goal = DVec3::new(random.between(-0.03, 0.03), random.between(-0.03, 0.03), random.between(-0.02, -0.004));
        let step = (goal - position).clamp_length_max(0.3 * f64::from(PERIOD));
        for _ in 0..((goal - position).length() / step.length().max(1e-9)) as u32 {
            position += step;
            let velocity = single(step / f64::from(PERIOD));
            let seen = Probe { position: single(position), velocity };
            scene.follow(&Controller::SecondOrder, &mut state, seen, PERIOD);
            let force = double(state.force());
            worst = worst.max((force - last).length());
            exchanged += u32::from(tracked != state.tracked());
            (last, tracked) = (force, state.tracked());
        }
    }
    // Two magnets, each of 4 F/reach along its normal, which turns by no more than a step over the gap.
    let slope = 4.0 * f64::from(MAGNET.force_n) / 0.03;
    let most = 2.0 * slope * 0.3 * f64::from(PERIOD) + f64::from(LIMITS.release_n_per_s * PERIOD);
    println!("{exchanged} exchanges: {worst:.4} N a tick at most of {most:.4}");
    assert!(worst <= most && exchanged > 100, "{worst} {most} {exchanged}");
}

/// A tool at rest in its viscous layer takes energy from a free body at every tick, wherever the drag acts on it.
#[test]
fn a_viscous_layer_slows_a_free_body_and_never_drives_it() {
    let effects = Effects { viscosity: Some(Viscosity { damping_n_s_per_m: 0.5, reach_m: 0.1 }), ..Effects::NONE };
    let material = Material { effects: kept(effects), ..Material::new(0.0, 0.0) };
    let mut random = Random::new(29);
    let (mut slowed, mut risen) = (0, f64::NEG_INFINITY);
    for _ in 0..100 {
        let (velocity, angular_velocity) = (single(random.vector(0.05)), single(random.vector(5.0)));
        let start = Placement { velocity, angular_velocity, ..Placement::IDENTITY };
        let body = RigidBody { centre_m: single(MIDDLE), ..RigidBody::new(start, 0.2, vec3(5e-5, 8e-5, 1e-4)) };
        let scene = Scene::new(LIMITS, [part(Motion::Free(body), material)]);
        let probe = Probe { position: single(MIDDLE + random.direction() * 0.06), velocity: Vec3::ZERO };
        let mut state = scene.rest();
        let mut energy = f64::from(body.energy(&body.rest()));
        let start = energy;
        for _ in 0..2_000 {
            scene.follow(&Controller::SecondOrder, &mut state, probe, PERIOD);
            let now = f64::from(body.energy(state.part(0).unwrap().moving()));
            (risen, energy) = (risen.max((now - energy) / start), now);
        }
        slowed += u32::from(energy < 0.5 * start);
    }
    println!(
        "{slowed} of 100 lost half of their energy in half a second; it rose by {risen:.1e} of itself a tick at most"
    );
    // Rounding of a velocity and of a turn, single precision.
    assert!(risen < 1e-6 && slowed > 30, "{risen} {slowed}");
}
