//! The closest point of a whole patch, edges and corners included.

use super::OraclePoint;
use glam::DVec3;
use palpate_bake::{Axis, NurbsPatch};

/// A closest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoint {
    /// `(u, v)`.
    pub parameters: [f64; 2],
    /// `f(u, v)`, metres.
    pub point: DVec3,
    /// Its distance from the query, metres.
    pub distance: f64,
}

/// Finds closest points of one patch: Newton's method from every local minimum of a dense grid and of its sides.
///
/// Global as far as the grid sees every basin: 12 intervals a span and at least 24 in all; it is checked against
/// independent golden points.
#[derive(Clone, Debug)]
pub struct Oracle<'a> {
    patch: &'a NurbsPatch,
    parameters: [Vec<f64>; 2],
    points: Vec<DVec3>,
}

const INTERVALS_PER_SPAN: usize = 12;
const LEAST_INTERVALS: usize = 24;
/// Newton doubles the digits from any grid start; the rest is for stretches of damped gradient steps.
const ITERATIONS: usize = 60;

impl<'a> Oracle<'a> {
    /// Samples the patch.
    pub fn new(patch: &'a NurbsPatch) -> Self {
        let parameters = [Axis::U, Axis::V].map(|axis| {
            let borders = patch.borders(axis);
            let steps = INTERVALS_PER_SPAN.max(LEAST_INTERVALS.div_ceil(borders.len() - 1));
            let inside = |pair: &[f64]| {
                let (left, width) = (pair[0], pair[1] - pair[0]);
                (0..steps).map(move |step| left + width * step as f64 / steps as f64)
            };
            borders.windows(2).flat_map(inside).chain([1.0]).collect::<Vec<_>>()
        });
        let row =
            |u: &f64| parameters[1].iter().map(|v| OraclePoint::evaluate(patch, *u, *v).point).collect::<Vec<_>>();
        let points = parameters[0].iter().flat_map(row).collect();
        Self { patch, parameters, points }
    }

    /// The point of the patch closest to `query`, metres.
    pub fn closest(&self, query: DVec3) -> ClosestPoint {
        let [along_u, along_v] = &self.parameters;
        let (rows, columns) = (along_u.len(), along_v.len());
        let distance = |row: usize, column: usize| self.points[row * columns + column].distance_squared(query);
        let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let is_end = |at: usize, count: usize| at == 0 || at + 1 == count;
        // Of the grid, or of one of its sides: near a corner there are minima on both within one interval.
        let is_local_minimum = |row: usize, column: usize| {
            let here = distance(row, column);
            let along_u = around(row, rows).all(|r| here <= distance(r, column));
            let along_v = around(column, columns).all(|c| here <= distance(row, c));
            (is_end(column, columns) && along_u)
                || (is_end(row, rows) && along_v)
                || around(row, rows).all(|r| around(column, columns).all(|c| here <= distance(r, c)))
        };
        let mut best: Option<ClosestPoint> = None;
        for (row, &u) in along_u.iter().enumerate() {
            for (column, &v) in along_v.iter().enumerate() {
                if is_local_minimum(row, column) {
                    let found = self.newton([u, v], query);
                    if best.is_none_or(|best| found.distance < best.distance) {
                        best = Some(found);
                    }
                }
            }
        }
        best.unwrap_or_else(|| unreachable!("the least of the grid is a local minimum of the grid"))
    }

    /// Newton on ½‖f − Q‖² over the unit square: parameters that press against their border are held, the others take
    /// the Newton step where the Hessian is positive definite and the Gauss–Newton step where not, halved until the
    /// distance falls.
    fn newton(&self, start: [f64; 2], query: DVec3) -> ClosestPoint {
        let mut at = start;
        let mut surface = OraclePoint::evaluate(self.patch, at[0], at[1]);
        for _ in 0..ITERATIONS {
            let difference = surface.point - query;
            let gradient = [difference.dot(surface.tangent_u), difference.dot(surface.tangent_v)];
            let held = [0, 1].map(|i| (at[i] <= 0.0 && gradient[i] > 0.0) || (at[i] >= 1.0 && gradient[i] < 0.0));
            let Some(direction) = descent(&surface, difference, gradient, held) else { break };
            let value = difference.length_squared();
            let mut scale = 1.0;
            let next = loop {
                let candidate = [0, 1].map(|i| (at[i] + scale * direction[i]).clamp(0.0, 1.0));
                let moved = OraclePoint::evaluate(self.patch, candidate[0], candidate[1]);
                if moved.point.distance_squared(query) < value {
                    break Some((candidate, moved));
                }
                scale *= 0.5;
                // Below this a step no longer moves a double.
                if scale < 1e-12 {
                    break None;
                }
            };
            let Some(next) = next else { break };
            (at, surface) = next;
        }
        ClosestPoint { parameters: at, point: surface.point, distance: surface.point.distance(query) }
    }
}

/// The Newton or Gauss–Newton direction in the free parameters; `None` if nothing is left to do.
fn descent(surface: &OraclePoint, difference: DVec3, gradient: [f64; 2], held: [bool; 2]) -> Option<[f64; 2]> {
    let first = [surface.tangent_u.length_squared(), surface.tangent_v.length_squared()];
    let mixed = surface.tangent_u.dot(surface.tangent_v);
    let curved = [first[0] + difference.dot(surface.second_uu), first[1] + difference.dot(surface.second_vv)];
    let curved_mixed = mixed + difference.dot(surface.second_uv);
    // A pole has no tangent: the floor keeps the division finite and the step harmless.
    let alone = |i: usize| {
        let hessian = if curved[i] > 0.0 { curved[i] } else { first[i] };
        -gradient[i] / hessian.max(1e-300)
    };
    let direction = match held {
        [true, true] => return None,
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            let solve = |diagonal: [f64; 2], mixed: f64| {
                let determinant = diagonal[0] * diagonal[1] - mixed * mixed;
                let positive = diagonal[0] > 0.0 && determinant > 1e-12 * diagonal[0] * diagonal[1];
                positive.then(|| {
                    [
                        (mixed * gradient[1] - diagonal[1] * gradient[0]) / determinant,
                        (mixed * gradient[0] - diagonal[0] * gradient[1]) / determinant,
                    ]
                })
            };
            solve(curved, curved_mixed)
                .or_else(|| solve(first, mixed))
                .unwrap_or_else(|| [0, 1].map(|i| -gradient[i] / first[i].max(1e-300)))
        }
    };
    (direction != [0.0, 0.0]).then_some(direction)
}
