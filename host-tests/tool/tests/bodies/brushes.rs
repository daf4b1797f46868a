//! Fast strokes over a body's corners, edges and poles: once the probe is in free air again, nothing is felt.

use crate::scene::{Scene, from_environment, repeat};
use glam::DVec3;
use palpate::body::Body;
use palpate::math::Vec3;
use palpate::servo::{ContactLimits, Surface as _};
use palpate::track::{Contact, Controller, Probe};
use palpate_truth::body_oracle::BodyOracle;
use palpate_truth::generate::Random;
use palpate_truth::oracle::OraclePoint;

/// 4 kHz.
const PERIOD: f32 = 2.5e-4;

/// Features in a row on the way out over a corner: an edge, the next one and the face beyond it.
const HANDOVERS: u32 = 3;

/// What a stroke felt.
#[derive(Clone, Copy, Debug, Default)]
struct Felt {
    /// Ticks in contact.
    touching: u32,
    /// Of them in free air, farther from the surface than a stroke goes in a tick.
    in_free_air: u32,
    ends: [Vec3; 2],
}

/// A straight stroke across a corner, a border or the middle of a patch, at right angles to the way out there and up to
/// a fiftieth of the size below.
fn stroke(scene: &Scene, random: &mut Random) -> (Vec3, Vec3, f32) {
    let patch = &scene.patches[random.below(scene.patches.len())];
    let mut place = || match random.below(4) {
        0 => random.between(0.0, 1.0),
        1 => 0.5,
        corner => f64::from(corner as u32 - 2),
    };
    let (u, v) = (place(), place());
    let place = OraclePoint::evaluate(patch, u, v).point;
    let out = (place - 0.5 * (scene.low + scene.high)).normalize_or(DVec3::Z);
    let middle = place - out * random.between(0.0, 0.02) * scene.size();
    let mut direction = || DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
    let along = direction().cross(out).normalize_or(out.any_orthonormal_vector());
    let reach = along * (1.5 * scene.size());
    ((middle - reach).as_vec3(), (middle + reach).as_vec3(), random.scale(0.1, 2.0) as f32)
}

fn brush(scene: &Scene, oracle: &BodyOracle<'_>, random: &mut Random) -> Felt {
    let (from, to, speed) = stroke(scene, random);
    let body: &Body = &scene.body;
    let stride = speed * PERIOD;
    let ticks = (from.distance(to) / stride).ceil() as u32;
    let mut state = body.start();
    let mut felt = Felt { ends: [from, to], ..Felt::default() };
    for tick in 0..ticks {
        let probe = from + (to - from) * (tick as f32 / ticks as f32);
        let step = body.step(&Controller::SECOND_ORDER, &mut state, Probe::at(probe), PERIOD);
        // As the loop does: a stroke that runs through the body lengthwise is no contact that a wall could explain.
        if step.unexplained || -state.gap > ContactLimits::DEFAULT.min_depth {
            body.lose(&mut state);
        }
        if state.contact != Contact::Touching || state.gap >= 0.0 {
            continue;
        }
        felt.touching += 1;
        let nearest = oracle.nearest(probe.as_dvec3(), 0.0);
        let is_outside = !oracle.is_inside_convex(nearest[0].0, probe.as_dvec3());
        if is_outside && nearest[0].1.distance > f64::from(stride) + 1e-4 * scene.size() {
            felt.in_free_air += 1;
        }
    }
    felt
}

#[test]
fn a_brush_is_not_felt_in_free_air() {
    let count = from_environment("PALPATE_BRUSHES", 200);
    for name in ["capped_box", "ellipsoid_body", "rounded_cylinder"] {
        let scene = Scene::load(name);
        let oracle = scene.oracle();
        let felt = repeat(count, 5, |random| brush(scene, &oracle, random));
        let late = felt.iter().filter(|felt| felt.in_free_air > 0).count();
        let Some(worst) = felt.iter().max_by_key(|felt| felt.in_free_air) else { return };
        println!(
            "{name}: {count} brushes, {} felt, {late} of them in free air, for {} ticks at most",
            felt.iter().filter(|felt| felt.touching > 0).count(),
            worst.in_free_air
        );
        // Out over another edge than the one it came in by, the witness point is on one feature a tick.
        assert!(worst.in_free_air <= HANDOVERS, "{name}: {} ticks, on the way {:?}", worst.in_free_air, worst.ends);
        assert!(felt.iter().filter(|felt| felt.touching > 0).count() as u32 > count / 2, "{name}: hardly any is felt");
    }
}
