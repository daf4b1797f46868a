//! Spheres without poles. The file's own parameters run together at two points; on a face that has one of them inside
//! it the surface is seen from elsewhere, or, where its holes leave no place for that, it is halved first; a whole
//! sphere is six faces of a cube.
//!
//! Seen from the point opposite the middle of a face, on the plane that touches it there, a sphere is a rational
//! surface of degree two (the stereographic projection): exact, and as smooth everywhere as it is there.

use crate::nurbs::{Curve, Surface};
use crate::part::{Edge, Face, Part, Use};
use glam::{DVec3, DVec4};
use std::collections::HashMap;
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// A face that reaches farther round from its middle than this cosine keeps its poles: seen from the other side it is
/// all rim.
const FARTHEST: f64 = -0.94;
/// Beyond the outline, as a part of its reach.
const MARGIN: f64 = 1.05;

/// A sphere, and whether its surface's normal points away from its centre.
#[derive(Clone, Copy)]
struct Sphere {
    centre: DVec3,
    radius: f64,
    /// From pole to pole.
    axis: DVec3,
    is_outward: bool,
}

/// Treatment of a sphere with holes that cannot be seen whole from any point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hollow {
    /// It stays as the file has it.
    Whole,
    /// It is halved.
    Halved,
}

/// Replaces the surface of every spherical face that has a pole inside it; says whether any was halved.
pub fn without_poles(part: &mut Part, hollow: Hollow) -> Hollow {
    let mut whole = Vec::new();
    let mut unseen = Vec::new();
    for face in 0..part.faces.len() {
        let Some(sphere) = Sphere::of(&part.faces[face]) else { continue };
        if part.faces[face].loops.is_empty() {
            whole.push((face, sphere));
        } else if let Some((middle, farthest)) = middle(part, face, &sphere) {
            part.faces[face].surface = sphere.seen_about(middle, MARGIN * reach_at(farthest));
        } else if hollow == Hollow::Halved && sphere.has_pole_in(part, face) {
            unseen.push((face, sphere));
        }
    }
    let six = whole.into_iter().map(|(face, sphere)| (face, sphere.as_cube(part, face))).collect::<Vec<_>>();
    let two = unseen.into_iter().filter_map(|(face, sphere)| Some((face, sphere.halved(part, face)?.to_vec())));
    let two = two.collect::<Vec<_>>();
    let done = if two.is_empty() { Hollow::Whole } else { Hollow::Halved };
    let mut pieces: Vec<_> = six.into_iter().chain(two).collect();
    // From the last, so that the places of those before hold.
    pieces.sort_by_key(|(face, _)| std::cmp::Reverse(*face));
    for (face, pieces) in pieces {
        part.faces.splice(face..=face, pieces);
    }
    done
}

/// How far from the middle, on the plane of parameters, points are at an angle of this cosine.
fn reach_at(cosine: f64) -> f64 {
    ((1.0 - cosine) / (1.0 + cosine)).sqrt()
}

/// The direction of the middle of a face that has a pole inside it, and the minimum cosine of the angle from it to its
/// outline.
fn middle(part: &Part, face: usize, sphere: &Sphere) -> Option<(DVec3, f64)> {
    let loops = sphere.outlines(part, face);
    let area = |points: &Vec<DVec3>| -> DVec3 {
        points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| a.cross(*b)).sum()
    };
    let windings = loops.iter().filter(|points| sphere.winds(points)).count();
    let outer = loops.iter().max_by(|a, b| area(a).length().total_cmp(&area(b).length()))?;
    // The face lies on the left, seen from where the surface's normal points.
    let middle = area(outer).normalize_or_zero() * if sphere.is_outward { 1.0 } else { -1.0 };
    let is_circle = outer.iter().all(|point| (point.dot(middle) - outer[0].dot(middle)).abs() < 1e-6);
    let has_pole = windings == 1 || (loops.len() == 1 && is_circle);
    let farthest = loops.iter().flatten().map(|point| point.dot(middle)).fold(1.0, f64::min);
    (has_pole && middle != DVec3::ZERO && farthest > FARTHEST).then_some((middle, farthest))
}

/// Points along an edge as a loop runs, the end left out.
fn around(part: &Part, used: Use) -> impl Iterator<Item = DVec3> + '_ {
    let at = move |k: i32| if used.reversed { 1.0 - f64::from(k) / 32.0 } else { f64::from(k) / 32.0 };
    (0..32).map(move |k| part.edges[used.edge].at(at(k))[0])
}

impl Sphere {
    /// That of a face whose surface goes from pole to pole.
    fn of(face: &Face) -> Option<Self> {
        let surface = &face.surface;
        let round = (0..2).find(|axis| surface.closed[*axis] && surface.poles[1 - axis] == [true; 2])?;
        if face.kind != "sphere" {
            return None;
        }
        let poles = [0, surface.points.len() - 1].map(|k| surface.points[k].truncate() / surface.points[k].w);
        let centre = 0.5 * (poles[0] + poles[1]);
        let middle = [0, 1].map(|axis| {
            let [low, high] = surface.range(axis);
            low + (high - low) * if axis == round { 0.3 } else { 0.5 }
        });
        let jet = surface.at(middle.into());
        let is_outward = jet.cross().dot(jet.point - centre) > 0.0;
        let radius = centre.distance(poles[0]);
        Some(Self { centre, radius, axis: (poles[1] - poles[0]).normalize_or_zero(), is_outward })
    }

    fn direction(&self, point: DVec3) -> DVec3 {
        (point - self.centre).normalize_or_zero()
    }

    /// Whether a loop of directions goes round the axis.
    fn winds(&self, points: &[DVec3]) -> bool {
        let across = self.axis.any_orthonormal_vector();
        let angle = |point: &DVec3| point.dot(self.axis.cross(across)).atan2(point.dot(across));
        let pairs = points.iter().zip(points.iter().cycle().skip(1));
        let turned: f64 = pairs.map(|(a, b)| (angle(b) - angle(a) + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU).sum();
        turned.abs() > 0.5 * TAU
    }

    /// The sphere seen about a direction, over `[−reach, reach]²`: `(2x, 2y, 1 − x² − y²) / (1 + x² + y²)` in axes of
    /// which the third is that direction.
    fn seen_about(&self, middle: DVec3, reach: f64) -> Surface {
        let first = middle.any_orthonormal_vector();
        let second = middle.cross(first);
        let [first, second] = if self.is_outward { [first, second] } else { [second, first] };
        // Blossoms of x and x² at the control points of two parabolas, from −reach to 0 and on to reach.
        let linear = [-reach, -0.5 * reach, 0.0, 0.5 * reach, reach];
        let square = [reach * reach, 0.0, 0.0, 0.0, reach * reach];
        let knots = vec![-reach, -reach, -reach, 0.0, 0.0, reach, reach, reach];
        let point = |i: usize, j: usize| -> DVec4 {
            let weight = 1.0 + square[i] + square[j];
            let place = first * (2.0 * linear[i]) + second * (2.0 * linear[j]) + middle * (2.0 - weight);
            (self.centre * weight + place * self.radius).extend(weight)
        };
        let points = (0..25).map(|k| point(k / 5, k % 5)).collect();
        let [closed, touching, poles] = [[false; 2]; 3];
        let poles = [poles; 2];
        Surface { degree: [2; 2], knots: [knots.clone(), knots], counts: [5; 2], points, closed, touching, poles }
    }

    /// Six faces of a whole sphere, between the projections of a cube's edges.
    fn as_cube(&self, part: &mut Part, face: usize) -> Vec<Face> {
        let up = self.axis;
        let right = up.any_orthonormal_vector();
        let axes = [right, up.cross(right), up];
        let corner = |bits: usize| -> DVec3 {
            let sign = |axis: usize| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
            (0..3).map(|axis| axes[axis] * sign(axis)).sum::<DVec3>().normalize()
        };
        let first = part.vertices.len();
        part.vertices.extend((0..8).map(|bits| self.centre + corner(bits) * self.radius));
        let mut edges: HashMap<[usize; 2], usize> = HashMap::new();
        let mut six = Vec::with_capacity(6);
        for (axis, high) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
            let [a, b] = [(axis + 1) % 3, (axis + 2) % 3];
            // Counter-clockwise seen from outside, if the surface's normal points there.
            let mut round = [0, 1 << a, 1 << a | 1 << b, 1 << b].map(|bits: usize| bits | high << axis);
            if (high == 1) != self.is_outward {
                round.reverse();
            }
            let mut uses = Vec::with_capacity(4);
            for k in 0..4 {
                let [from, to] = [round[k], round[(k + 1) % 4]];
                let key = [from.min(to), from.max(to)];
                let edge = *edges.entry(key).or_insert_with(|| {
                    let curve = self.arc(key.map(corner));
                    part.edges.push(Edge::whole(curve, key.map(|bits| first + bits), None));
                    part.edges.len() - 1
                });
                uses.push(Use { edge, reversed: from > to });
            }
            let middle = axes[axis] * if high == 1 { 1.0 } else { -1.0 };
            let farthest = corner(round[0]).dot(middle);
            let surface = self.seen_about(middle, MARGIN * reach_at(farthest));
            six.push(Face { surface, loops: vec![uses], ..part.faces[face].clone() });
        }
        six
    }

    /// The shorter arc between two directions.
    fn arc(&self, [from, to]: [DVec3; 2]) -> Curve {
        let weight = (0.5 * (1.0 + from.dot(to))).sqrt();
        // Homogeneous: the tangents at the ends meet at (from + to) / (1 + from · to).
        let middle = (from + to) * (self.radius / (1.0 + from.dot(to)));
        let point = |direction: DVec3, weight: f64| ((self.centre + direction) * weight).extend(weight);
        let points = vec![point(from * self.radius, 1.0), point(middle, weight), point(to * self.radius, 1.0)];
        Curve { degree: 2, knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points }
    }
}

// A sphere with holes that no place has a view of: halved along a great circle that keeps clear of all of them.

/// Great circles that are tried.
const TRIED: usize = 600;
/// The minimum sine of the angle between the circle and an outline: below it, quads between them would be slivers.
const CLEARANCE: f64 = 0.1;
/// A pole that is nearer to a point of an outline, as a part of the radius, lies on it: of a whole great circle they
/// are twice as far apart.
const ON_THE_OUTLINE: f64 = 0.1;

impl Sphere {
    /// Whether one of its poles lies inside a face of it, not on an outline: by the first outline on ways from there,
    /// which must agree.
    fn has_pole_in(&self, part: &Part, face: usize) -> bool {
        let loops = self.outlines(part, face);
        let pairs: Vec<[DVec3; 2]> = (loops.iter())
            .flat_map(|points| points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| [*a, *b]))
            .collect();
        let ways = [0, pairs.len() / 3, 2 * pairs.len() / 3];
        [self.axis, -self.axis].into_iter().any(|pole| {
            let is_clear = pairs.iter().all(|[at, _]| at.distance(pole) > ON_THE_OUTLINE);
            is_clear && ways.iter().all(|way| pairs.get(*way).is_some_and(|to| self.begins_inside(pole, *to, &pairs)))
        })
    }

    /// Whether the way from a point to the middle of a piece of the outline starts inside.
    fn begins_inside(&self, point: DVec3, [from, to]: [DVec3; 2], outline: &[[DVec3; 2]]) -> bool {
        // The face lies on the left, seen from where the surface's normal points.
        let sense = if self.is_outward { 1.0 } else { -1.0 };
        let target = 0.5 * (from + to);
        let aside = point.cross(target);
        let met = outline.iter().filter_map(|[a, b]| {
            let [near, far] = [a.dot(aside), b.dot(aside)];
            let at = (*a * far - *b * near) / (far - near);
            let is_met = (near < 0.0) != (far < 0.0) && at.dot(target - point * target.dot(point)) > 0.0;
            is_met.then(|| (at.dot(point), sense * a.cross(*b).dot(point) > 0.0))
        });
        met.max_by(|a, b| a.0.total_cmp(&b.0)).is_some_and(|(_, is_left)| is_left)
    }

    /// Its loops as directions.
    fn outlines(&self, part: &Part, face: usize) -> Vec<Vec<DVec3>> {
        let of =
            |uses: &Vec<Use>| uses.iter().flat_map(|used| around(part, *used)).map(|at| self.direction(at)).collect();
        part.faces[face].loops.iter().map(of).collect()
    }

    /// A face in two, if a great circle keeps clear of its outlines.
    fn halved(&self, part: &mut Part, face: usize) -> Option<[Face; 2]> {
        let loops = self.outlines(part, face);
        let clearance = |up: &DVec3| loops.iter().flatten().map(|at| at.dot(*up).abs()).fold(1.0, f64::min);
        let best = (0..TRIED).map(|k| self.spread(k)).max_by(|a, b| clearance(a).total_cmp(&clearance(b)))?;
        // All points of a loop on one side.
        let is_apart =
            |points: &Vec<DVec3>| points.iter().all(|at| (at.dot(best) > 0.0) == (points[0].dot(best) > 0.0));
        if clearance(&best) < CLEARANCE || !loops.iter().all(is_apart) {
            return None;
        }
        let circle = self.great_circle(best);
        part.vertices.push(circle.at(circle.range()[0])[0]);
        part.edges.push(Edge::whole(circle, [part.vertices.len() - 1; 2], None));
        let edge = part.edges.len() - 1;
        Some([1.0, -1.0].map(|side| {
            let up = best * side;
            let of = &part.faces[face];
            let on_this_side = of.loops.iter().zip(&loops).filter(|(_, points)| points[0].dot(up) > 0.0);
            // Counter-clockwise round its own half seen from outside, if the surface's normal points there.
            let reversed = (side > 0.0) != self.is_outward;
            let mut own = vec![vec![Use { edge, reversed }]];
            own.extend(on_this_side.map(|(uses, _)| uses.clone()));
            Face { surface: self.seen_about(up, MARGIN), loops: own, ..of.clone() }
        }))
    }

    /// Directions spread evenly over the half about the axis; the first is the axis.
    fn spread(&self, index: usize) -> DVec3 {
        let height = 1.0 - index as f64 / TRIED as f64;
        // Turned by the golden section each, none lies above another.
        let angle = TAU * (index as f64 * 0.618_033_988_749_894_9).fract();
        let across = self.axis.any_orthonormal_vector();
        let way = across * angle.cos() + self.axis.cross(across) * angle.sin();
        way * (1.0 - height * height).sqrt() + self.axis * height
    }

    /// Counter-clockwise about a direction, as four quarters of a rational parabola each.
    fn great_circle(&self, up: DVec3) -> Curve {
        let first = up.any_orthonormal_vector();
        let second = up.cross(first);
        let corners = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]];
        let point = |(index, [x, y]): (usize, [i32; 2])| -> DVec4 {
            let weight = if index % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 };
            let way = first * f64::from(x) + second * f64::from(y);
            ((self.centre + way * self.radius) * weight).extend(weight)
        };
        let points = corners.into_iter().enumerate().map(point).collect();
        let knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(f64::from).to_vec();
        Curve { degree: 2, knots, points }
    }
}
