//! The body as points and normals, by the same evaluation that the tick uses.

use alloc::vec::Vec;
use palpate::body::{Body, EdgeFace, Side};
use palpate::math::Vec3;
use palpate::track::Witness;

/// A grid of `steps + 1` points along each parameter of a face, `u` outermost: point and outward normal, six numbers.
pub fn face(body: &Body<'static>, index: u32, steps: u32, out: &mut Vec<f32>) {
    let Some(face) = body.faces().get(index as usize) else { return };
    let at = |step| step as f32 / steps as f32;
    for row in 0..=steps {
        for column in 0..=steps {
            let [point, normal] = placed(face, [at(row), at(column)]);
            out.extend(point.to_array());
            out.extend(normal.to_array());
        }
    }
}

/// `steps + 1` points of an edge: point, the outward normal of its first face there, and that of its second, nine
/// numbers; over an open border both are the first's.
pub fn edge(body: &Body<'static>, index: u32, steps: u32, out: &mut Vec<f32>) {
    let Some(edge) = body.edges().get(index as usize) else { return };
    for step in 0..=steps {
        let t = step as f32 / steps as f32;
        let point = edge.curve.evaluate(t).point;
        let [first, second] = edge.faces.map(|of| normal_beside(body, of, t));
        let first = first.unwrap_or(Vec3::ZERO);
        for vector in [point, first, second.unwrap_or(first)] {
            out.extend(vector.to_array());
        }
    }
}

/// The outward normal of a face of an edge at the edge's parameter.
pub fn normal_beside(body: &Body<'static>, of: EdgeFace, t: f32) -> Option<Vec3> {
    let face = body.faces().get(usize::from(of.face))?;
    let Side::Edge { reversed, .. } = face.sides.get(usize::from(of.side))? else { return None };
    let along = if *reversed { 1.0 - t } else { t };
    let place = match of.side {
        0 => [0.0, along],
        1 => [1.0, along],
        2 => [along, 0.0],
        _ => [along, 1.0],
    };
    Some(placed(face, place)[1])
}

/// A point of a face and its normal; next to a pole the normal is that of a place a little inside.
fn placed(face: &palpate::body::Face<'static>, [u, v]: [f32; 2]) -> [Vec3; 2] {
    const INSIDE: f32 = 1.0e-3;
    let witness = Witness::at(&face.patch, u, v);
    let inside = |at: f32| INSIDE + at * (1.0 - 2.0 * INSIDE);
    let flat = || Witness::at(&face.patch, inside(u), inside(v)).normal(&face.patch);
    let normal = witness.normal(&face.patch).or_else(flat).unwrap_or(Vec3::ZERO);
    [witness.surface.point, normal]
}
