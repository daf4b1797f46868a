//! The joint step of a pair (theory §14) on random patches, with inner knots and weights on both sides: the certificate
//! lets no step rise, so that the guard rejects none.
//!
//! A tenth of `PALPATE_STEPS` steps are taken, 10⁷ in the long mode; without the variable 100,000.

use crate::random_patches::for_each_patch;
use palpate::body::{Body, BodyTables, Face, Lists, Locator, Side, Vertex};
use palpate::math::{Vec3, vec3};
use palpate::pair::{Core, Tool, ToolWitness};
use palpate::patch::SplinePatch;
use palpate::track::Placement;
use palpate_bake::BakedPatch;
use palpate_truth::generate::Random;
use std::error::Error;

/// A face alone. That it is convex is a lie, and lets it be a core: the certificate does not rest on it.
fn body(patch: SplinePatch<'static>, size: f32) -> Body<'static> {
    static VERTICES: [Vertex; 1] =
        [Vertex { point: Vec3::ZERO, outward: Vec3::ZERO, first_spoke: 0, spokes: 0, is_open: true }];
    static NODES: [[u16; 8]; 1] = [[1; 8]];
    let faces: &'static [Face] = Box::leak(Box::new([Face { patch, sides: [Side::Pole { vertex: 0 }; 4] }]));
    let locator = Locator { corner: Vec3::ZERO, side: size, nodes: &NODES, lists: Lists::WHOLE };
    let tables = BodyTables {
        faces,
        edges: &[],
        vertices: &VERTICES,
        spokes: &[],
        locator,
        size_m: size,
        is_convex: true,
        crc: None,
    };
    tables.try_checked().expect("the tables fit")
}

fn placement(random: &mut Random, reach: f64) -> Placement {
    let mut draw = || random.between(-1.0, 1.0) as f32;
    let x = vec3(draw(), draw(), draw() + 2.0).normalize();
    let y = x.cross(vec3(draw(), 1.5 + draw(), 0.3)).normalize();
    let origin = vec3(draw(), draw(), draw()) * reach as f32;
    Placement { axes: [x, y, x.cross(y)], origin, ..Placement::IDENTITY }
}

fn distance(state: &ToolWitness, placement: &Placement) -> f64 {
    let pair = state.pair();
    let (a, b) = (pair.a.point().as_dvec3(), pair.b.point().as_dvec3());
    let axes = placement.axes.map(Vec3::as_dvec3);
    (a - placement.origin.as_dvec3() - axes[0] * b.x - axes[1] * b.y - axes[2] * b.z).length()
}

#[test]
fn no_joint_step_rises_and_none_is_rejected() -> Result<(), Box<dyn Error>> {
    /// Steps from each start.
    const DESCENT: u64 = 20;
    let most = std::env::var("PALPATE_STEPS").map_or(100_000, |steps| steps.parse::<u64>().expect("a number") / 10);
    let mut bodies = Vec::new();
    for_each_patch(4, |_, patch| {
        let baked = BakedPatch::without_shape(patch)?;
        // A crease has no bound: its steps are guarded, not certified.
        if baked.shape.third_derivatives.jump_uu.is_finite() && baked.shape.third_derivatives.jump_vv.is_finite() {
            bodies.push((body(baked.to_patch()?, baked.size), patch.is_rational(), baked.breaks[0].len() > 2));
        }
        Ok(())
    })?;
    let mut random = Random::new(14);
    let (mut steps, mut rejected, mut rise, mut kinds) = (0, 0, 0.0_f64, [0; 3]);
    while steps < most {
        let mut draw = || bodies[(random.between(0.0, 0.999_999) * bodies.len() as f64) as usize];
        let ((a, rational_a, knots_a), (b, rational_b, knots_b)) = (draw(), draw());
        let core = match (steps / DESCENT) % 3 {
            0 => Core::Segment { half: 0.02 },
            1 => Core::Box { half: [0.02, 0.01, 0.005] },
            _ => Core::Body(&b),
        };
        let is_body = matches!(core, Core::Body(_));
        kinds[0] += u64::from(rational_a || (is_body && rational_b));
        kinds[1] += u64::from(knots_a || (is_body && knots_b));
        kinds[2] += u64::from(is_body);
        let tool = Tool::new(core, 0.0)?;
        let reach = 0.1 * random.scale(0.03, 3.0);
        let placement = placement(&mut random, reach);
        let mut start = || (0, [(); 2].map(|()| random.between(0.0, 1.0) as f32));
        let mut state = a.start_tool(&tool, &placement, start(), start());
        let size = f64::from(a.size());
        let mut before = distance(&state, &placement);
        for _ in 0..DESCENT {
            a.step_tool(&tool, &mut state, &placement, 0);
            let now = distance(&state, &placement);
            rise = rise.max((now - before) / size);
            rejected += u64::from(state.pair().halvings > 0);
            (before, steps) = (now, steps + 1);
        }
    }
    println!(
        "{steps} steps from {} starts, rational, with knots, of two bodies: {kinds:?}; up by {rise:.1e}, {rejected} \
         rejected",
        steps / DESCENT
    );
    assert!(kinds.iter().all(|kind| kind * DESCENT > steps / 5), "{kinds:?}");
    // Rounding of two points and of a placement, at coordinates of a few sizes.
    assert!(rise < 1e-6, "up by {rise:e} of the size");
    assert_eq!(rejected, 0);
    Ok(())
}
