//! A patch cut in two by inserting a knot (Boehm) until the control net falls apart there.

use crate::NurbsPatch;
use glam::{DVec4, Vec4Swizzles as _};

/// Knots nearer than this are one: some thousand roundings of `f64`.
const SAME_KNOT: f64 = 1e-12;

/// The parts below and above `at` along an axis (0 for `u`), each over the unit square again. Both have the very same
/// control points where they were one.
pub fn cut_in_two(patch: &NurbsPatch, axis: usize, at: f64) -> [NurbsPatch; 2] {
    let degree = patch.degree[axis];
    let lines = lines(patch, axis);
    // A cut that is meant for a knot is at the knot: beside it a span of no width would be left.
    let at = patch.knots[axis].iter().copied().find(|knot| (knot - at).abs() < SAME_KNOT).unwrap_or(at);
    let present = patch.knots[axis].iter().filter(|knot| **knot == at).count();
    let (mut knots, mut lines) = (patch.knots[axis].clone(), lines);
    for _ in present..degree {
        let span = knots.partition_point(|knot| *knot <= at) - 1;
        for line in &mut lines {
            *line = inserted(&knots, degree, line, span, at);
        }
        knots.insert(span + 1, at);
    }
    // The knot is there `degree` times now, or as often as it was. The control point that both parts share belongs to
    // the first of them.
    let first = knots.partition_point(|knot| *knot < at);
    let times = knots.partition_point(|knot| *knot <= at) - first;
    let shared = first + times - 1 - degree;
    let below: Vec<f64> = knots[..first + times].iter().copied().chain([at]).collect();
    let above: Vec<f64> = [at].into_iter().chain(knots[first + times - degree..].iter().copied()).collect();
    let mapped = |knots: Vec<f64>, low: f64, high: f64| -> Vec<f64> {
        // Ends to the last bit.
        let map = |knot: f64| if knot == high { 1.0 } else { (knot - low) / (high - low) };
        knots.into_iter().map(map).collect()
    };
    let part = |range: std::ops::RangeInclusive<usize>| lines.iter().map(|line| line[range.clone()].to_vec()).collect();
    let last = lines[0].len() - 1;
    [
        assembled(patch, axis, mapped(below, 0.0, at), part(0..=shared)),
        assembled(patch, axis, mapped(above, at, 1.0), part(shared..=last)),
    ]
}

/// The lines of control points along an axis, homogeneous.
fn lines(patch: &NurbsPatch, axis: usize) -> Vec<Vec<DVec4>> {
    let (along, across) = (patch.counts[axis], patch.counts[1 - axis]);
    let control = |k: usize, line: usize| {
        let index = if axis == 0 { k * patch.counts[1] + line } else { line * patch.counts[1] + k };
        patch.points[index].extend(1.0) * patch.weights[index]
    };
    (0..across).map(|line| (0..along).map(|k| control(k, line)).collect()).collect()
}

/// One line with the knot `at` inserted, which lies in the span that begins with knot `span`.
fn inserted(knots: &[f64], degree: usize, line: &[DVec4], span: usize, at: f64) -> Vec<DVec4> {
    let point = |k: usize| {
        if k + degree <= span {
            line[k]
        } else if k > span {
            line[k - 1]
        } else {
            let share = (at - knots[k]) / (knots[k + degree] - knots[k]);
            // Of no width where the knot is at the end of its support already: all of one point.
            if share >= 1.0 { line[k] } else { line[k - 1] * (1.0 - share) + line[k] * share }
        }
    };
    (0..=line.len()).map(point).collect()
}

fn assembled(patch: &NurbsPatch, axis: usize, knots: Vec<f64>, lines: Vec<Vec<DVec4>>) -> NurbsPatch {
    let mut counts = patch.counts;
    counts[axis] = lines[0].len();
    let entry = |index: usize| {
        let (i, j) = (index / counts[1], index % counts[1]);
        if axis == 0 { lines[j][i] } else { lines[i][j] }
    };
    let controls: Vec<DVec4> = (0..counts[0] * counts[1]).map(entry).collect();
    // Only ratios of weights matter. By a power of two, so that the parts of a border keep the same bits but for the
    // exponent.
    let largest = controls.iter().map(|control| control.w).fold(0.0, f64::max);
    let scale = (-largest.log2().ceil()).exp2();
    let mut all_knots = patch.knots.clone();
    all_knots[axis] = knots;
    NurbsPatch {
        name: patch.name.clone(),
        degree: patch.degree,
        knots: all_knots,
        counts,
        points: controls.iter().map(|control| control.xyz() / control.w).collect(),
        weights: controls.iter().map(|control| control.w * scale).collect(),
        flip: patch.flip,
    }
}
