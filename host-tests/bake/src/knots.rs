//! Knot vectors: their spans, and how smooth they leave a patch.

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
