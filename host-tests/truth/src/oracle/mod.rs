//! The truth to compare with, in double precision and by other means than the library's: basis functions instead of
//! stored polynomials, many starts and Newton's method instead of the controller.

pub mod golden;

use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::patch::MAX_DEGREE;
use palpate_bake::{Axis, NurbsPatch};

// B-spline basis functions with two derivatives, by the recursion of Cox and de Boor.

const ORDER: usize = MAX_DEGREE + 1;

/// The `degree + 1` basis functions that are not zero at a parameter; the first belongs to control point `first`.
struct Basis {
    pub first: usize,
    /// `[derivative][function]`.
    pub values: [[f64; ORDER]; 3],
}

impl Basis {
    /// At a parameter in `[0, 1]`; on an inner knot the span above it is taken, at 1 the last.
    fn new(knots: &[f64], degree: usize, parameter: f64) -> Self {
        let points = knots.len() - degree - 1;
        let above = knots[degree + 1..points].partition_point(|knot| *knot <= parameter);
        let span = degree + above;
        let first = span - degree;
        // levels[d][k]: function k of degree d that is not zero on the span; it starts at knot span - d + k.
        let mut levels = [[0.0; ORDER]; ORDER];
        levels[0][0] = 1.0;
        for d in 1..=degree {
            for k in 0..=d {
                let start = span + k - d;
                let rising = if k > 0 { levels[d - 1][k - 1] } else { 0.0 };
                let falling = if k < d { levels[d - 1][k] } else { 0.0 };
                levels[d][k] = ratio(rising * (parameter - knots[start]), knots[start + d] - knots[start])
                    + ratio(falling * (knots[start + d + 1] - parameter), knots[start + d + 1] - knots[start + 1]);
            }
        }
        // N' = d (N⁻/width - N⁺/width) with the functions, or the derivatives, of one degree less.
        let differentiate = |lower: &[f64; ORDER], d: usize| {
            let mut derivative = [0.0; ORDER];
            for (k, entry) in derivative.iter_mut().enumerate().take(d + 1) {
                let start = span + k - d;
                let rising = if k > 0 { ratio(lower[k - 1], knots[start + d] - knots[start]) } else { 0.0 };
                let falling = if k < d { ratio(lower[k], knots[start + d + 1] - knots[start + 1]) } else { 0.0 };
                *entry = d as f64 * (rising - falling);
            }
            derivative
        };
        let first_derivative = differentiate(&levels[degree - 1], degree);
        let second_derivative = if degree >= 2 {
            differentiate(&differentiate(&levels[degree - 2], degree - 1), degree)
        } else {
            [0.0; ORDER]
        };
        Self { first, values: [levels[degree], first_derivative, second_derivative] }
    }
}

/// `0 / 0 = 0`, the convention of the recursion for functions that repeated knots have squeezed out.
fn ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { numerator / denominator } else { 0.0 }
}

// A patch with its first and second derivatives, in double precision.

/// A point of a patch with all derivatives up to the second; metres per unit of parameter, and per unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OraclePoint {
    /// `f(u, v)`.
    pub point: DVec3,
    /// `f_u`.
    pub tangent_u: DVec3,
    /// `f_v`.
    pub tangent_v: DVec3,
    /// `f_uu`.
    pub second_uu: DVec3,
    /// `f_uv`.
    pub second_uv: DVec3,
    /// `f_vv`.
    pub second_vv: DVec3,
}

impl OraclePoint {
    /// Evaluates a patch at `(u, v) ∈ [0, 1]²`.
    pub fn evaluate(patch: &NurbsPatch, u: f64, v: f64) -> Self {
        let along_u = Basis::new(&patch.knots[0], patch.degree[0], u);
        let along_v = Basis::new(&patch.knots[1], patch.degree[1], v);
        // Homogeneous sums [derivative along u][derivative along v] of (w x, w y, w z, w).
        let mut sums = [[DVec4::ZERO; 3]; 3];
        for i in 0..=patch.degree[0] {
            let mut row = [DVec4::ZERO; 3];
            for j in 0..=patch.degree[1] {
                let index = (along_u.first + i) * patch.counts[1] + along_v.first + j;
                let weighted = patch.points[index].extend(1.0) * patch.weights[index];
                for (entry, basis) in row.iter_mut().zip(&along_v.values) {
                    *entry += weighted * basis[j];
                }
            }
            for (sum, basis) in sums.iter_mut().zip(&along_u.values) {
                for (entry, value) in sum.iter_mut().zip(&row) {
                    *entry += *value * basis[i];
                }
            }
        }
        let [[f, f_v, f_vv], [f_u, f_uv, _], [f_uu, _, _]] = sums;
        // Leibniz' rule on w P = A, solved for the highest derivative of P.
        let inverse = 1.0 / f.w;
        let point = f.xyz() * inverse;
        let tangent_u = (f_u.xyz() - point * f_u.w) * inverse;
        let tangent_v = (f_v.xyz() - point * f_v.w) * inverse;
        Self {
            point,
            tangent_u,
            tangent_v,
            second_uu: (f_uu.xyz() - tangent_u * (2.0 * f_u.w) - point * f_uu.w) * inverse,
            second_uv: (f_uv.xyz() - tangent_u * f_v.w - tangent_v * f_u.w - point * f_uv.w) * inverse,
            second_vv: (f_vv.xyz() - tangent_v * (2.0 * f_v.w) - point * f_vv.w) * inverse,
        }
    }

    /// A patch's point and outward unit normal at `(u, v) ∈ [0, 1]²`; without a normal zero.
    pub fn place(patch: &NurbsPatch, u: f64, v: f64) -> (DVec3, DVec3) {
        let at = Self::evaluate(patch, u, v);
        let turn = if patch.flip { -1.0 } else { 1.0 };
        (at.point, at.tangent_u.cross(at.tangent_v).normalize_or_zero() * turn)
    }

    /// The unit normal `f_u × f_v`, turned round if `flip`.
    pub fn normal(&self, flip: bool) -> DVec3 {
        let normal = self.tangent_u.cross(self.tangent_v).normalize();
        if flip { -normal } else { normal }
    }

    /// The principal curvatures, 1/m, in ascending order, positive where the surface is convex seen from the side the
    /// normal points to; NaN where the tangents span no plane. Eigenvalues of `−I⁻¹ II`.
    pub fn principal_curvatures(&self, flip: bool) -> [f64; 2] {
        let normal = self.normal(flip);
        let (e, f, g) =
            (self.tangent_u.length_squared(), self.tangent_u.dot(self.tangent_v), self.tangent_v.length_squared());
        let [l, m, n] = [self.second_uu, self.second_uv, self.second_vv].map(|second| -normal.dot(second));
        let determinant = e * g - f * f;
        let mean = (e * n - 2.0 * f * m + g * l) / (2.0 * determinant);
        let gauss = (l * n - m * m) / determinant;
        let half = (mean * mean - gauss).max(0.0).sqrt();
        [mean - half, mean + half]
    }
}

// The closest point of a whole patch, edges and corners included.

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
    /// The longest diagonal of a cell of the grid, metres.
    cell: f64,
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
        let points: Vec<_> = parameters[0].iter().flat_map(row).collect();
        let rows: Vec<_> = points.chunks(parameters[1].len()).collect();
        let diagonals = rows.windows(2).flat_map(|pair| {
            let falling = pair[0].iter().zip(&pair[1][1..]);
            let rising = pair[0][1..].iter().zip(pair[1]);
            falling.chain(rising).map(|(one, other)| one.distance(*other))
        });
        let cell = diagonals.fold(0.0, f64::max);
        Self { patch, parameters, points, cell }
    }

    /// The point of the patch closest to `query`, metres.
    pub fn closest(&self, query: DVec3) -> ClosestPoint {
        let [along_u, along_v] = &self.parameters;
        let (rows, columns) = (along_u.len(), along_v.len());
        let squares: Vec<f64> = self.points.iter().map(|point| point.distance_squared(query)).collect();
        let distance = |row: usize, column: usize| squares[row * columns + column];
        let around = |at: usize, count: usize| at.saturating_sub(1)..(at + 2).min(count);
        let is_end = |at: usize, count: usize| at == 0 || at + 1 == count;
        // Of the grid, or of one of its sides: near a corner there are minima on both within one interval.
        let is_local_minimum = |row: usize, column: usize| {
            let here = distance(row, column);
            let along_u = around(row, rows).all(|r| here <= distance(r, column));
            let along_v = around(column, columns).all(|c| here <= distance(row, c));
            (is_end(column, columns) && along_u)
                || (is_end(row, rows) && along_v)
                || along_u
                    && along_v
                    && around(row, rows).all(|r| around(column, columns).all(|c| here <= distance(r, c)))
        };
        let all = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let mut starts: Vec<_> = all.filter(|(row, column)| is_local_minimum(*row, *column)).collect();
        starts.sort_by(|a, b| distance(a.0, a.1).total_cmp(&distance(b.0, b.1)));
        let [nearest, others @ ..] = &starts[..] else { unreachable!("the grid has a smallest distance") };
        let found = |(row, column): (usize, usize)| self.newton([along_u[row], along_v[column]], query);
        others.iter().fold(found(*nearest), |best, start| {
            // A minimum lies within two cells of the grid's, so that what is farther away cannot be the nearest.
            if distance(start.0, start.1).sqrt() > best.distance + 2.0 * self.cell {
                return best;
            }
            let found = found(*start);
            if found.distance < best.distance { found } else { best }
        })
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
            // No double shows a shorter distance: the whole step, which has the digits of the parameters.
            if (gradient[0] * direction[0] + gradient[1] * direction[1]).abs() < f64::EPSILON * value {
                let candidate = [0, 1].map(|i| (at[i] + direction[i]).clamp(0.0, 1.0));
                let moved = OraclePoint::evaluate(self.patch, candidate[0], candidate[1]);
                if moved.point.distance_squared(query) <= value * (1.0 + 4.0 * f64::EPSILON) {
                    (at, surface) = (candidate, moved);
                }
                break;
            }
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
