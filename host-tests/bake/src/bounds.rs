//! Proved upper bounds of the second derivatives of a baked patch.
//!
//! # Why it is a proof
//! - The bound is of the surface the target has: it starts from the stored `f32` coefficients, so their rounding is
//!   included, over each span as the target's `f32` subtraction sees it (one part in 2²³ wider than the span).
//! - A second derivative of a polynomial span is a polynomial. In Bernstein form its values are means of its
//!   coefficients `Nᵢⱼ`, and a norm is convex: `‖f_xy‖ ≤ max ‖Nᵢⱼ‖`.
//! - A second derivative of a rational span `A / w` is `N / w³` with, by the quotient rule twice,
//!   `M = A_x w − A w_x`, `N = M_y w − 2 M w_y`. With both in Bernstein form of one degree and all `Wᵢⱼ` of `w³`
//!   positive, `N / w³` is the mean of the `Nᵢⱼ / Wᵢⱼ` with the positive shares `Wᵢⱼ Bᵢⱼ`, so `‖f_xy‖ ≤ max ‖Nᵢⱼ‖ / Wᵢⱼ`.
//! - Halving a cell keeps all of this, and brings the bound down to the supremum quadratically. Cells are halved until
//!   the bound is within [`SLACK`] of a value the derivative takes (the corners of cells are values), or
//!   [`HALVINGS`] times: the bound is then looser, never wrong.
//! - What double precision rounds on the way is bounded from above and added (`ROUNDING`); the result is rounded up.
//!
//! It bounds each span. Across an inner knot the second derivative may jump, and both sides are bounded; where the
//! patch has a crease (it is only C⁰) there is no second derivative and the bound says nothing *about the crease*.

use super::bernstein::Bernstein;
use super::coefficients::BakedCoefficients;
use palpate::patch::{SecondDerivativeBounds, span_centre};

/// How far a bound may lie above the supremum.
pub const SLACK: f64 = 0.05;
/// How often a cell is halved at most: 10 times along each parameter, a cell a thousandth of a span wide.
pub const HALVINGS: usize = 20;
/// What rounding in `f64` can add to `‖N‖`, relative to `max‖A‖ · max w²` on the unit square. Each difference of neighbours
/// is at most 2 · 5 times the coefficients (two of them: 100), at most 10 terms of `N` have that size, and
/// no coefficient has seen more than 4000 roundings of 2⁻⁵³ (sums of up to 36 products, twice; 20 rounds of up to
/// 15 averages): 100 · 10 · 4000 · 1.1e-16.
const ROUNDING: f64 = 4.5e-10;
/// What rounding can take from `w³`, relatively: sums and means of positive numbers lose nothing to cancellation, only
/// the change of basis does, 50 roundings of the largest weight where the least is a thousandth of it.
const WEIGHT_ROUNDING: f64 = 1e-10;

/// The bounds of a table, or `None` if a weight is not proved positive or a bound is beyond `f32`.
pub fn prove(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
) -> Option<SecondDerivativeBounds> {
    let bound = |axes: [usize; 2]| supremum(degree, breaks, coefficients, axes).and_then(round_up);
    Some(SecondDerivativeBounds { uu: bound([0, 0])?, uv: bound([0, 1])?, vv: bound([1, 1])? })
}

/// The bound `sup ‖c''‖` of a curve, which is a surface that does not change along `v`; `None` as of [`prove`]. A polynomial curve may be of degree
/// 10: two differences are then up to 4 · 10 · 9 times the coefficients, still within the `100 · 10` that `ROUNDING` reckons with.
pub fn prove_curve(degree: usize, breaks: &[f32], coefficients: &BakedCoefficients) -> Option<f32> {
    if degree == 0 {
        return Some(0.0);
    }
    let breaks = [breaks.to_vec(), vec![0.0, 1.0]];
    supremum([degree, 0], &breaks, coefficients, [0, 0]).and_then(round_up)
}

/// `N` and `w³` on one cell.
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

/// An upper bound of `‖∂²f/∂axes₀∂axes₁‖` over all spans.
fn supremum(
    degree: [usize; 2],
    breaks: &[Vec<f32>; 2],
    coefficients: &BakedCoefficients,
    axes: [usize; 2],
) -> Option<f64> {
    // Of a polynomial of degree 1, exactly.
    if axes[0] == axes[1] && degree[axes[0]] == 1 && matches!(coefficients, BakedCoefficients::Polynomial(_)) {
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
    fn of_span(degree: [usize; 2], powers: &[[f64; 4]], ranges: [[f64; 2]; 2], axes: [usize; 2]) -> Option<Self> {
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
            (points.derivative(axes[0]).derivative(axes[1]), Bernstein { degree: [0, 0], coefficients: vec![[1.0]] })
        } else {
            let [first, second] = axes;
            let once = points.derivative(first).times(&weight).plus(-1.0, &points.times(&weight.derivative(first)));
            let twice = once.derivative(second).times(&weight).plus(-2.0, &once.times(&weight.derivative(second)));
            (twice, weight.times(&weight).times(&weight))
        };
        // From the unit square to the span's own widths.
        let width = |axis: usize| ranges[axis][1] - ranges[axis][0];
        let factor = 1.0 / (width(axes[0]) * width(axes[1]));
        let zero =
            Bernstein { degree: denominator.degree, coefficients: vec![[0.0; 3]; denominator.coefficients.len()] };
        let numerator = numerator.plus(0.0, &zero);
        let none = Bernstein { degree: numerator.degree, coefficients: vec![[0.0]; numerator.coefficients.len()] };
        let denominator = none.plus(1.0, &denominator);
        let join = |(n, w): (&[f64; 3], &[f64; 1])| [n[0] * factor, n[1] * factor, n[2] * factor, w[0]];
        let coefficients = numerator.coefficients.iter().zip(&denominator.coefficients).map(join).collect();
        let field = Bernstein { degree: numerator.degree, coefficients };
        let rounding = ROUNDING * 3.0_f64.sqrt() * scale * weight_scale * weight_scale * factor;
        Some(Self { field, rounding, halvings: 0 })
    }
}

/// The distances from a span's centre that the target can ask for: its subtraction rounds by at most half of this.
pub(super) fn local_range(left: f32, right: f32) -> [f64; 2] {
    let centre = f64::from(span_centre(left, right));
    [left, right].map(|border| (f64::from(border) - centre) * (1.0 + f64::from(f32::EPSILON)))
}

/// The least `f32` that is not below.
fn round_up(value: f64) -> Option<f32> {
    let nearest = value as f32;
    let above = if f64::from(nearest) < value { nearest.next_up() } else { nearest };
    above.is_finite().then_some(above)
}
