//! Probes right over a border, to the last bit: there the tangent plane of both faces is the same, or the tangent
//! around a pole is rounding, and none of the faces may be sure that the probe is its own. The witness point still
//! comes to rest where the body is nearest; and a probe that goes in through a seam is felt.

use crate::scene::{Scene, from_environment};
use glam::DVec3;
use palpate::body::{Body, BodyWitness, EdgeKind, Side};
use palpate::math::{Vec3, vec3};
use palpate::patch::Patch as _;
use palpate::track::{Contact, Controller, Probe};
use palpate_truth::generate::Random;
use palpate_truth::generate::bodies;
use palpate_truth::generate::models::rounded_box;
use rayon::prelude::*;

/// 1 kHz, and so many ticks on the way and at rest.
const PERIOD: f32 = 1e-3;
const TICKS: u16 = 300;
/// Of the size: what `f32` coordinates leave, as for single queries.
const EXACT: f64 = 1e-6;
/// The tracker changes over to a candidate whose squared distance is shorter by this part.
const NEARER: f64 = 1e-3;

/// A place of a border, the face's outward unit normal there, and the border's tangent.
#[derive(Clone, Copy)]
struct Over {
    face: usize,
    side: usize,
    point: Vec3,
    normal: Vec3,
    tangent: Vec3,
}

/// Places of all borders of a body, exactly and a hair inside of its face.
fn places<'a>(body: &'a Body<'_>) -> impl Iterator<Item = Over> + 'a {
    let faces = body.faces().iter().enumerate();
    let sides = faces.flat_map(|(index, face)| (0..4).map(move |side| (index, face, side)));
    let places =
        sides.flat_map(|side| [0.1, 0.3, 0.5].into_iter().flat_map(move |t| [0.0, 1e-5].map(|off| (side, t, off))));
    places.filter_map(|((index, face, side), t, off): (_, f32, f32)| {
        let [u, v] = [[off, t], [1.0 - off, t], [t, off], [t, 1.0 - off]][side];
        let at = face.patch.evaluate(u, v);
        let normal = at.tangent_u.cross(at.tangent_v) * face.patch.orientation();
        let tangent = if side < 2 { at.tangent_v } else { at.tangent_u };
        let [normal, tangent] = [normal, tangent].map(|vector| vector / vector.length());
        (normal.is_finite() && tangent.is_finite()).then_some(Over {
            face: index,
            side,
            point: at.point,
            normal,
            tangent,
        })
    })
}

/// Every n-th of a body with many borders, n odd: half of the probes come in the plane of the border.
fn some_of<T>(all: Vec<T>) -> Vec<T> {
    let step = all.len().div_ceil(from_environment("PALPATE_PROBES", 100) as usize) | 1;
    all.into_iter().step_by(step).collect()
}

/// Straight from one place to another, and a while there.
fn moved(body: &Body, from: Vec3, to: Vec3) -> BodyWitness {
    let mut state = body.start();
    for tick in 0..2 * TICKS {
        let share = (f32::from(tick) / f32::from(TICKS)).min(1.0);
        body.step(&Controller::SecondOrder, &mut state, Probe::at(from + (to - from) * share), PERIOD);
    }
    state
}

/// How much farther than the body the witness point is at most, in sizes, over all borders.
fn comes_to_rest(scene: &Scene) {
    let (body, oracle, size) = (&scene.body, scene.oracle(), scene.body.size());
    let heights = [0.3_f32, 1.0];
    let probes = some_of(places(body).flat_map(|over| heights.map(|height| (over, height))).collect());
    let over_by = |(index, (over, height)): (usize, &(Over, f32))| {
        let mut random = Random::new(index as u64);
        let mut some = || random.between(-1.0, 1.0) as f32;
        let probe = over.point + over.normal * (height * size);
        // From anywhere, or in the very plane that it shares with the border: there all that is across is rounding.
        let from = if index % 2 == 0 {
            probe + (over.normal * (0.2 * some()) + over.tangent * some()) * size
        } else {
            probe + vec3(some(), some(), some()) * size
        };
        let state = moved(body, from, probe);
        let truth = oracle.nearest(probe.as_dvec3(), 0.0)[0].1.distance;
        let [found, gap] = [(state.witness.surface.point.as_dvec3() - probe.as_dvec3()).length(), f64::from(state.gap)];
        let is_kept = !body.is_convex() && found * found * (1.0 - NEARER) <= truth * truth;
        let off = if is_kept { (gap.abs() - found).abs() } else { (found - truth).max((gap.abs() - truth).abs()) };
        // On its way it may have been pushed through.
        let off = if state.contact == Contact::Touching { 0.0 } else { off / f64::from(size) };
        (off, over.face, over.side, probe, from)
    };
    let worst = probes.par_iter().enumerate().map(over_by).max_by(|one, other| one.0.total_cmp(&other.0)).unwrap();
    let (off, face, side, probe, from) = worst;
    println!("{}: {} probes over borders, off by {off:.1e} of the size at most", scene.name, probes.len());
    assert!(off <= EXACT, "{}: off by {off:e} over side {side} of face {face}, at {probe} from {from}", scene.name);
}

#[test]
fn the_witness_point_comes_to_rest_over_every_border() {
    for name in ["capped_box", "rounded_cylinder", "sphere_body", "thin_plate", "teapot"] {
        comes_to_rest(Scene::load(name));
    }
    for body in [bodies::tetrahedron(), bodies::slab(), bodies::groove()] {
        comes_to_rest(&Scene::parsed(body.name, &body.text));
    }
    comes_to_rest(&Scene::parsed("a box with small fillets", &rounded_box([120.0, 80.0, 40.0], 0.5)));
}

/// Straight in, along the normal of a seam: from a quarter of the size in front to a hundredth of it behind.
fn is_felt(scene: &Scene) {
    let (body, oracle, size) = (&scene.body, scene.oracle(), scene.body.size());
    let is_seam = |over: &Over| match body.faces()[over.face].sides[over.side] {
        Side::Edge { edge, .. } => body.edges()[usize::from(edge)].kind == EdgeKind::Smooth,
        Side::Pole { .. } => false,
    };
    let seams = some_of(places(body).filter(is_seam).collect());
    let depth = 0.01 * size;
    for over in &seams {
        let [from, to] = [0.25 * size, -depth].map(|height| over.point + over.normal * height);
        let inside: DVec3 = to.as_dvec3();
        // Where the body is thinner than this, it may be in front again.
        let truth = oracle.nearest(inside, 0.0)[0].1.distance;
        if oracle.is_inside(inside) != Some(true) || truth < 0.9 * f64::from(depth) {
            continue;
        }
        let state = moved(body, from, to);
        let (face, side) = (over.face, over.side);
        assert_eq!(state.contact, Contact::Touching, "{}: side {side} of face {face}, to {to}: {state:?}", scene.name);
        let off = (f64::from(state.gap) + f64::from(depth)).abs() / f64::from(size);
        assert!(off <= EXACT, "{}: side {side} of face {face}, to {to}: the gap is off by {off:e}", scene.name);
    }
    println!("{}: {} places of seams", scene.name, seams.len());
    assert!(!seams.is_empty(), "{}", scene.name);
}

#[test]
fn what_goes_in_through_a_seam_is_felt() {
    for name in ["rounded_cylinder", "sphere_body"] {
        is_felt(Scene::load(name));
    }
    for body in [bodies::slab(), bodies::groove()] {
        is_felt(&Scene::parsed(body.name, &body.text));
    }
    is_felt(&Scene::parsed("a box with small fillets", &rounded_box([120.0, 80.0, 40.0], 0.5)));
}
