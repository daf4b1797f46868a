//! A NURBS patch in double precision from the numbers of a table.
//!
//! A span's polynomial has a blossom: symmetric, affine in each argument, and the polynomial itself where all arguments
//! are one. A control point is the blossom at the knots that follow its own (Ramshaw, *Blossoms are polar forms*,
//! 1989), of any span that it reaches.

use crate::{BakedPatch, NurbsPatch};
use glam::DVec3;
use palpate::patch::{Orientation, span_centre};

/// The patch of a table, where `continuity` says how many derivatives are continuous at each inner border; `None` where
/// a weight is not positive.
pub(super) fn surface(baked: &BakedPatch, continuity: &[Vec<u8>; 2]) -> Option<NurbsPatch> {
    let degree = baked.degree.map(usize::from);
    let knots = [0, 1].map(|axis| knots(&baked.breaks[axis], degree[axis], &continuity[axis]));
    let counts = [0, 1].map(|axis| knots[axis].len() - degree[axis] - 1);
    let reached = [0, 1].map(|axis| -> Vec<Reached> {
        (0..counts[axis]).map(|point| Reached::new(&baked.breaks[axis], &knots[axis], degree[axis], point)).collect()
    });
    let spans_v = baked.breaks[1].len() - 1;
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for along_u in &reached[0] {
        for along_v in &reached[1] {
            let span = baked.coefficients.homogeneous_span(degree, along_u.span * spans_v + along_v.span);
            let mut sum = [0.0; 4];
            for (row, by_u) in span.chunks_exact(degree[1] + 1).zip(&along_u.shares) {
                for (power, by_v) in row.iter().zip(&along_v.shares) {
                    (0..4).for_each(|component| sum[component] += power[component] * by_u * by_v);
                }
            }
            let [x, y, z, weight] = sum;
            if !(weight > 0.0 && weight.is_finite()) {
                return None;
            }
            points.push(DVec3::new(x, y, z) / weight);
            weights.push(weight);
        }
    }
    let largest = weights.iter().copied().fold(0.0, f64::max);
    // Of a polynomial patch they are one but for the rounding of the sums.
    let is_polynomial = matches!(baked.coefficients, crate::BakedCoefficients::Polynomial(_));
    weights.iter_mut().for_each(|weight| *weight = if is_polynomial { 1.0 } else { *weight / largest });
    let flip = baked.orientation == Orientation::Inward;
    Some(NurbsPatch { name: baked.name.clone(), degree, knots, counts, points, weights, flip })
}

/// The clamped knots: an inner border as often as its continuity wants.
fn knots(breaks: &[f32], degree: usize, continuity: &[u8]) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    for (border, continuity) in breaks[1..breaks.len() - 1].iter().zip(continuity) {
        let times = degree.saturating_sub(usize::from(*continuity)).max(1);
        knots.resize(knots.len() + times, f64::from(*border));
    }
    knots.resize(knots.len() + degree + 1, 1.0);
    knots
}

/// How a control point follows from a span.
struct Reached {
    span: usize,
    /// By what each power of the span is multiplied.
    shares: Vec<f64>,
}

impl Reached {
    /// From the widest span that the point reaches: there the knots lie least far outside.
    fn new(breaks: &[f32], knots: &[f64], degree: usize, point: usize) -> Self {
        let [first, last] = [point, point + degree + 1].map(|knot| knots[knot]);
        let width = |span: usize| f64::from(breaks[span + 1]) - f64::from(breaks[span]);
        let reached = (0..breaks.len() - 1)
            .filter(|span| first <= f64::from(breaks[*span]) && f64::from(breaks[span + 1]) <= last);
        let span = reached.max_by(|a, b| width(*a).total_cmp(&width(*b))).unwrap_or_default();
        let centre = f64::from(span_centre(breaks[span], breaks[span + 1]));
        let arguments = &knots[point + 1..=point + degree];
        // Elementary symmetric polynomials, one argument after the other.
        let mut shares = vec![0.0; degree + 1];
        shares[0] = 1.0;
        for (count, argument) in arguments.iter().enumerate() {
            for power in (1..=count + 1).rev() {
                shares[power] += shares[power - 1] * (argument - centre);
            }
        }
        let mut binomial = 1.0;
        for (power, share) in shares.iter_mut().enumerate() {
            *share /= binomial;
            binomial *= (degree - power) as f64 / (power + 1) as f64;
        }
        Self { span, shares }
    }
}
