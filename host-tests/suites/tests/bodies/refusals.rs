//! What the tracker must not do: take a step that leads away, or leave an edge before both of its faces have been
//! asked.

use crate::scene::repeat;
use palpate::body::{Body, Effort, Feature, Separator, Side};
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SecondDerivativeBounds};
use palpate::track::{Controller, FirstOrder, Outcome, Probe};
use palpate_bake::{BakedBody, BakedCoefficients};

const PERIOD: f32 = 1.0 / 4_000.0;

fn baked(name: &str) -> BakedBody {
    let baked = palpate_suites::body(name);
    let options = baked.locator_options();
    baked.located(&options, &|_, _| ()).unwrap().0
}

/// The capped box with bounds of its curvature that are a lie: steps go too far.
fn lying() -> Body<'static> {
    let mut baked = baked("capped_box");
    for face in &mut baked.faces {
        face.patch.shape.second_derivatives = SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 };
    }
    for edge in &mut baked.edges {
        edge.curve.second_derivative = 0.0;
    }
    baked.to_body().unwrap()
}

#[test]
fn a_step_that_leads_away_is_rejected_on_faces_and_on_edges() {
    // A tick of several steps tells of the last alone.
    let body = lying().with_effort(Effort::ONE);
    let seen = repeat(2_000, 41, |random| {
        let direction = Vec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0) as f32)).normalize();
        // Beyond the radii of curvature, some 0.1 m, a step to where the tangent leads goes too far.
        let probe = direction * random.between(0.3, 0.6) as f32;
        let start = [random.between(0.0, 1.0) as f32, random.between(0.0, 1.0) as f32];
        let mut state = body.start_on(random.below(body.faces().len()) as u16, start);
        let mut rejected = [0_u32; 2];
        for tick in 0..100 {
            let before = state.witness.surface.point.as_dvec3().distance(probe.as_dvec3());
            let at = state.witness.surface.point;
            let step = body.track(&Controller::FirstOrder(FirstOrder::CERTIFIED), &mut state, Probe::at(probe), PERIOD);
            let now = state.witness.surface.point.as_dvec3().distance(probe.as_dvec3());
            rejected[usize::from(matches!(state.feature, Feature::Edge(_)))] +=
                u32::from(step.outcome == Outcome::Rejected);
            let coordinates = (at.abs() + probe.abs())
                .max_element()
                .max((state.witness.surface.point.abs() + probe.abs()).max_element())
                + body.size();
            // 64 roundings of the squared distance are allowed, 32 of the distance; and a few of the comparison itself.
            let allowed = 34.0 * f64::from(f32::EPSILON * coordinates);
            assert!(
                now - before <= allowed,
                "tick {tick}: {} m farther from {probe}, {:?}",
                now - before,
                state.feature
            );
        }
        rejected
    });
    let [faces, edges] = seen.iter().fold([0, 0], |[faces, edges], [face, edge]| [faces + face, edges + edge]);
    println!("rejected steps: {faces} on faces, {edges} on edges");
    assert!(faces > 100 && edges > 100, "rejected: {faces} on faces, {edges} on edges");
}

/// From the end of an edge, where it holds the witness point, to its second face: by way of no vertex.
#[test]
fn an_edge_is_not_left_for_its_vertex_before_both_faces_have_declined() {
    let body = baked("thin_plate").to_body().unwrap();
    let reach = 0.01 * body.size();
    let mut tried = 0;
    for (index, vertex) in body.vertices().iter().enumerate() {
        let spokes = &body.spokes()[usize::from(vertex.first_spoke)..][..usize::from(vertex.spokes)];
        for spoke in spokes {
            let edge = &body.edges()[usize::from(spoke.edge)];
            let [first, second] =
                edge.faces.map(|of| match body.faces()[usize::from(of.face)].sides[usize::from(of.side)] {
                    Side::Edge { separator: Separator::Plane { across, .. }, .. } => across.normalize(),
                    ref other => panic!("not a plane: {other:?}"),
                });
            let mut state = body.start();
            let mut go = |along: f32, out_of: [f32; 2]| {
                let offset = spoke.direction * along + first * out_of[0] + second * out_of[1];
                body.step(&Controller::SecondOrder, &mut state, Probe::at(vertex.point + offset * reach), PERIOD);
                state.feature
            };
            let rested = (0..500).map(|_| go(-1.0, [1.0, 1.0])).last();
            assert_eq!(rested, Some(Feature::Vertex(index as u16)));
            assert_eq!(go(1.0, [1.0, 1.0]), Feature::Edge(spoke.edge));
            // Beyond the edge's end, over the second face.
            for _ in 0..2 {
                let feature = go(-1.0, [1.0, -1.0]);
                assert!(!matches!(feature, Feature::Vertex(_)), "edge {} was left for {feature:?}", spoke.edge);
            }
            tried += 1;
        }
    }
    assert_eq!(tried, 24, "a plate has eight corners of three edges");
}

/// A ball whose seams gape: every second face lies a twentieth of the radius farther out.
fn gaping() -> Body<'static> {
    let baked = palpate_suites::body("sphere_body");
    let options = baked.locator_options();
    let mut baked = baked.located_for(&[glam::DVec3::new(0.0, 0.0, 0.1)], &options, &|_, _| ()).unwrap();
    for face in baked.faces.iter_mut().step_by(2) {
        match &mut face.patch.coefficients {
            BakedCoefficients::Polynomial(entries) => entries.iter_mut().flatten().for_each(|number| *number *= 1.05),
            BakedCoefficients::Rational(entries) => {
                entries.iter_mut().flat_map(|[x, y, z, _]| [x, y, z]).for_each(|number| *number *= 1.05);
            }
        }
    }
    baked.to_body().unwrap()
}

/// Over a seam that gapes the next face may be farther: the step is rejected, and the witness point is still where it is
/// said to be.
#[test]
fn a_rejected_step_over_a_seam_leaves_the_witness_point_on_its_face() {
    let body = gaping().with_effort(Effort::ONE);
    let rejected: u32 = repeat(500, 43, |random| {
        let direction = Vec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0) as f32)).normalize();
        let probe = direction * random.between(0.06, 0.2) as f32;
        let start = [random.between(0.0, 1.0) as f32, random.between(0.0, 1.0) as f32];
        let mut state = body.start_on(random.below(body.faces().len()) as u16, start);
        let mut rejected = 0;
        for tick in 0..60 {
            let step = body.track(&Controller::SecondOrder, &mut state, Probe::at(probe), PERIOD);
            rejected += u32::from(step.outcome == Outcome::Rejected);
            let Feature::Face(index) = state.feature else { continue };
            let [u, v] = state.witness.parameters;
            let point = body.faces()[usize::from(index)].patch.evaluate(u, v).point;
            // Either way of evaluating rounds a few times.
            let off = point.distance(state.witness.surface.point);
            assert!(off < 1e-6, "tick {tick}: {off} m beside face {index} at {:?}", [u, v]);
        }
        rejected
    })
    .into_iter()
    .sum();
    println!("{rejected} rejected steps");
    assert!(rejected > 100, "{rejected} rejected steps");
}
