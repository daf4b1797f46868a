//! Content of a patch's file, and the checks that turn it into a patch.

use super::error::PatchFault;
use super::patch::NurbsPatch;
use crate::patch::Axis;
use crate::patch::{bezier, borders};
use glam::DVec3;
use palpate::patch::{MAX_DEGREE, MAX_SPANS};
use serde::Deserialize;

/// A patch as it stands in the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawPatch {
    pub name: Option<String>,
    // A list of any length: read as a pair, the parser would drop a third number without a word.
    pub degree: Vec<i64>,
    pub knots_u: Option<Vec<f64>>,
    pub knots_v: Option<Vec<f64>>,
    pub points: Vec<Vec<Vec<f64>>>,
    #[serde(default)]
    pub flip: bool,
}

impl RawPatch {
    pub fn check(self, per_metre: f64) -> Result<NurbsPatch, PatchFault> {
        if self.name.as_deref() == Some("") {
            return Err(PatchFault::EmptyName);
        }
        NurbsPatch::from_raw(self, per_metre)
    }
}

/// Lengths for which squares and products of four of them stay far inside the range of `f32`.
const SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e3;

/// Differences and products of two such knots stay inside the range of `f64`.
const LARGEST_KNOT: f64 = 1e150;

/// Spans of a patch in all: as many of degree 3 take some 200 KB of flash, and some seconds to prove.
const MOST_CELLS: usize = 1024;

/// A patch thinner than the spacing of `f32` is a curve in the table.
const LEAST_AREA: f64 = f32::EPSILON as f64;

impl NurbsPatch {
    /// Checks a patch as it stands in a file whose unit goes `per_metre` times into a metre.
    fn from_raw(raw: RawPatch, per_metre: f64) -> Result<Self, PatchFault> {
        let [along_u, along_v] = raw.degree[..] else {
            return Err(PatchFault::DegreeCount { count: raw.degree.len() });
        };
        let mut degree = [0; 2];
        for (axis, index, given) in [(Axis::U, 0, along_u), (Axis::V, 1, along_v)] {
            degree[index] = usize::try_from(given)
                .ok()
                .filter(|degree| (1..=MAX_DEGREE).contains(degree))
                .ok_or(PatchFault::Degree { axis, degree: given })?;
        }
        let counts = [raw.points.len(), raw.points.first().map_or(0, Vec::len)];
        if let Some((row, points)) = raw.points.iter().enumerate().find(|(_, points)| points.len() != counts[1]) {
            return Err(PatchFault::RaggedRow { row, count: points.len(), expected: counts[1] });
        }
        let [knots_u, knots_v] = [(Axis::U, 0, raw.knots_u), (Axis::V, 1, raw.knots_v)].map(|(axis, index, knots)| {
            let (count, degree) = (counts[index], degree[index]);
            match knots {
                _ if count <= degree => Err(PatchFault::TooFewPoints { axis, count, degree }),
                Some(knots) => check_knots(knots, axis, count, degree),
                None if count != degree + 1 => Err(PatchFault::BezierPoints { axis, count, degree }),
                None => Ok(bezier(degree)),
            }
        });
        let knots = [knots_u?, knots_v?];
        let [u, v] = [0, 1].map(|axis| borders(&knots[axis], degree[axis]).len() - 1);
        if u * v > MOST_CELLS {
            return Err(PatchFault::TooManyCells { u, v, limit: MOST_CELLS });
        }
        let mut points = Vec::with_capacity(counts[0] * counts[1]);
        let mut weights = Vec::with_capacity(points.capacity());
        for (row, entries) in raw.points.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                let (point, weight) = check_point(entry, row, column)?;
                points.push(point / per_metre);
                weights.push(weight);
            }
        }
        // Only ratios of weights matter; kept at most 1 they cannot overflow.
        let largest = weights.iter().copied().fold(0.0, f64::max);
        weights.iter_mut().for_each(|weight| *weight /= largest);
        let patch = Self { name: raw.name, degree, knots, counts, points, weights, flip: raw.flip };
        patch.check_extent()?;
        Ok(patch)
    }

    fn check_extent(&self) -> Result<(), PatchFault> {
        let size = self.size();
        if size == 0.0 {
            return Err(PatchFault::NoArea);
        }
        // Also refuses NaN, from coordinates that overflow.
        if !SIZES.contains(&size) {
            return Err(PatchFault::Size { size });
        }
        // f_u × f_v has degree 3 p - 1 at most: a grid of 15 intervals a span misses it only if it is 0 everywhere.
        let mut largest: f64 = 0.0;
        self.for_each_sample(15, |_, surface| {
            largest = largest.max(surface.tangent_u.cross(surface.tangent_v).length());
            largest <= LEAST_AREA * size * size
        });
        if largest <= LEAST_AREA * size * size { Err(PatchFault::NoArea) } else { Ok(()) }
    }
}

/// A point and its weight, 1 if it has none.
fn check_point(entry: &[f64], row: usize, column: usize) -> Result<(DVec3, f64), PatchFault> {
    let ([x, y, z], weight) = match *entry {
        [x, y, z] => ([x, y, z], 1.0),
        [x, y, z, w] => ([x, y, z], w),
        _ => return Err(PatchFault::PointLength { row, column, count: entry.len() }),
    };
    for (coordinate, value) in [('x', x), ('y', y), ('z', z)] {
        if !value.is_finite() {
            return Err(PatchFault::Coordinate { row, column, coordinate, value });
        }
    }
    if !(weight > 0.0 && weight < f64::INFINITY) {
        return Err(PatchFault::Weight { row, column, value: weight });
    }
    Ok((DVec3::new(x, y, z), weight))
}

/// Checks a knot vector for `points` control points of `degree` and maps its range, `knots[degree]` to
/// `knots[points]`, to `[0, 1]`. The knots of an unclamped vector beyond its range stay outside.
fn check_knots(knots: Vec<f64>, axis: Axis, points: usize, degree: usize) -> Result<Vec<f64>, PatchFault> {
    if knots.len() != points + degree + 1 {
        return Err(PatchFault::KnotCount { axis, count: knots.len(), points, degree });
    }
    if let Some(index) = knots.iter().position(|knot| !knot.is_finite()) {
        return Err(PatchFault::KnotNotFinite { axis, index, value: knots[index] });
    }
    if let Some(index) = knots.iter().position(|knot| knot.abs() > LARGEST_KNOT) {
        return Err(PatchFault::KnotTooLarge { axis, index, value: knots[index], limit: LARGEST_KNOT });
    }
    if let Some(index) = (1..knots.len()).find(|&index| knots[index] < knots[index - 1]) {
        return Err(PatchFault::KnotDecreases { axis, index, value: knots[index], before: knots[index - 1] });
    }
    let (first, last) = (knots[degree], knots[points]);
    let width = last - first;
    if width.is_nan() || width <= 0.0 {
        return Err(PatchFault::EmptyRange { axis, value: first });
    }
    for group in knots.chunk_by(|a, b| a == b) {
        let (value, times) = (group[0], group.len());
        if first < value && value < last && times > degree {
            return Err(PatchFault::Torn { axis, value, times, degree });
        }
        if times > degree + 1 {
            return Err(PatchFault::EndMultiplicity { axis, value, times, degree });
        }
    }
    let mapped: Vec<f64> = knots.iter().map(|knot| (knot - first) / width).collect();
    let borders = borders(&mapped, degree);
    if borders.len() - 1 > MAX_SPANS {
        return Err(PatchFault::TooManySpans { axis, count: borders.len() - 1 });
    }
    // A narrower span is less than one step of f32 near 1, and far narrower than any that is meant.
    let is_wide = |pair: &[f64]| pair[1] - pair[0] >= f64::from(f32::EPSILON) && (pair[0] as f32) < pair[1] as f32;
    if let Some(pair) = borders.windows(2).find(|pair| !is_wide(pair)) {
        let back = |mapped: f64| first + mapped * width;
        return Err(PatchFault::KnotsTooNear { axis, first: back(pair[0]), second: back(pair[1]) });
    }
    Ok(mapped)
}
