//! Knot vectors: what makes one good, its spans, and the map of its range to `[0, 1]`.

use super::error::Fault;
use super::patch::Axis;
use palpate::patch::MAX_SPANS;

/// Checks a knot vector for `points` control points of `degree` and maps its range, `knots[degree]` to
/// `knots[points]`, to `[0, 1]`. The knots of an unclamped vector beyond its range stay outside.
pub(super) fn check(knots: Vec<f64>, axis: Axis, points: usize, degree: usize) -> Result<Vec<f64>, Fault> {
    if knots.len() != points + degree + 1 {
        return Err(Fault::KnotCount { axis, count: knots.len(), points, degree });
    }
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return Err(Fault::KnotNotFinite { axis, index, value: knots[index] });
    }
    if let Some(index) = (1..knots.len()).find(|&index| knots[index] < knots[index - 1]) {
        return Err(Fault::KnotDecreases { axis, index, value: knots[index], before: knots[index - 1] });
    }
    let (first, last) = (knots[degree], knots[points]);
    let width = last - first;
    if width.is_nan() || width <= 0.0 {
        return Err(Fault::EmptyRange { axis, value: first });
    }
    for group in knots.chunk_by(|a, b| a == b) {
        let (value, times) = (group[0], group.len());
        if first < value && value < last && times > degree {
            return Err(Fault::Torn { axis, value, times, degree });
        }
        if times > degree + 1 {
            return Err(Fault::EndMultiplicity { axis, value, times, degree });
        }
    }
    let mapped: Vec<f64> = knots.iter().map(|knot| (knot - first) / width).collect();
    let borders = borders(&mapped, degree);
    if borders.len() - 1 > MAX_SPANS {
        return Err(Fault::TooManySpans { axis, count: borders.len() - 1 });
    }
    // A narrower span is less than one step of f32 near 1, and far narrower than any that is meant. NaN comes of knots
    // whose range overflows.
    let is_wide = |pair: &[f64]| pair[1] - pair[0] >= f64::from(f32::EPSILON) && (pair[0] as f32) < pair[1] as f32;
    if let Some(pair) = borders.windows(2).find(|pair| !is_wide(pair)) {
        let back = |mapped: f64| first + mapped * width;
        return Err(Fault::KnotsTooNear { axis, first: back(pair[0]), second: back(pair[1]) });
    }
    Ok(mapped)
}

/// The knots of a Bézier patch.
pub(super) fn bezier(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.resize(2 * (degree + 1), 1.0);
    knots
}

/// The distinct knots within the range, from 0 to 1: the borders of the spans.
pub(super) fn borders(knots: &[f64], degree: usize) -> Vec<f64> {
    let mut borders = knots[degree..knots.len() - degree].to_vec();
    borders.dedup();
    borders
}

/// How many derivatives are continuous at all inner knots; `None` if there are no inner knots.
pub(super) fn continuity(knots: &[f64], degree: usize) -> Option<usize> {
    let inner = knots.chunk_by(|a, b| a == b).filter(|group| 0.0 < group[0] && group[0] < 1.0);
    inner.map(|group| degree - group.len()).min()
}

/// The inner knots at which only the points themselves are continuous.
pub(super) fn creases(knots: &[f64], degree: usize) -> Vec<f64> {
    let inner = knots.chunk_by(|a, b| a == b).filter(|group| 0.0 < group[0] && group[0] < 1.0);
    inner.filter(|group| group.len() >= degree).map(|group| group[0]).collect()
}
