//! Proved upper bounds of the second and third derivatives of a baked patch.
//!
//! # Why it is a proof
//! - The bound is of the surface the target has: it starts from the stored `f32` coefficients, so their rounding is
//!   included, over each span as the target's `f32` subtraction sees it (one part in 2²³ wider than the span).
//! - A second derivative of a polynomial span is a polynomial. In Bernstein form its values are means of its
//!   coefficients `Nᵢⱼ`, and a norm is convex: `‖f_xy‖ ≤ max ‖Nᵢⱼ‖`.
//! - A second derivative of a rational span `A / w` is `N / w³` with, by the quotient rule twice, `M = A_x w − A w_x`,
//!   `N = M_y w − 2 M w_y`. With both in Bernstein form of one degree and all `Wᵢⱼ` of `w³` positive, `N / w³` is the
//!   mean of the `Nᵢⱼ / Wᵢⱼ` with the positive shares `Wᵢⱼ Bᵢⱼ`, so `‖f_xy‖ ≤ max ‖Nᵢⱼ‖ / Wᵢⱼ`. A third derivative is
//!   `(N_z w − 3 N w_z) / w⁴`, and the same holds.
//! - What a second derivative jumps across a knot is the difference of two such quotients of one parameter, on one
//!   denominator again such a quotient.
//! - Halving a cell keeps all of this, and brings the bound down to the supremum quadratically. Cells are halved until
//!   the bound is within [`SLACK`] of a value the derivative takes (the corners of cells are values), or [`HALVINGS`]
//!   times: the bound is then looser, never wrong.
//! - What double precision rounds on the way is bounded from above and added (`ROUNDING`); the result is rounded up.
//!
//! It bounds each span. Across an inner knot the second derivative may jump, and both sides are bounded; where the
//! patch has a crease (it is only C⁰) there is no second derivative and the bound says nothing *about the crease*.

use super::bernstein::Bernstein;
use crate::spline::BakedCoefficients;
use palpate::patch::{SecondDerivativeBounds, ThirdDerivativeBounds, span_centre};

/// How far a bound may lie above the supremum.
pub const SLACK: f64 = 0.05;
/// How often a cell is halved at most: 10 times along each parameter, a cell a thousandth of a span wide.
pub const HALVINGS: usize = 20;
/// How often the border between two spans is halved for the bound of a jump.
const JUMP_HALVINGS: usize = 5;
/// Error bound of `‖N‖` from rounding in `f64`, relative to `max‖A‖ · max w²` on the unit square. Each difference of
/// neighbours is at most 2 · 5 times the coefficients (two of them: 100), at most 10 terms of `N` have that size, and
/// no coefficient has seen more than 4000 roundings of 2⁻⁵³ (sums of up to 36 products, twice; 20 rounds of up to 15
/// averages): 100 · 10 · 4000 · 1.1e-16.
const ROUNDING: f64 = 4.5e-10;
/// The same for a third derivative, relative to `max‖A‖ · max w³`: of degree 10 and 15 differences of neighbours are 2
/// · 10 and 2 · 15 times the coefficients,
/// `M ≤ 20`, `N ≤ 2 · 20 · 20`, and `N_z w − 3 N w_z ≤ 800 · (30 + 3 · 10)`; no coefficient has seen more than 8000
/// roundings: 48 000 · 8000 · 1.1e-16.
const ROUNDING_THIRD: f64 = 4.3e-8;
/// Bound of the relative loss of `w³` or `w⁴` from rounding: sums and means of positive numbers have no cancellation;
/// only the change of basis does: 50 roundings of the largest weight, where the smallest is a thousandth of it.
const WEIGHT_ROUNDING: f64 = 1e-10;

/// The bounds of a table, or `None` if a weight is not proved positive or a bound is beyond `f32`.
pub fn prove(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
) -> Option<SecondDerivativeBounds> {
    let bound = |axes: [usize; 2]| supremum(degree, breaks, coefficients, &axes).and_then(round_up);
    Some(SecondDerivativeBounds { uu: bound([0, 0])?, uv: bound([0, 1])?, vv: bound([1, 1])? })
}

/// The same of the third derivatives, and of the jumps of the second; `has_crease` says along which parameter the patch
/// is only C⁰ somewhere: there is no bound then.
pub fn prove_third(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
    has_crease: [bool; 2],
) -> Option<ThirdDerivativeBounds> {
    let bound = |axes: [usize; 3]| supremum(degree, breaks, coefficients, &axes).and_then(round_up);
    let (uuu, uuv, uvv, vvv) = (bound([0, 0, 0])?, bound([0, 0, 1])?, bound([0, 1, 1])?, bound([1, 1, 1])?);
    // The last bit of a parameter on a knot: the spans are bounded a little beyond it.
    let jump = |axis: usize, third: f32| {
        let beyond = 2.0 * f64::from(f32::EPSILON) * f64::from(third);
        if has_crease[axis] {
            Some(f32::INFINITY)
        } else {
            round_up(largest_jump(degree, breaks, coefficients, &[axis, axis])? + beyond)
        }
    };
    Some(ThirdDerivativeBounds { uuu, uuv, uvv, vvv, jump_uu: jump(0, uuu)?, jump_vv: jump(1, vvv)? })
}

/// The same of a curve: `sup ‖c'''‖`, and the largest jump of `c''`. At a crease, where `c'` jumps by more than the
/// rounding of the table to `f32`, there is no bound.
pub fn prove_third_of_curve(degree: usize, breaks: &[f32], coefficients: &BakedCoefficients) -> Option<[f32; 2]> {
    if degree == 0 {
        return Some([0.0; 2]);
    }
    let breaks = [breaks.to_vec(), vec![0.0, 1.0]];
    let third = supremum([degree, 0], &breaks, coefficients, &[0, 0, 0]).and_then(round_up)?;
    let longest = supremum([degree, 0], &breaks, coefficients, &[0])?;
    if largest_jump([degree, 0], &breaks, coefficients, &[0])? > CREASE * longest {
        return Some([third, f32::INFINITY]);
    }
    let beyond = 2.0 * f64::from(f32::EPSILON) * f64::from(third);
    Some([third, round_up(largest_jump([degree, 0], &breaks, coefficients, &[0, 0])? + beyond)?])
}

/// A jump of the tangent beyond this part of the longest is a crease: a hundred roundings of a coefficient to `f32`.
const CREASE: f64 = 1e-5;

/// The largest jump of a derivative along an axis over the knots of it; without inner knots 0.
fn largest_jump(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
    axes: &[usize],
) -> Option<f64> {
    let axis = axes[0];
    let counts = [breaks[0].len() - 1, breaks[1].len() - 1];
    if counts[axis] == 1 {
        return Some(0.0);
    }
    let cell = |at: [usize; 2]| {
        let ranges = [0, 1].map(|axis| local_range(breaks[axis][at[axis]], breaks[axis][at[axis] + 1]));
        let span = at[0] * counts[1] + at[1];
        DerivativeCell::of_span(degree, &coefficients.homogeneous_span(degree, span), ranges, axes)
    };
    let mut largest: f64 = 0.0;
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            if [i, j][axis] + 1 == counts[axis] {
                continue;
            }
            let after = if axis == 0 { [i + 1, j] } else { [i, j + 1] };
            largest = largest.max(DerivativeCell::jump(&cell([i, j])?, &cell(after)?, axis)?);
        }
    }
    Some(largest)
}

/// The bound `sup ‖c''‖` of a curve, which is a surface that does not change along `v`; `None` as of [`prove`]. A
/// polynomial curve may be of degree 10: two differences are then up to 4 · 10 · 9 times the coefficients, still within
/// the `100 · 10` that `ROUNDING` reckons with.
pub fn prove_curve(degree: usize, breaks: &[f32], coefficients: &BakedCoefficients) -> Option<f32> {
    if degree == 0 {
        return Some(0.0);
    }
    let breaks = [breaks.to_vec(), vec![0.0, 1.0]];
    supremum([degree, 0], &breaks, coefficients, &[0, 0]).and_then(round_up)
}

/// The numerator and the power of `w` on one cell.
struct DerivativeCell {
    field: Bernstein<4>,
    rounding: f64,
    halvings: usize,
}

impl DerivativeCell {
    /// At least the largest value on the cell.
    fn upper(&self) -> f64 {
        let above = |[x, y, z, w]: &[f64; 4]| ((x * x + y * y + z * z).sqrt() + self.rounding) / w;
        self.field.coefficients.iter().map(above).fold(0.0, f64::max) * (1.0 + WEIGHT_ROUNDING)
    }

    /// The most that rounding can have added: a derivative that is all rounding is not worth halving.
    fn added(&self) -> f64 {
        self.rounding / self.field.coefficients.iter().map(|[.., w]| *w).fold(f64::INFINITY, f64::min)
    }

    /// The largest value at the four corners.
    fn lower(&self) -> f64 {
        let [p, q] = self.field.degree;
        let corners = [(0, 0), (0, q), (p, 0), (p, q)];
        let value = |(i, j): (usize, usize)| {
            let [x, y, z, w] = *self.field.at(i, j);
            (x * x + y * y + z * z).sqrt() / w
        };
        corners.into_iter().map(value).fold(0.0, f64::max)
    }
}

/// An upper bound of the norm of the derivative along two or three axes, over all spans.
fn supremum(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
    axes: &[usize],
) -> Option<f64> {
    // Of a polynomial that is derived more often than its degree, exactly.
    let is_zero = |axis: usize| axes.iter().filter(|along| **along == axis).count() > degree[axis];
    if (is_zero(0) || is_zero(1)) && matches!(coefficients, BakedCoefficients::Polynomial(_)) {
        return Some(0.0);
    }
    let spans_v = breaks[1].len() - 1;
    let spans = (breaks[0].len() - 1) * spans_v;
    let cell = |span: usize| {
        let reach = |axis: usize, index: usize| local_range(breaks[axis][index], breaks[axis][index + 1]);
        let ranges = [reach(0, span / spans_v), reach(1, span % spans_v)];
        DerivativeCell::of_span(degree, &coefficients.homogeneous_span(degree, span), ranges, axes)
    };
    // A value taken somewhere: what the bound may stay above by the slack. Only for speed; any value would do.
    let mut reached: f64 = 0.0;
    for span in 0..spans {
        reached = reached.max(cell(span)?.lower());
    }
    let mut bound: f64 = 0.0;
    for span in 0..spans {
        let mut open = vec![cell(span)?];
        while let Some(cell) = open.pop() {
            let upper = cell.upper();
            if !upper.is_finite() {
                return None;
            }
            reached = reached.max(cell.lower());
            if upper <= bound.max((1.0 + SLACK) * reached + 2.0 * cell.added()) || cell.halvings == HALVINGS {
                bound = bound.max(upper);
                continue;
            }
            // A curve has nothing to halve along v.
            let axis = if degree[1] == 0 { 0 } else { cell.halvings % 2 };
            let halves = cell.field.halves(axis);
            open.extend(halves.map(|field| DerivativeCell {
                field,
                rounding: cell.rounding,
                halvings: cell.halvings + 1,
            }));
        }
    }
    Some(bound)
}

impl DerivativeCell {
    /// The whole of a span; `None` if a weight is not positive.
    fn of_span(degree: [usize; 2], powers: &[[f64; 4]], ranges: [[f64; 2]; 2], axes: &[usize]) -> Option<Self> {
        let homogeneous = Bernstein::from_powers(degree, powers, ranges[0], ranges[1]);
        let points = homogeneous.components(|[x, y, z, _]| [*x, *y, *z]);
        let weight = homogeneous.components(|[.., w]| [*w]);
        let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
        let scale = largest(&mut points.coefficients.iter().flatten().copied());
        let weight_scale = largest(&mut weight.coefficients.iter().flatten().copied());
        if weight.coefficients.iter().any(|[w]| w.is_nan() || *w <= 0.0) {
            return None;
        }
        let constant = weight.coefficients.iter().all(|w| *w == [1.0]);
        let (numerator, denominator) = if constant {
            let derived = axes.iter().fold(points, |derived, axis| derived.derivative(*axis));
            (derived, Bernstein { degree: [0, 0], coefficients: vec![[1.0]] })
        } else {
            // (N / wᵏ)_x = (N_x w − k N w_x) / wᵏ⁺¹.
            let mut quotient = (points, weight.clone());
            for (order, axis) in (1_u8..).zip(axes) {
                let (n, power) = quotient;
                let derived =
                    n.derivative(*axis).times(&weight).plus(-f64::from(order), &n.times(&weight.derivative(*axis)));
                quotient = (derived, power.times(&weight));
            }
            quotient
        };
        // From the unit square to the span's own widths.
        let width = |axis: usize| ranges[axis][1] - ranges[axis][0];
        let factor = axes.iter().fold(1.0, |factor, axis| factor / width(*axis));
        let zero =
            Bernstein { degree: denominator.degree, coefficients: vec![[0.0; 3]; denominator.coefficients.len()] };
        let numerator = numerator.plus(0.0, &zero);
        let none = Bernstein { degree: numerator.degree, coefficients: vec![[0.0]; numerator.coefficients.len()] };
        let denominator = none.plus(1.0, &denominator);
        let join = |(n, w): (&[f64; 3], &[f64; 1])| [n[0] * factor, n[1] * factor, n[2] * factor, w[0]];
        let coefficients = numerator.coefficients.iter().zip(&denominator.coefficients).map(join).collect();
        let field = Bernstein { degree: numerator.degree, coefficients };
        let relative = if axes.len() < 3 { ROUNDING } else { ROUNDING_THIRD * weight_scale };
        let rounding = relative * 3.0_f64.sqrt() * scale * weight_scale * weight_scale * factor;
        Some(Self { field, rounding, halvings: 0 })
    }

    /// An upper bound of the difference of two cells' quotients along the border where the second one starts.
    fn jump(before: &Self, after: &Self, axis: usize) -> Option<f64> {
        let border = |cell: &Self, at: usize| {
            let [p, q] = cell.field.degree;
            let count = if axis == 0 { q } else { p };
            let entry = |k: usize| *(if axis == 0 { cell.field.at(at, k) } else { cell.field.at(k, at) });
            Bernstein { degree: [0, count], coefficients: (0..=count).map(entry).collect() }
        };
        let split =
            |field: &Bernstein<4>| (field.components(|[x, y, z, _]| [*x, *y, *z]), field.components(|[.., w]| [*w]));
        let (left, left_weight) = split(&border(before, before.field.degree[axis]));
        let (right, right_weight) = split(&border(after, 0));
        let difference = left.times(&right_weight).plus(-1.0, &right.times(&left_weight));
        let weights = left_weight.times(&right_weight);
        // Of one degree, and halved until the weights of a piece hardly differ.
        let degree = [0, difference.degree[1].max(weights.degree[1])];
        let none = Bernstein { degree, coefficients: vec![[0.0; 3]; degree[1] + 1] };
        let (difference, weights) = (none.plus(1.0, &difference), none.components(|_| [0.0]).plus(1.0, &weights));
        let join = |(n, w): (&[f64; 3], &[f64; 1])| [n[0], n[1], n[2], w[0]];
        let coefficients = difference.coefficients.iter().zip(&weights.coefficients).map(join).collect();
        let mut pieces = vec![Bernstein::<4> { degree, coefficients }];
        for _ in 0..JUMP_HALVINGS {
            pieces = pieces.iter().flat_map(|piece| piece.halves(1)).collect();
        }
        let above = |[x, y, z, w]: &[f64; 4]| (x * x + y * y + z * z).sqrt() / w;
        let jump = pieces.iter().flat_map(|piece| &piece.coefficients).map(above).fold(0.0, f64::max);
        // The products round by less than WEIGHT_ROUNDING of either side, and each side has its own rounding.
        let rounding = before.added() + after.added() + WEIGHT_ROUNDING * (before.upper() + after.upper());
        let bound = jump * (1.0 + WEIGHT_ROUNDING) + rounding;
        bound.is_finite().then_some(bound)
    }
}

/// The distances from a span's centre that the target can ask for: its subtraction rounds by at most half of this.
pub(super) fn local_range(left: f32, right: f32) -> [f64; 2] {
    let centre = f64::from(span_centre(left, right));
    [left, right].map(|border| (f64::from(border) - centre) * (1.0 + f64::from(f32::EPSILON)))
}

/// The smallest `f32` that is not below `value`.
fn round_up(value: f64) -> Option<f32> {
    let nearest = value as f32;
    let above = if f64::from(nearest) < value { nearest.next_up() } else { nearest };
    above.is_finite().then_some(above)
}
