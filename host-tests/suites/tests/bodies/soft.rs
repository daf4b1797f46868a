//! Bodies that deform: at rest the rigid body's bits; while they vibrate no tick takes the witness point farther away
//! than probe and surface have moved (theory §15).

use crate::scene::Scene;
use glam::DVec3;
use palpate::body::{Body, Feature, Soft, SoftWitness};
use palpate::field::Mode;
use palpate::math::{Vec3, vec3};
use palpate::patch::Patch as _;
use palpate::track::{Controller, Probe};
use palpate_bake::{Model, modes};
use std::f64::consts::TAU;
use std::path::Path;

const PERIOD: f32 = 2.5e-4;
/// Hz, of four modes.
const FREQUENCIES: [f64; 4] = [5.0, 13.0, 29.0, 50.0];

fn modes_of(name: &str) -> Vec<Mode> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let model = Model::read(&root.join(format!("../models/{name}.toml"))).unwrap();
    modes::read(&root.join(format!("../truth/golden/deform/{name}.modes.toml")), &model).unwrap()
}

fn middle(body: &Body<'_>) -> Vec3 {
    body.locator().corner + Vec3::splat(0.5 * body.locator().side)
}

/// A path around and through a body, at this speed at most.
fn path(size: f32, speed: f64, tick: u32) -> Vec3 {
    let reach = 0.8 * f64::from(size);
    let phase = f64::from(tick) * f64::from(PERIOD) * speed / (reach * 1.8 * 1.7);
    let wave = |rate: f64| (reach * (rate * phase).sin()) as f32;
    vec3(wave(1.0), wave(1.37), wave(1.73))
}

#[test]
fn a_soft_body_at_rest_is_the_rigid_one_in_every_bit() {
    for name in ["capped_box", "ellipsoid_body", "rounded_cylinder"] {
        let (scene, modes) = (Scene::load(name), modes_of(name));
        let soft = Soft::new(scene.body, &modes).unwrap();
        let (mut rigid, mut own) = (scene.body.start(), soft.start());
        let centre = middle(&scene.body);
        for tick in 0..40_000 {
            let probe = Probe::at(centre + path(scene.body.size(), 1.0, tick));
            let expected = scene.body.step(&Controller::SecondOrder, &mut rigid, probe, PERIOD);
            let zero = if tick % 2 == 0 { 0.0 } else { -0.0 };
            let found = soft.step(&Controller::SecondOrder, &mut own, probe, &[zero; 4], PERIOD);
            assert_eq!((found.body, found.is_clamped), (expected, false), "{name}, tick {tick}");
            assert_eq!(own.body, rigid, "{name}, tick {tick}");
        }
    }
}

/// The place of the witness point on the body at rest.
fn material(body: &Body<'_>, state: &SoftWitness) -> DVec3 {
    let [u, v] = state.body.witness.parameters;
    match state.body.feature {
        Feature::Face(face) => body.faces()[usize::from(face)].patch.evaluate(u, v).point,
        Feature::Edge(edge) => body.edges()[usize::from(edge)].curve.point(u),
        Feature::Vertex(vertex) => body.vertices()[usize::from(vertex)].point,
    }
    .as_dvec3()
}

/// `Σ Δqᵢ ψᵢ(X)` in double precision.
fn moved(modes: &[Mode], from: &[f32; 4], to: &[f32; 4], at: DVec3) -> DVec3 {
    let monomials = |p: DVec3| [p.x * p.x, p.x * p.y, p.x * p.z, p.y * p.y, p.y * p.z, p.z * p.z];
    let of = |mode: &Mode| {
        let linear = mode.field.linear.iter().zip(at.to_array()).map(|(entry, x)| entry.as_dvec3() * x).sum::<DVec3>();
        let quadratic: DVec3 =
            mode.field.quadratic.iter().zip(monomials(at)).map(|(entry, x)| entry.as_dvec3() * x).sum();
        let bump = mode.bump.map_or(DVec3::ZERO, |bump| {
            let far = at.distance(bump.at.as_dvec3()) / f64::from(bump.radius);
            bump.direction.as_dvec3() * (1.0 - far * far).max(0.0).powi(3)
        });
        mode.field.constant.as_dvec3() + linear + quadratic + bump
    };
    modes.iter().zip(from.iter().zip(to)).map(|(mode, (from, to))| of(mode) * f64::from(to - from)).sum()
}

#[test]
fn no_tick_on_a_vibrating_body_moves_the_witness_point_away() {
    for name in ["capped_box", "ellipsoid_body", "rounded_cylinder"] {
        let (scene, mut modes) = (Scene::load(name), modes_of(name));
        modes.iter_mut().for_each(|mode| mode.limit = scene.body.size());
        let soft = Soft::new(scene.body, &modes).unwrap();
        let (size, centre) = (f64::from(scene.body.size()), middle(&scene.body));
        for speed in [0.3, 1.0] {
            let q = |tick: u32| {
                let time = f64::from(tick) * f64::from(PERIOD);
                FREQUENCIES.map(|rate| (0.05 * size * (TAU * rate * time).sin()) as f32)
            };
            let probe = |tick| centre + path(scene.body.size(), speed, tick);
            let mut state = soft.start();
            let mut most = f64::NEG_INFINITY;
            let mut checked = 0;
            for tick in 0..20_000 {
                let (before, was_located) = (state, state.body.is_located);
                let step = soft.step(&Controller::SecondOrder, &mut state, Probe::at(probe(tick)), &q(tick), PERIOD);
                if !was_located || tick == 0 {
                    continue;
                }
                let (last, now) = (probe(tick - 1).as_dvec3(), probe(tick).as_dvec3());
                let surface = moved(&modes, &q(tick - 1), &q(tick), material(&scene.body, &before));
                let distance = |state: &SoftWitness, probe| state.body.witness.surface.point.as_dvec3().distance(probe);
                let allowed = distance(&before, last) + (now - last - surface).length();
                most = most.max((distance(&state, now) - allowed) / size);
                assert!(!step.is_clamped);
                checked += 1;
            }
            println!("{name} at {speed} m/s: {checked} ticks, at most {most:.1e} of the size above the bound");
            // Of the tracker's own limit of rounding, 64 units in the last place of the coordinates.
            assert!(most <= 64.0 * f64::from(f32::EPSILON), "{name} at {speed} m/s: {most:e}");
        }
    }
}
