//! The body as points and normals, by the same evaluation that the tick uses.

use alloc::vec::Vec;
use palpate::body::{Body, EdgeFace, Feature, Side};
use palpate::math::{Vec3, inverse_sqrt};
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

// The border of a feature's Voronoi region, as sheets of rays that begin on the body.
//
// A face's region ends where its normals along its border stand; an edge's is the wedge between the normals of its
// two faces, closed at its ends; a vertex's is the cone between such ends.

/// Rays along a sheet.
pub const STEPS: u32 = 24;

/// The sheets of a feature, [`STEPS`] + 1 rays each: start and direction, six numbers.
pub fn sheets(body: &Body<'static>, feature: Feature, out: &mut Vec<f32>) {
    match feature {
        Feature::Face(index) => {
            let Some(face) = body.faces().get(usize::from(index)) else { return };
            for (number, side) in (0_u8..).zip(&face.sides) {
                let Side::Edge { edge, .. } = side else { continue };
                let of = palpate::body::EdgeFace { face: index, side: number };
                along(body, *edge, of, out);
            }
        }
        Feature::Edge(index) => {
            let Some(edge) = body.edges().get(usize::from(index)) else { return };
            for of in edge.faces {
                along(body, index, of, out);
            }
            for end in [0.0, 1.0] {
                fan(body, index, end, out);
            }
        }
        Feature::Vertex(index) => {
            for (number, edge) in (0_u16..).zip(body.edges()) {
                for (end, vertex) in [0.0, 1.0].into_iter().zip(edge.ends) {
                    if vertex == index {
                        fan(body, number, end, out);
                    }
                }
            }
        }
    }
}

/// The normals of one face along an edge.
fn along(body: &Body<'static>, edge: u16, of: palpate::body::EdgeFace, out: &mut Vec<f32>) {
    let Some(curve) = body.edges().get(usize::from(edge)).map(|edge| &edge.curve) else { return };
    if body.faces().get(usize::from(of.face)).is_none() {
        return;
    }
    for step in 0..=STEPS {
        let t = step as f32 / STEPS as f32;
        out.extend(curve.evaluate(t).point.to_array());
        out.extend(normal_beside(body, of, t).unwrap_or(Vec3::ZERO).to_array());
    }
}

/// From the normal of one face to that of the other at an end of an edge.
fn fan(body: &Body<'static>, edge: u16, end: f32, out: &mut Vec<f32>) {
    let Some(edge) = body.edges().get(usize::from(edge)) else { return };
    let [Some(from), Some(to)] = edge.faces.map(|of| normal_beside(body, of, end)) else { return };
    let point = edge.curve.evaluate(end).point;
    for step in 0..=STEPS {
        let between = from + (to - from) * (step as f32 / STEPS as f32);
        let squared = between.length_squared();
        // Opposite normals have no direction between them.
        let direction = if squared > 1e-6 { between * inverse_sqrt(squared) } else { from };
        out.extend(point.to_array());
        out.extend(direction.to_array());
    }
}
