//! A patch as polynomials: each span between two knots, in powers of the distance from its centre.
//!
//! In double precision throughout: blossoming gives a span's Bézier points, de Casteljau's scheme on their differences
//! its Taylor coefficients about the very `f32` centre the target subtracts. The polynomial is that of the exact knots:
//! where a border rounds to `f32`, the neighbour's polynomial is used up to half a unit in the last place beyond it.

use crate::bernstein::{binomial, power_of};
use crate::patch::{Axis, NurbsPatch};
use glam::DVec4;
use palpate::patch::span_centre;

/// Minimum weight of a span's Bézier points, the largest of the patch being 1. Dividing by `w` magnifies the rounding
/// of the homogeneous coefficients, 6e-8, by `1/w`: a smaller weight could lose more than 6e-5 of the size.
const LEAST_WEIGHT: f64 = 1e-3;

/// Of the largest coordinate: a few hundred units in the last place of `f64`, a millionth of one of `f32`.
const NOISE: f64 = 1e-13;

/// Smallest relevant contribution of a power, relative to the largest value: a sixth of a unit in the last place of
/// `f32`. The tables leave smaller ones out.
pub const BELOW_SINGLE: f64 = 1e-8;

/// All spans of a patch, homogeneous: `(w x, w y, w z, w)`.
#[derive(Clone, Debug)]
pub struct Spans {
    /// Span borders along `u` and `v`, as the target has them.
    pub breaks: [Vec<f32>; 2],
    /// Span `(i, j)` is entry `i · spans_v + j`: `powers[k · (degree_v + 1) + l]` belongs to `sᵏ tˡ`.
    pub powers: Vec<Vec<DVec4>>,
}

impl Spans {
    /// Leaves out the highest powers of a parameter, down to the first, as long as they add less than `f32` can tell on
    /// every span, relative to the largest coordinate and weight: a plane that is given as a bicubic patch is bilinear.
    /// Returns the degree that is left.
    pub fn lower(&mut self, mut degree: [usize; 2]) -> [usize; 2] {
        let Self { breaks, powers: spans } = self;
        let half = |axis: usize, span: usize| 0.5 * f64::from(breaks[axis][span + 1] - breaks[axis][span]);
        let spans_v = breaks[1].len() - 1;
        // Where the span is widest, a power adds its coefficient times these.
        let reach = |span: usize, [k, l]: [usize; 2]| {
            power_of(half(0, span / spans_v), k) * power_of(half(1, span % spans_v), l)
        };
        let linear = |(span, powers): (usize, &Vec<DVec4>)| {
            let along = [(1, [0, 1]), (degree[1] + 1, [1, 0])];
            along.iter().fold(powers[0].abs(), |sum, (index, power)| sum + powers[*index].abs() * reach(span, *power))
        };
        let largest = spans.iter().enumerate().map(linear).fold(DVec4::ZERO, DVec4::max);
        let coordinate = largest.truncate().max_element();
        let least = DVec4::new(coordinate, coordinate, coordinate, largest.w) * BELOW_SINGLE;
        for axis in [0, 1] {
            while degree[axis] > 1 {
                let (columns, highest) = (degree[1] + 1, degree[axis]);
                let power = |index: usize| [index / columns, index % columns];
                let is_small = |(span, powers): (usize, &Vec<DVec4>)| {
                    let of_it = powers.iter().enumerate().filter(|(index, _)| power(*index)[axis] == highest);
                    let added: DVec4 = of_it.map(|(index, entry)| entry.abs() * reach(span, power(index))).sum();
                    added.cmple(least).all()
                };
                if !spans.iter().enumerate().all(is_small) {
                    break;
                }
                for powers in spans.iter_mut() {
                    let kept = powers.iter().enumerate().filter(|(index, _)| power(*index)[axis] < highest);
                    *powers = kept.map(|(_, entry)| *entry).collect();
                }
                degree[axis] -= 1;
            }
        }
        degree
    }
}

/// Index of a span, along `u` and `v`, whose weights are too uneven.
pub struct UnevenSpan(pub [usize; 2]);

/// One span along one axis.
struct Interval<'a> {
    knots: &'a [f64],
    degree: usize,
    /// Index of the last knot that is not above the span's lower border.
    knot: usize,
    /// The f32 centre.
    centre: f64,
}

/// Extracts all spans.
///
/// # Errors
/// The first span whose weights are too uneven for `f32`.
pub fn extract(patch: &NurbsPatch) -> Result<Spans, UnevenSpan> {
    let breaks = [Axis::U, Axis::V].map(|axis| patch.borders(axis).iter().map(|knot| *knot as f32).collect::<Vec<_>>());
    let intervals = [0, 1].map(|axis| intervals(&patch.knots[axis], patch.degree[axis], &breaks[axis]));
    let extent = patch.points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let mut powers = Vec::with_capacity(intervals[0].len() * intervals[1].len());
    for (i, along_u) in intervals[0].iter().enumerate() {
        for (j, along_v) in intervals[1].iter().enumerate() {
            let (rows, columns) = (along_u.degree + 1, along_v.degree + 1);
            let control = |row: usize, column: usize| {
                let index =
                    (along_u.knot - along_u.degree + row) * patch.counts[1] + along_v.knot - along_v.degree + column;
                patch.points[index].extend(1.0) * patch.weights[index]
            };
            let mut net = vec![DVec4::ZERO; rows * columns];
            for column in 0..columns {
                let line: Vec<_> = (0..rows).map(|row| control(row, column)).collect();
                for (row, entry) in along_u.bezier(&line).into_iter().enumerate() {
                    net[row * columns + column] = entry;
                }
            }
            for row in net.chunks_mut(columns) {
                row.copy_from_slice(&along_v.bezier(row));
            }
            if net.iter().any(|entry| entry.w.is_nan() || entry.w < LEAST_WEIGHT) {
                return Err(UnevenSpan([i, j]));
            }
            for row in net.chunks_mut(columns) {
                row.copy_from_slice(&along_v.powers(row));
            }
            for column in 0..columns {
                let line: Vec<_> = (0..rows).map(|row| net[row * columns + column]).collect();
                for (row, entry) in along_u.powers(&line).into_iter().enumerate() {
                    net[row * columns + column] = entry;
                }
            }
            let half = |interval: &Interval<'_>| 0.5 * interval.width();
            drop_rounding(&mut net, columns, [half(along_u), half(along_v)], extent);
            powers.push(net);
        }
    }
    Ok(Spans { breaks, powers })
}

/// Sets coefficients that are only rounding of `f64` to zero: powers that add less than [`NOISE`] anywhere on the span,
/// relative to the largest coordinate and weight. Such digits carry no information, and would make the table depend on
/// the way of its computation.
fn drop_rounding(net: &mut [DVec4], columns: usize, half_widths: [f64; 2], extent: f64) {
    for (index, entry) in net.iter_mut().enumerate() {
        let reach = power_of(half_widths[0], index / columns) * power_of(half_widths[1], index % columns);
        let least = DVec4::new(extent, extent, extent, 1.0) * (NOISE / reach);
        let keep = entry.abs().cmpgt(least);
        *entry = DVec4::select(keep, *entry, DVec4::ZERO);
    }
}

fn intervals<'a>(knots: &'a [f64], degree: usize, breaks: &[f32]) -> Vec<Interval<'a>> {
    let within = degree..knots.len() - degree - 1;
    let spans = within.filter(|&knot| knots[knot] < knots[knot + 1]);
    let pairs = breaks.windows(2).map(|pair| f64::from(span_centre(pair[0], pair[1])));
    spans.zip(pairs).map(|(knot, centre)| Interval { knots, degree, knot, centre }).collect()
}

impl Interval<'_> {
    fn borders(&self) -> (f64, f64) {
        (self.knots[self.knot], self.knots[self.knot + 1])
    }

    fn width(&self) -> f64 {
        let (low, high) = self.borders();
        high - low
    }

    /// The span's Bézier points: the blossom at `degree - k` times the lower border and `k` times the upper.
    fn bezier(&self, control: &[DVec4]) -> Vec<DVec4> {
        let (low, high) = self.borders();
        let arguments = |k: usize| move |level: usize| if level <= k { high } else { low };
        (0..=self.degree).map(|k| self.blossom(control, arguments(k))).collect()
    }

    /// De Boor's scheme with an argument of its own at each level, 1 to the degree.
    fn blossom(&self, control: &[DVec4], argument: impl Fn(usize) -> f64) -> DVec4 {
        let mut points = control.to_vec();
        for level in 1..=self.degree {
            for index in (level..=self.degree).rev() {
                let first = self.knot - self.degree + index;
                let (start, end) = (self.knots[first], self.knots[first + self.degree + 1 - level]);
                let share = (argument(level) - start) / (end - start);
                points[index] = points[index - 1] * (1.0 - share) + points[index] * share;
            }
        }
        points[self.degree]
    }

    /// Bézier points to powers of the distance from the centre: `fᵏ(c)/k! = C(n, k) Δᵏb(c) / widthᵏ`.
    fn powers(&self, bezier: &[DVec4]) -> Vec<DVec4> {
        let (low, _) = self.borders();
        let width = self.width();
        let share = (self.centre - low) / width;
        let mut differences = bezier.to_vec();
        let mut powers = Vec::with_capacity(bezier.len());
        for k in 0..=self.degree {
            let mut points = differences.clone();
            while points.len() > 1 {
                points = points.windows(2).map(|pair| pair[0] * (1.0 - share) + pair[1] * share).collect();
            }
            powers.push(points[0] * (binomial(self.degree, k) / power_of(width, k)));
            differences = differences.windows(2).map(|pair| pair[1] - pair[0]).collect();
        }
        powers
    }
}

// Coefficients of a table, with the numbers owned.

/// Coefficients on the host: [`palpate::patch::Coefficients`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub enum BakedCoefficients {
    /// `[x, y, z]`, metres.
    Polynomial(Vec<[f32; 3]>),
    /// `[w x, w y, w z, w]`.
    Rational(Vec<[f32; 4]>),
}

impl BakedCoefficients {
    /// One span as `(w x, w y, w z, w)` in `f64`; the numbers are those of the table.
    pub(super) fn homogeneous_span(&self, degree: [usize; 2], span: usize) -> Vec<[f64; 4]> {
        let count = (degree[0] + 1) * (degree[1] + 1);
        let entries = span * count..(span + 1) * count;
        match self {
            Self::Polynomial(all) => {
                let weight = |index: usize| if index == 0 { 1.0 } else { 0.0 };
                let widen =
                    |(index, [x, y, z]): (usize, &[f32; 3])| [(*x).into(), (*y).into(), (*z).into(), weight(index)];
                all[entries].iter().enumerate().map(widen).collect()
            }
            Self::Rational(all) => all[entries].iter().map(|entry| entry.map(f64::from)).collect(),
        }
    }

    /// Bytes in flash.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Polynomial(entries) => size_of_val(entries.as_slice()),
            Self::Rational(entries) => size_of_val(entries.as_slice()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// A plane of 60 mm by 40 mm as a bicubic patch of two spans along `u`, but for the height of its last corner.
    fn plane(height: f64) -> NurbsPatch {
        let (knots_u, knots_v) = (vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0], crate::patch::bezier(3));
        // Greville's abscissae make it even.
        let along_u = [0.0, 1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0];
        let mut points: Vec<DVec3> = along_u
            .iter()
            .flat_map(|u| (0..4).map(move |v| DVec3::new(0.06 * u, 0.04 * f64::from(v) / 3.0, 0.0)))
            .collect();
        points[19].z = height;
        NurbsPatch {
            name: None,
            degree: [3, 3],
            knots: [knots_u, knots_v],
            counts: [5, 4],
            weights: vec![1.0; points.len()],
            points,
            flip: false,
        }
    }

    #[test]
    fn degrees_that_add_nothing_are_left_out_and_no_others() {
        let lowered = |height: f64| {
            let patch = plane(height);
            let Ok(mut spans) = extract(&patch) else { panic!("a plane is even") };
            let degree = spans.lower(patch.degree);
            assert!(spans.powers.iter().all(|powers| powers.len() == (degree[0] + 1) * (degree[1] + 1)));
            (degree, spans)
        };
        let (degree, spans) = lowered(0.0);
        assert_eq!((degree, spans.powers.len()), ([1, 1], 2));
        // The middle of the first span, and its tangents.
        let [middle, along_v, along_u, twist] = spans.powers[0][..] else { panic!("four powers") };
        let expected = [[0.015, 0.02], [0.0, 0.04], [0.06, 0.0], [0.0, 0.0]];
        for (found, [x, y]) in [middle, along_v, along_u, twist].into_iter().zip(expected) {
            assert!((found.truncate() - DVec3::new(x, y, 0.0)).length() < 1e-15, "{found}");
        }
        // A part in 10⁸ of the size is 0.6 nm; a corner adds less than its height to any power.
        assert_eq!(lowered(5e-10).0, [1, 1]);
        assert_eq!(lowered(1e-6).0, [3, 3]);
    }
}
