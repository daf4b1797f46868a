//! The stored table of a patch in `f64`: the surface the target has, without the rounding of its arithmetic.

use crate::BakedPatch;
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::patch::span_centre;

/// A patch from its stored coefficients.
#[derive(Clone, Debug)]
pub struct StoredSurface {
    degree: [usize; 2],
    breaks: [Vec<f32>; 2],
    spans: Vec<Vec<[f64; 4]>>,
}

/// A point with its derivatives, metres per unit of parameter and unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StoredPoint {
    /// `f`.
    pub point: DVec3,
    /// `f_u`, `f_v`.
    pub first: [DVec3; 2],
    /// `f_uu`, `f_uv`, `f_vv`.
    pub second: [DVec3; 3],
}

impl StoredSurface {
    /// Widens the numbers of a table.
    pub fn new(patch: &BakedPatch) -> Self {
        let degree = patch.degree.map(usize::from);
        let count = (patch.breaks[0].len() - 1) * (patch.breaks[1].len() - 1);
        let spans = (0..count).map(|span| patch.coefficients.homogeneous_span(degree, span)).collect();
        Self { degree, breaks: patch.breaks.clone(), spans }
    }

    /// Evaluates at `(u, v)`.
    pub fn evaluate(&self, parameters: [f64; 2]) -> StoredPoint {
        let [(i, s), (j, t)] = [0, 1].map(|axis| {
            let breaks = &self.breaks[axis];
            let inner = &breaks[1..breaks.len() - 1];
            let span = inner.partition_point(|border| f64::from(*border) <= parameters[axis]);
            (span, parameters[axis] - f64::from(span_centre(breaks[span], breaks[span + 1])))
        });
        let powers = &self.spans[i * (self.breaks[1].len() - 1) + j];
        // Horner with two derivatives, half the second: rows along t, then along s.
        let mut sums = [[DVec4::ZERO; 3]; 3];
        for row in powers.chunks_exact(self.degree[1] + 1).rev() {
            let mut along = [DVec4::ZERO; 3];
            for entry in row.iter().rev() {
                along = [along[0] * t + DVec4::from_array(*entry), along[1] * t + along[0], along[2] * t + along[1]];
            }
            for (column, value) in along.iter().enumerate() {
                let [zeroth, once, twice] = [sums[0][column], sums[1][column], sums[2][column]];
                (sums[0][column], sums[1][column], sums[2][column]) =
                    (zeroth * s + *value, once * s + zeroth, twice * s + once);
            }
        }
        let (f, f_u, f_v) = (sums[0][0], sums[1][0], sums[0][1]);
        let (f_uu, f_uv, f_vv) = (sums[2][0] * 2.0, sums[1][1], sums[0][2] * 2.0);
        let inverse = 1.0 / f.w;
        let point = f.xyz() * inverse;
        let first = [f_u, f_v].map(|d| (d.xyz() - point * d.w) * inverse);
        let second = [
            f_uu.xyz() - first[0] * (2.0 * f_u.w) - point * f_uu.w,
            f_uv.xyz() - first[0] * f_v.w - first[1] * f_u.w - point * f_uv.w,
            f_vv.xyz() - first[1] * (2.0 * f_v.w) - point * f_vv.w,
        ];
        StoredPoint { point, first, second: second.map(|d| d * inverse) }
    }

    /// A local minimum of the distance over a rectangle of parameters: projected Newton from a start in it, with the
    /// steps it took.
    pub fn descend(&self, query: DVec3, start: [f64; 2], rectangle: [[f64; 2]; 2]) -> Minimum {
        let [low, high] = rectangle;
        let mut at = start;
        let mut here = self.evaluate(at);
        let mut evaluations = 1;
        for _ in 0..60 {
            let difference = here.point - query;
            let gradient = here.first.map(|tangent| difference.dot(tangent));
            let held =
                [0, 1].map(|i| (at[i] <= low[i] && gradient[i] >= 0.0) || (at[i] >= high[i] && gradient[i] <= 0.0));
            let direction = descent(&here, difference, gradient, held);
            if direction == [0.0, 0.0] {
                break;
            }
            let value = difference.length_squared();
            // Of φ a step gains at most this: nothing that doubles would show.
            if -(gradient[0] * direction[0] + gradient[1] * direction[1]) <= 1e-15 * value {
                break;
            }
            let mut scale = 1.0;
            let mut moved = None;
            while scale > 1e-10 {
                let next = [0, 1].map(|i| (at[i] + scale * direction[i]).clamp(low[i], high[i]));
                let there = self.evaluate(next);
                evaluations += 1;
                if there.point.distance_squared(query) < value {
                    moved = Some((next, there));
                    break;
                }
                scale *= 0.5;
            }
            let Some(next) = moved else { break };
            (at, here) = next;
        }
        Minimum { parameters: at, point: here.point, distance: here.point.distance(query), evaluations }
    }
}

/// Where a descent ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// `(u, v)`.
    pub parameters: [f64; 2],
    /// `f(u, v)`.
    pub point: DVec3,
    /// From the query, metres.
    pub distance: f64,
    /// Evaluations spent.
    pub evaluations: usize,
}

/// The Newton direction in the free parameters where the second derivative is positive definite, else the Gauss–Newton
/// one.
fn descent(here: &StoredPoint, difference: DVec3, gradient: [f64; 2], held: [bool; 2]) -> [f64; 2] {
    let [e, g] = here.first.map(|tangent| tangent.length_squared().max(1e-300));
    let f = here.first[0].dot(here.first[1]);
    let [uu, uv, vv] = here.second.map(|second| difference.dot(second));
    let alone = |i: usize| {
        let (plain, bent) = if i == 0 { (e, e + uu) } else { (g, g + vv) };
        -gradient[i] / if bent > 1e-6 * plain { bent } else { plain }
    };
    let solve = |[a, b, c]: [f64; 3]| {
        let determinant = a * c - b * b;
        (a > 0.0 && determinant > 1e-12 * a * c.abs()).then(|| {
            [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
        })
    };
    match held {
        [true, true] => [0.0, 0.0],
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            solve([e + uu, f + uv, g + vv]).or_else(|| solve([e, f, g])).unwrap_or([-gradient[0] / e, -gradient[1] / g])
        }
    }
}
