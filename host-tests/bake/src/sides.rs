//! On which side of a closed body a probe is, from the feature that holds its closest point.
//!
//! On a face the normal says it; on an edge the sum of the normals of its faces; at a vertex the sum over all of its
//! cone, which is in the tables ([`palpate::body::Vertex::outward`]). Each is exact where the feature does hold the
//! closest point, so the point that the firmware's arithmetic has found is first followed to its end in double
//! precision, over the borders too.

use crate::body::BakedBody;
use crate::locator::StoredSurface;
use glam::DVec3;
use palpate::body::{Body, EdgeFace, Side};
use palpate::math::Vec3;
use palpate::patch::Orientation;

/// Tells inside from outside.
#[derive(Debug)]
pub struct Sides<'a> {
    body: &'a Body<'a>,
    surfaces: Vec<StoredSurface>,
    turns: Vec<f64>,
}

/// A point on a face.
#[derive(Clone, Copy, Debug)]
struct Foot {
    face: usize,
    parameters: [f64; 2],
    distance: f64,
}

/// Maximum number of borders that a point is followed over: each brings it nearer, and no longer row of faces does.
const ROUNDS: usize = 8;
/// Start points along a side from which a face is tried: at a pole they give as many directions.
const STARTS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
/// A nearer point is one by more than this, relative to the distance: the rounding of `f64`.
const NEARER: f64 = 1e-14;
/// Normals whose sum is shorter than this are opposite: the faces are looked at this far from their edge instead.
const OPPOSITE: f64 = 1e-6;
/// Parameters from a pole below which the tangent around it may be rounding: coordinates are rounded by 6e-8 of the
/// size, a thousandth of this.
const POLE: f64 = 1e-4;
/// Rounding of a distance by that of the tables, relative to the size.
const POLE_ROUNDING: f64 = 2.0 * f32::EPSILON as f64;

impl<'a> Sides<'a> {
    /// For a body and the tables it was made of.
    pub fn new(body: &'a Body<'a>, baked: &BakedBody) -> Self {
        let surfaces = baked.faces.iter().map(|face| StoredSurface::new(&face.patch)).collect();
        let turn = |orientation| if orientation == Orientation::Outward { 1.0 } else { -1.0 };
        let turns = baked.faces.iter().map(|face| turn(face.patch.orientation)).collect();
        Self { body, surfaces, turns }
    }

    /// Whether a probe is inside, with a point of a face that is its closest one up to the rounding of `f32`.
    pub fn is_inside(&self, face: usize, parameters: [f32; 2], probe: DVec3) -> bool {
        let foot = self.followed(face, parameters.map(f64::from), probe);
        let towards = probe - self.surfaces[foot.face].evaluate(foot.parameters).point;
        self.outward(foot, probe).dot(towards) < 0.0
    }

    /// The local minimum of the distance to the whole body that a point leads to.
    fn followed(&self, face: usize, parameters: [f64; 2], probe: DVec3) -> Foot {
        let mut best = self.descended(face, parameters, probe);
        for _ in 0..ROUNDS {
            let others = self.beside(best, probe).into_iter().map(|(face, at)| self.descended(face, at, probe));
            let Some(other) = others.min_by(|a, b| a.distance.total_cmp(&b.distance)) else { break };
            if other.distance >= best.distance * (1.0 - NEARER) {
                break;
            }
            best = other;
        }
        best
    }

    fn descended(&self, face: usize, from: [f64; 2], probe: DVec3) -> Foot {
        let minimum = self.surfaces[face].descend(probe, from, [[0.0; 2], [1.0; 2]]);
        Foot { face, parameters: minimum.parameters, distance: minimum.distance }
    }

    /// The sides of its face that a point lies on, with the parameter along each.
    fn sides_at(&self, foot: Foot) -> impl Iterator<Item = (Side<'_>, f64)> {
        let [u, v] = foot.parameters;
        let at = [u <= 0.0, u >= 1.0, v <= 0.0, v >= 1.0];
        let sides = self.body.faces()[foot.face].sides;
        (0..4).filter(move |side| at[*side]).map(move |side| (sides[side], if side < 2 { v } else { u }))
    }

    /// The vertex a point lies on. A side that is one point in the model is a curve of some roundings in the tables:
    /// there, if the vertex is as near.
    fn vertex(&self, foot: Foot, probe: DVec3) -> Option<u16> {
        let near =
            self.body.faces()[foot.face].sides.iter().zip(away_from_sides(foot.parameters)).find_map(|(side, away)| {
                let Side::Pole { vertex } = *side else { return None };
                let at = self.body.vertices()[usize::from(vertex)].point.as_dvec3();
                let is_as_near = || at.distance(probe) <= foot.distance + POLE_ROUNDING * f64::from(self.body.size());
                (away <= POLE && is_as_near()).then_some(vertex)
            });
        if near.is_some() {
            return near;
        }
        let sides: Vec<_> = self.sides_at(foot).collect();
        match sides[..] {
            [(Side::Edge { edge, reversed, .. }, along), (Side::Edge { .. }, _)] => {
                let ends = self.body.edges()[usize::from(edge)].ends;
                Some(ends[usize::from((along > 0.5) != reversed)])
            }
            _ => None,
        }
    }

    /// The places on other faces, and elsewhere on its own, where a point lies too.
    fn beside(&self, foot: Foot, probe: DVec3) -> Vec<(usize, [f64; 2])> {
        if let Some(vertex) = self.vertex(foot, probe) {
            return self.around(vertex);
        }
        self.sides_at(foot)
            .flat_map(|(side, along)| match side {
                Side::Edge { edge, reversed, .. } => self.on_edge(edge, if reversed { 1.0 - along } else { along }),
                Side::Pole { .. } => Vec::new(),
            })
            .collect()
    }

    /// Where the faces of an edge have its point.
    fn on_edge(&self, edge: u16, t: f64) -> Vec<(usize, [f64; 2])> {
        let faces = self.body.edges()[usize::from(edge)].faces.into_iter().filter(|of| *of != EdgeFace::NONE);
        let place = |of: EdgeFace| {
            let face = usize::from(of.face);
            let reversed =
                matches!(self.body.faces()[face].sides[usize::from(of.side)], Side::Edge { reversed: true, .. });
            (face, on_side(of.side, if reversed { 1.0 - t } else { t }))
        };
        faces.map(place).collect()
    }

    /// Where faces touch a vertex.
    fn around(&self, vertex: u16) -> Vec<(usize, [f64; 2])> {
        let mut places = Vec::new();
        for (face, of) in self.body.faces().iter().enumerate() {
            for (number, side) in (0_u8..).zip(&of.sides) {
                match side {
                    Side::Pole { vertex: pole } if *pole == vertex => {
                        places.extend(STARTS.map(|along| (face, on_side(number, along))));
                    }
                    Side::Edge { edge, reversed, .. } => {
                        let ends = self.body.edges()[usize::from(*edge)].ends;
                        let at = [0, 1].into_iter().filter(|end| ends[*end] == vertex);
                        places.extend(at.map(|end| {
                            let along = if *reversed { 1 - end } else { end };
                            (face, on_side(number, along as f64))
                        }));
                    }
                    Side::Pole { .. } => {}
                }
            }
        }
        places
    }

    /// A vector out of the body at a local minimum; only which way it points matters.
    fn outward(&self, foot: Foot, probe: DVec3) -> DVec3 {
        let at_vertex = self.vertex(foot, probe).map(|vertex| self.body.vertices()[usize::from(vertex)].outward);
        if let Some(outward) = at_vertex.filter(|outward| *outward != Vec3::ZERO) {
            return outward.as_dvec3();
        }
        let edge = self.sides_at(foot).find_map(|(side, along)| match side {
            Side::Edge { edge, reversed, .. } => Some((edge, if reversed { 1.0 - along } else { along })),
            Side::Pole { .. } => None,
        });
        let Some((edge, t)) = edge else { return self.normal(foot.face, foot.parameters) };
        let places = self.on_edge(edge, t);
        let sum = |inset: f64| -> DVec3 {
            let within = |at: f64| inset + at * (1.0 - 2.0 * inset);
            places.iter().map(|(face, at)| self.normal(*face, at.map(within))).sum()
        };
        let normals = sum(0.0);
        if normals.length() > OPPOSITE { normals } else { sum(OPPOSITE) }
    }

    /// The normal; near a pole that of a point a little farther from it, because the tangent around a pole is rounding.
    fn normal(&self, face: usize, [mut u, mut v]: [f64; 2]) -> DVec3 {
        let is_pole = self.body.faces()[face].sides.map(|side| matches!(side, Side::Pole { .. }));
        let clear = |at: f64, [lower, upper]: [bool; 2]| {
            at.clamp(if lower { POLE } else { 0.0 }, if upper { 1.0 - POLE } else { 1.0 })
        };
        (u, v) = (clear(u, [is_pole[0], is_pole[1]]), clear(v, [is_pole[2], is_pole[3]]));
        let [along_u, along_v] = self.surfaces[face].evaluate([u, v]).first;
        along_u.cross(along_v).normalize_or_zero() * self.turns[face]
    }
}

/// How far parameters are from each side.
const fn away_from_sides([u, v]: [f64; 2]) -> [f64; 4] {
    [u, 1.0 - u, v, 1.0 - v]
}

/// A face's parameters at a place along one of its sides.
const fn on_side(side: u8, along: f64) -> [f64; 2] {
    match side {
        0 => [0.0, along],
        1 => [1.0, along],
        2 => [along, 0.0],
        _ => [along, 1.0],
    }
}
