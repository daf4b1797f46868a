//! A sphere with holes that no place has a view of: halved along a great circle that keeps clear of all of them.

use super::{MARGIN, Sphere, around};
use crate::nurbs::Curve;
use crate::part::{Edge, Face, Part, Use};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Great circles that are tried.
const TRIED: usize = 600;
/// The least sine of the angle between the circle and an outline: nearer, quads between them would be slivers.
const CLEARANCE: f64 = 0.1;
/// A pole that is nearer to a point of an outline, as a part of the radius, lies on it: of a whole great circle they
/// are twice as far apart.
const ON_THE_OUTLINE: f64 = 0.1;

impl Sphere {
    /// Whether one of its poles lies inside a face of it, not on an outline: by the first outline on ways from there,
    /// which must agree.
    pub(super) fn has_pole_in(&self, part: &Part, face: usize) -> bool {
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

    /// Whether the way from a point to the middle of a piece of the outline begins inside.
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
    pub(super) fn outlines(&self, part: &Part, face: usize) -> Vec<Vec<DVec3>> {
        let of =
            |uses: &Vec<Use>| uses.iter().flat_map(|used| around(part, *used)).map(|at| self.direction(at)).collect();
        part.faces[face].loops.iter().map(of).collect()
    }

    /// A face in two, if a great circle keeps clear of its outlines.
    pub(super) fn halved(&self, part: &mut Part, face: usize) -> Option<[Face; 2]> {
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
