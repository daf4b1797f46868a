//! Closest points from a standing start, a row a query.

use crate::body::Body;
use glam::DVec3;
use palpate_bake::sides::Sides;

/// Closest points, a row each.
#[derive(Default)]
pub struct Found {
    /// Index of the model's patch.
    pub patch: Vec<u32>,
    /// `(u, v)` on it.
    pub parameters: Vec<[f64; 2]>,
    /// The point, m.
    pub point: Vec<[f64; 3]>,
    /// The distance, m, negative inside.
    pub gap: Vec<f64>,
    /// Index of the body's face.
    pub face: Vec<u32>,
    /// `(u, v)` on it.
    pub on_face: Vec<[f32; 2]>,
    /// Evaluations of patches spent.
    pub evaluations: Vec<u32>,
    /// Whether every candidate was searched to its end.
    pub complete: Vec<bool>,
    /// Whether the query is beyond the locator's tables.
    pub far: Vec<bool>,
}

impl Found {
    fn with_room(count: usize) -> Self {
        Self {
            patch: Vec::with_capacity(count),
            parameters: Vec::with_capacity(count),
            point: Vec::with_capacity(count),
            gap: Vec::with_capacity(count),
            face: Vec::with_capacity(count),
            on_face: Vec::with_capacity(count),
            evaluations: Vec::with_capacity(count),
            complete: Vec::with_capacity(count),
            far: Vec::with_capacity(count),
        }
    }

    /// The closest points of a body to these places of its model; with `signed`, on which side of a closed body each
    /// of them is.
    pub fn of(body: &Body, points: &[[f64; 3]], signed: bool) -> Self {
        let sides = (signed && body.has_inside()).then(|| Sides::new(body.tables, &body.baked));
        let mut found = Self::with_room(points.len());
        for given in points {
            let probe = body.local(*given);
            let located = body.tables.locate(probe);
            let face = usize::from(located.face);
            let [u, v] = located.parameters;
            let point = body.placed(located.point);
            let distance = DVec3::from_array(point).distance(DVec3::from_array(*given));
            let is_inside = sides.as_ref().is_some_and(|sides| sides.is_inside(face, [u, v], probe.as_dvec3()));
            let source = &body.baked.faces[face].source;
            found.patch.push(source.patch as u32);
            found.parameters.push(source.parameters([u, v].map(f64::from)));
            found.point.push(point);
            found.gap.push(if is_inside { -distance } else { distance });
            found.face.push(face as u32);
            found.on_face.push([u, v]);
            found.evaluations.push(u32::from(located.evaluations));
            found.complete.push(located.complete);
            found.far.push(!body.tables.locator().holds(probe));
        }
        found
    }
}
