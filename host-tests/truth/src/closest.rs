//! Closest points of a model with the firmware's own code: from a standing start, or tick after tick.

use crate::lower_bound::lower_bound;
use palpate::body::{Body, BodyWitness, Edge, Face, Feature, Side, Soft, SoftWitness};
use palpate::field::{Displacement as _, Mode};
use palpate::math::Vec3;
use palpate::track::{Contact, Controller, Probe};
use palpate_bake::BakedBody;
use palpate_bake::sides::Sides;

/// Finds closest points.
#[derive(Debug)]
pub struct Solver<'a> {
    body: &'a Body<'a>,
    baked: &'a BakedBody,
    sides: Sides<'a>,
    is_closed: bool,
}

/// How a closest point was come by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Cold: every candidate was searched to its end.
    Converged,
    /// Cold: a candidate was given up short of its minimum.
    StepLimit,
    /// Cold: the query is farther off than the locator's tables reach. The list of the nearest cell was searched, which
    /// is not proved to hold the closest point of a query from there.
    Far,
    /// One row of a track.
    Tracking,
    /// One row of a track while the body is touched: the point is the god-object, and the sign that of its gap.
    GodObject,
}

/// A closest point, in the model's terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Index of the model's patch; a point that several share is on any of them.
    pub patch: usize,
    /// `(u, v)` on it.
    pub parameters: [f64; 2],
    /// Index of the body's face.
    pub face: usize,
    /// `(u, v)` on it.
    pub on_face: [f32; 2],
    /// The point, metres.
    pub point: Vec3,
    /// Whether the probe is inside a closed body.
    pub is_inside: bool,
    /// Evaluations of patches spent.
    pub evaluations: u32,
    /// How.
    pub status: Status,
}

impl<'a> Solver<'a> {
    /// For a body and the tables it was made of.
    pub fn new(body: &'a Body<'a>, baked: &'a BakedBody) -> Self {
        Self { body, baked, sides: Sides::new(body, baked), is_closed: baked.topology.is_closed() }
    }

    /// The closest point from a standing start, and the state to track on from. `probe` in metres.
    pub fn cold(&self, probe: Vec3) -> (Found, BodyWitness) {
        let mut state = self.body.start();
        // The same search, one evaluation a tick; it ends within the bound of `Body::locate`.
        let located = self.body.locate(probe);
        while !state.is_located {
            self.body.step(&Controller::SecondOrder, &mut state, Probe::at(probe), 1.0);
        }
        let status = match (self.body.locator().holds(probe), located.complete) {
            (false, _) => Status::Far,
            (true, true) => Status::Converged,
            (true, false) => Status::StepLimit,
        };
        let face = usize::from(located.face);
        let found = self.found(face, located.parameters, located.point, probe);
        (Found { evaluations: u32::from(located.evaluations), status, ..found }, state)
    }

    /// Follows a probe that has moved: `ticks` ticks of the tracker, and after a jump further ticks until the closest
    /// point is located again. `probe` in metres.
    pub fn track(&self, state: &mut BodyWitness, probe: Vec3, ticks: u32) -> Found {
        let mut evaluations = 0;
        let mut spent = 0;
        while spent < ticks || !state.is_located {
            spent += 1;
            // The gain is certified, not a rate: the period does not matter.
            let step = self.body.step(&Controller::SecondOrder, state, Probe::at(probe), 1.0);
            evaluations += u32::from(step.evaluations);
        }
        let (face, parameters) = self.on_a_face(state);
        let found = self.found(face, parameters, state.witness.surface.point, probe);
        if state.contact == Contact::Touching {
            let is_inside = self.is_closed && state.gap < 0.0;
            return Found { evaluations, is_inside, status: Status::GodObject, ..found };
        }
        Found { evaluations, ..found }
    }

    /// A bound of the error of a distance that was found, metres; `probe` in metres.
    pub fn error_bound(&self, found: &Found, probe: Vec3) -> f64 {
        let distance = found.point.as_dvec3().distance(probe.as_dvec3());
        (distance - lower_bound(self.baked, probe.as_dvec3())).max(0.0)
    }

    /// The same for the body deformed by modes: a search on it, and the tracker from there.
    ///
    /// # Panics
    /// If the modes are not valid.
    pub fn deformed(&self, modes: &'a [Mode]) -> SoftSolver<'_> {
        SoftSolver { rigid: self, soft: Soft::new(*self.body, modes).unwrap() }
    }

    fn found(&self, face: usize, parameters: [f32; 2], point: Vec3, probe: Vec3) -> Found {
        let source = &self.baked.faces[face].source;
        Found {
            patch: source.patch,
            parameters: source.parameters(parameters.map(f64::from)),
            face,
            on_face: parameters,
            point,
            is_inside: self.is_closed && self.sides.is_inside(face, parameters, probe.as_dvec3()),
            evaluations: 0,
            status: Status::Tracking,
        }
    }

    /// A witness point on an edge or a vertex lies on a face, too.
    fn on_a_face(&self, state: &BodyWitness) -> (usize, [f32; 2]) {
        let edge = match state.feature {
            Feature::Face(face) => return (usize::from(face), state.witness.parameters),
            Feature::Edge(edge) => Some((edge, state.witness.parameters[0])),
            Feature::Vertex(vertex) => {
                let end = |(index, edge): (usize, &Edge)| {
                    let t = if edge.ends[0] == vertex { 0.0 } else { 1.0 };
                    edge.ends.contains(&vertex).then_some((index as u16, t))
                };
                self.body.edges().iter().enumerate().find_map(end)
            }
        };
        let Some((edge, t)) = edge else { return (0, [0.5; 2]) };
        let of = self.body.edges()[usize::from(edge)].faces[0];
        let face = usize::from(of.face);
        (face, on_side(&self.body.faces()[face], of.side, t))
    }
}

/// Finds closest points of a body that deforms.
#[derive(Debug)]
pub struct SoftSolver<'a> {
    rigid: &'a Solver<'a>,
    soft: Soft<'a>,
}

impl SoftSolver<'_> {
    /// Ticks of the tracker after the search: it goes over the borders of the candidates that the list names.
    const SETTLING: u32 = 16;

    /// The closest point from a standing start at a `q` that stays, and the state to track on from. Metres.
    pub fn cold(&self, probe: Vec3, q: &[f32]) -> (Found, SoftWitness) {
        let located = self.soft.locate(probe, q);
        let mut state = self.soft.start();
        let mut settled = 0;
        let mut evaluations = u32::from(located.evaluations);
        while settled < Self::SETTLING {
            let step = self.soft.step(&Controller::SecondOrder, &mut state, Probe::at(probe), q, 1.0);
            settled += u32::from(state.body.is_located);
            evaluations += u32::from(step.body.evaluations);
        }
        let mut found = self.found(&state.body, probe, q);
        if located.point.distance(probe) < found.point.distance(probe) {
            found = self.at(usize::from(located.face), located.parameters, located.point, probe, q);
        }
        let status = match (self.soft.rest().locator().holds(probe), located.complete) {
            (false, _) => Status::Far,
            (true, true) => Status::Converged,
            (true, false) => Status::StepLimit,
        };
        (Found { evaluations, status, ..found }, state)
    }

    /// [`Solver::track`] at this row's `q`. Metres.
    pub fn track(&self, state: &mut SoftWitness, probe: Vec3, q: &[f32], ticks: u32) -> Found {
        let (mut evaluations, mut spent) = (0, 0);
        while spent < ticks || !state.body.is_located {
            spent += 1;
            let step = self.soft.step(&Controller::SecondOrder, state, Probe::at(probe), q, 1.0);
            evaluations += u32::from(step.body.evaluations);
        }
        let found = self.found(&state.body, probe, q);
        if state.body.contact == Contact::Touching {
            let is_inside = self.rigid.is_closed && state.body.gap < 0.0;
            return Found { evaluations, is_inside, status: Status::GodObject, ..found };
        }
        Found { evaluations, ..found }
    }

    /// Whether every `q` is within its mode's limit.
    pub fn holds(&self, q: &[f32]) -> bool {
        self.soft.field(q).holds(q)
    }

    fn found(&self, state: &BodyWitness, probe: Vec3, q: &[f32]) -> Found {
        let (face, parameters) = self.rigid.on_a_face(state);
        self.at(face, parameters, state.witness.surface.point, probe, q)
    }

    /// A probe is inside if the point that is displaced to it is inside the body at rest (theory §15).
    fn at(&self, face: usize, parameters: [f32; 2], point: Vec3, probe: Vec3, q: &[f32]) -> Found {
        let rest = (&self.soft.field(q)).undo(probe, 0.0);
        let is_inside = self.rigid.cold(rest).0.is_inside;
        Found { point, is_inside, ..self.rigid.found(face, parameters, point, rest) }
    }
}

/// The parameters of a face at the parameter of an edge along one of its sides.
fn on_side(face: &Face, side: u8, t: f32) -> [f32; 2] {
    let reversed = matches!(face.sides[usize::from(side)], Side::Edge { reversed: true, .. });
    let along = if reversed { 1.0 - t } else { t };
    match side {
        0 => [0.0, along],
        1 => [1.0, along],
        2 => [along, 0.0],
        _ => [along, 1.0],
    }
}
