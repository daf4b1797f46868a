//! A NURBS patch in double precision, and the checks that make one of what stands in a file.

use super::error::Fault;
use super::knots;
use super::model::RawPatch;
use crate::oracle::Surface;
use glam::DVec3;
use palpate::patch::MAX_DEGREE;
use std::fmt;

/// One of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// `u`, along the rows.
    U,
    /// `v`, along the columns.
    V,
}

impl fmt::Display for Axis {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::U => "u",
            Self::V => "v",
        })
    }
}

/// A NURBS patch over `[0, 1]²`, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsPatch {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Degrees along `u` and `v`.
    pub degree: [usize; 2],
    /// Knots along `u` and `v`; the range is `[0, 1]`, knots of an unclamped vector lie outside.
    pub knots: [Vec<f64>; 2],
    /// Numbers of control points along `u` and `v`.
    pub counts: [usize; 2],
    /// Control points, metres, not multiplied by their weights; point `(i, j)` is entry `i · counts[1] + j`.
    pub points: Vec<DVec3>,
    /// Weights; the largest is 1.
    pub weights: Vec<f64>,
    /// The outward normal is `f_u × f_v`; true turns it round.
    pub flip: bool,
}

/// Lengths for which squares and products of four of them stay far inside the range of `f32`.
const SIZES: std::ops::RangeInclusive<f64> = 1e-6..=1e3;
/// Coordinates above this many sizes leave less than 1e-5 of the size to the spacing of `f32`, 6e-8 of the coordinate.
const FARTHEST: f64 = 100.0;
/// A patch thinner than the spacing of `f32` is a curve in the table.
const LEAST_AREA: f64 = f32::EPSILON as f64;

impl NurbsPatch {
    /// Checks a patch as it stands in a file whose unit goes `per_metre` times into a metre.
    pub(super) fn from_raw(raw: RawPatch, per_metre: f64) -> Result<Self, Fault> {
        let mut degree = [0; 2];
        for (axis, index) in [(Axis::U, 0), (Axis::V, 1)] {
            let given = raw.degree[index];
            degree[index] = usize::try_from(given)
                .ok()
                .filter(|degree| (1..=MAX_DEGREE).contains(degree))
                .ok_or(Fault::Degree { axis, degree: given })?;
        }
        let counts = [raw.points.len(), raw.points.first().map_or(0, Vec::len)];
        if let Some((row, points)) = raw.points.iter().enumerate().find(|(_, points)| points.len() != counts[1]) {
            return Err(Fault::RaggedRow { row, count: points.len(), expected: counts[1] });
        }
        let [knots_u, knots_v] = [(Axis::U, 0, raw.knots_u), (Axis::V, 1, raw.knots_v)].map(|(axis, index, knots)| {
            let (count, degree) = (counts[index], degree[index]);
            match knots {
                _ if count <= degree => Err(Fault::TooFewPoints { axis, count, degree }),
                Some(knots) => knots::check(knots, axis, count, degree),
                None if count != degree + 1 => Err(Fault::BezierPoints { axis, count, degree }),
                None => Ok(knots::bezier(degree)),
            }
        });
        let knots = [knots_u?, knots_v?];
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

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|weight| *weight != self.weights[0])
    }

    /// The borders of the spans along one parameter, from 0 to 1.
    pub fn borders(&self, axis: Axis) -> Vec<f64> {
        knots::borders(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// How many derivatives the knots along one parameter leave continuous; `None` without inner knots.
    pub fn continuity(&self, axis: Axis) -> Option<usize> {
        knots::continuity(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// The inner knots along one parameter at which the patch is only C⁰.
    pub fn creases(&self, axis: Axis) -> Vec<f64> {
        knots::creases(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// The largest side of the bounding box of a grid of points on the patch, 8 to a span, metres.
    pub fn size(&self) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        self.for_each_sample(8, |_, surface| {
            low = low.min(surface.point);
            high = high.max(surface.point);
            true
        });
        (high - low).max_element()
    }

    /// Evaluates a grid of `steps` intervals a span, borders included, until `visit` says false.
    pub(super) fn for_each_sample(&self, steps: usize, mut visit: impl FnMut([f64; 2], &Surface) -> bool) {
        let parameters = |axis| {
            let borders = self.borders(axis);
            let inside = |pair: &[f64]| {
                let (left, width) = (pair[0], pair[1] - pair[0]);
                (0..steps).map(move |step| left + width * step as f64 / steps as f64)
            };
            borders.windows(2).flat_map(inside).chain([1.0]).collect::<Vec<_>>()
        };
        let along_v = parameters(Axis::V);
        for u in parameters(Axis::U) {
            for &v in &along_v {
                if !visit([u, v], &Surface::evaluate(self, u, v)) {
                    return;
                }
            }
        }
    }

    fn check_extent(&self) -> Result<(), Fault> {
        let size = self.size();
        if size == 0.0 {
            return Err(Fault::NoArea);
        }
        // Also refuses NaN, from coordinates that overflow.
        if !SIZES.contains(&size) {
            return Err(Fault::Size { size });
        }
        let distance = self.points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
        if distance > FARTHEST * size {
            return Err(Fault::FarAway { distance, limit: FARTHEST });
        }
        // f_u × f_v has degree 3 p - 1 at most: a grid of 15 intervals a span misses it only if it is 0 everywhere.
        let mut largest: f64 = 0.0;
        self.for_each_sample(15, |_, surface| {
            largest = largest.max(surface.tangent_u.cross(surface.tangent_v).length());
            largest <= LEAST_AREA * size * size
        });
        if largest <= LEAST_AREA * size * size { Err(Fault::NoArea) } else { Ok(()) }
    }
}

/// A point and its weight, 1 if it has none.
fn check_point(entry: &[f64], row: usize, column: usize) -> Result<(DVec3, f64), Fault> {
    let ([x, y, z], weight) = match *entry {
        [x, y, z] => ([x, y, z], 1.0),
        [x, y, z, w] => ([x, y, z], w),
        _ => return Err(Fault::PointLength { row, column, count: entry.len() }),
    };
    for (coordinate, value) in [('x', x), ('y', y), ('z', z)] {
        if !value.is_finite() {
            return Err(Fault::Coordinate { row, column, coordinate, value });
        }
    }
    if !(weight > 0.0 && weight < f64::INFINITY) {
        return Err(Fault::Weight { row, column, value: weight });
    }
    Ok((DVec3::new(x, y, z), weight))
}
