//! Closest points from a standing start, a row a query.

use crate::body::Body;
use glam::DVec3;
use palpate::field::Mode;
use palpate::math::Vec3;
use palpate_bake::sides::Sides;
use palpate_truth::closest::{Solver, Status};
use palpate_truth::lower_bound::lower_bound;

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
    /// Whether a `q` is beyond its budget, and was set to it.
    pub clamped: Vec<bool>,
    /// A proved bound of how much nearer a point may be, m; not a number if none was wanted.
    pub error_bound: Vec<f64>,
}

/// One of them, in the frame of the tables.
struct Answer {
    face: usize,
    on_face: [f32; 2],
    point: Vec3,
    is_inside: bool,
    evaluations: u32,
    is_complete: bool,
    is_far: bool,
    is_clamped: bool,
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
            clamped: Vec::with_capacity(count),
            error_bound: Vec::with_capacity(count),
        }
    }

    /// The closest points of a body to these places of its model; with `signed`, on which side of a closed body each
    /// of them is; with `bounded`, how much nearer another may be.
    pub fn of(body: &Body, points: &[[f64; 3]], signed: bool, bounded: bool) -> Self {
        let sides = (signed && body.has_inside()).then(|| Sides::new(body.tables, &body.baked));
        let mut found = Self::with_room(points.len());
        for given in points {
            let probe = body.local(*given);
            let located = body.tables.locate(probe);
            let (face, on_face) = (usize::from(located.face), located.parameters);
            let is_inside = sides.as_ref().is_some_and(|sides| sides.is_inside(face, on_face, probe.as_dvec3()));
            let answer = Answer {
                face,
                on_face,
                point: located.point,
                is_inside,
                evaluations: u32::from(located.evaluations),
                is_complete: located.complete,
                is_far: !body.tables.locator().holds(probe),
                is_clamped: false,
            };
            let distance = answer.point.as_dvec3().distance(probe.as_dvec3());
            found.push(body, *given, &answer);
            let nearer = || (distance - lower_bound(&body.baked, probe.as_dvec3())).max(0.0);
            found.error_bound.push(if bounded { nearer() } else { f64::NAN });
        }
        found
    }

    /// The same of a body displaced by its modes: to each place its row of `q`, metres, one after the other.
    pub fn displaced(body: &Body, modes: &[Mode], points: &[[f64; 3]], q: &[f32], signed: bool) -> Self {
        let rigid = Solver::new(body.tables, &body.baked);
        let solver = rigid.deformed(modes);
        let mut found = Self::with_room(points.len());
        for (given, q) in points.iter().zip(q.chunks_exact(modes.len())) {
            let at = solver.cold(body.local(*given), q).0;
            let answer = Answer {
                face: at.face,
                on_face: at.on_face,
                point: at.point,
                is_inside: signed && at.is_inside,
                evaluations: at.evaluations,
                is_complete: at.status == Status::Converged,
                is_far: at.status == Status::Far,
                is_clamped: !solver.holds(q),
            };
            found.push(body, *given, &answer);
            found.error_bound.push(f64::NAN);
        }
        found
    }

    fn push(&mut self, body: &Body, given: [f64; 3], answer: &Answer) {
        let point = body.placed(answer.point);
        let distance = DVec3::from_array(point).distance(DVec3::from_array(given));
        let source = &body.baked.faces[answer.face].source;
        self.patch.push(source.patch as u32);
        self.parameters.push(source.parameters(answer.on_face.map(f64::from)));
        self.point.push(point);
        self.gap.push(if answer.is_inside { -distance } else { distance });
        self.face.push(answer.face as u32);
        self.on_face.push(answer.on_face);
        self.evaluations.push(answer.evaluations);
        self.complete.push(answer.is_complete);
        self.far.push(answer.is_far);
        self.clamped.push(answer.is_clamped);
    }
}
