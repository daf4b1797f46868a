//! The border of a feature's Voronoi region, as sheets of rays that begin on the body.
//!
//! A face's region ends where its normals along its border stand; an edge's is the wedge between the normals of its
//! two faces, closed at its ends; a vertex's is the cone between such ends.

use alloc::vec::Vec;
use palpate::body::{Body, Feature, Side};
use palpate::math::{Vec3, inverse_sqrt};

use crate::mesh::normal_beside;

/// Rays along a sheet.
pub const STEPS: u32 = 24;

/// The sheets of a feature, [`STEPS`] + 1 rays each: where it begins and its direction, six numbers.
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
