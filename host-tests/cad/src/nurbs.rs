//! NURBS curves and surfaces as the file has them, evaluated in double precision with two derivatives.

use glam::{DVec2, DVec3, DVec4};
use std::hash::{Hash as _, Hasher};

/// The highest degree a file may use.
pub const MAX_DEGREE: usize = 25;

/// A curve in homogeneous points `(w x, w y, w z, w)`, millimetres.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its degree.
    pub degree: usize,
    /// As many as points and degree and one.
    pub knots: Vec<f64>,
    /// Control points.
    pub points: Vec<DVec4>,
}

/// A surface in homogeneous points; point `(i, j)` is entry `i · counts[1] + j`.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Degrees along `u` and `v`.
    pub degree: [usize; 2],
    /// Knots along `u` and `v`.
    pub knots: [Vec<f64>; 2],
    /// Numbers of control points along `u` and `v`.
    pub counts: [usize; 2],
    /// Control points.
    pub points: Vec<DVec4>,
    /// Whether the surface meets itself, smoothly, at the ends of a parameter.
    pub closed: [bool; 2],
    /// Whether it meets itself there at all.
    pub touching: [bool; 2],
    /// Whether the side at a parameter's minimum or maximum is one point.
    pub poles: [[bool; 2]; 2],
}

/// A point of a surface with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// Position.
    pub point: DVec3,
    /// First derivatives by `u` and `v`.
    pub first: [DVec3; 2],
    /// Second derivatives: `uu`, `uv`, `vv`.
    pub second: [DVec3; 3],
}

impl Jet {
    /// `f_u × f_v`, not normalised.
    pub fn cross(&self) -> DVec3 {
        self.first[0].cross(self.first[1])
    }
}

/// Basis functions of a degree below `N` that do not vanish at a parameter: values, first and second derivatives.
struct Basis<const N: usize> {
    first: usize,
    values: [[f64; N]; 3],
}

/// Rows for most degrees: those for the highest take longer to clear than to fill.
const FEW: usize = 6;

impl<const N: usize> Basis<N> {
    /// By the recursion of Cox and de Boor; derivatives from the functions of lower degree.
    fn new(knots: &[f64], degree: usize, count: usize, t: f64) -> Self {
        let upper = knots[degree + 1..count].partition_point(|knot| *knot <= t) + degree;
        let span = upper.min(count - 1);
        // values[k] keeps the functions of degree − k, aligned so that entry i belongs to point span − degree + i.
        let mut values = [[0.0; N]; 3];
        let mut row = [0.0; N];
        row[0] = 1.0;
        for level in 0..=degree {
            let mut carry = 0.0;
            for (i, value) in row.iter_mut().enumerate().take(level) {
                let (low, high) = (knots[span + 1 + i - level], knots[span + 1 + i]);
                let share = if high > low { *value / (high - low) } else { 0.0 };
                *value = carry + (high - t) * share;
                carry = (t - low) * share;
            }
            if level > 0 {
                row[level] = carry;
            }
            if degree - level < 3 {
                values[degree - level] = row;
            }
        }
        let differentiate = |lower: &mut [f64; N], level: usize| {
            let mut carry = 0.0;
            for (i, value) in lower.iter_mut().enumerate().take(level) {
                let width = knots[span + 1 + i] - knots[span + 1 + i - level];
                let share = if width > 0.0 { level as f64 * *value / width } else { 0.0 };
                *value = carry - share;
                carry = share;
            }
            lower[level] = carry;
        };
        if degree >= 1 {
            differentiate(&mut values[1], degree);
        }
        if degree >= 2 {
            differentiate(&mut values[2], degree - 1);
            differentiate(&mut values[2], degree);
        }
        Self { first: span - degree, values }
    }
}

impl Curve {
    /// The minimum and the maximum of the parameter.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.points.len()]]
    }

    /// Position, first and second derivative at `t`, which is brought into the range.
    pub fn at(&self, t: f64) -> [DVec3; 3] {
        if self.degree < FEW { self.at_by::<FEW>(t) } else { self.at_by::<{ MAX_DEGREE + 1 }>(t) }
    }

    fn at_by<const N: usize>(&self, t: f64) -> [DVec3; 3] {
        let [low, high] = self.range();
        let basis = Basis::<N>::new(&self.knots, self.degree, self.points.len(), t.clamp(low, high));
        let sum = |order: usize| {
            let terms = self.points[basis.first..].iter().zip(&basis.values[order][..=self.degree]);
            terms.map(|(point, value)| *point * *value).sum::<DVec4>()
        };
        let (a, b, c) = (sum(0), sum(1), sum(2));
        let point = a.truncate() / a.w;
        let first = (b.truncate() - point * b.w) / a.w;
        let second = (c.truncate() - first * (2.0 * b.w) - point * c.w) / a.w;
        [point, first, second]
    }
}

/// The stretch of a line of control points between two parameters: both are inserted as knots until the points there
/// are the curve's own.
fn cut(degree: usize, mut knots: Vec<f64>, mut points: Vec<DVec4>, [from, to]: [f64; 2]) -> (Vec<f64>, Vec<DVec4>) {
    for t in [from, to] {
        while knots.iter().filter(|knot| **knot == t).count() < degree {
            let span = knots.partition_point(|knot| *knot <= t) - 1;
            let blend = |i: usize| {
                if i + degree <= span {
                    points[i]
                } else if i > span {
                    points[i - 1]
                } else {
                    points[i - 1].lerp(points[i], (t - knots[i]) / (knots[i + degree] - knots[i]))
                }
            };
            points = (0..=points.len()).map(blend).collect();
            knots.insert(span + 1, t);
        }
    }
    let (first, last) = (knots.partition_point(|knot| *knot <= from) - 1, knots.partition_point(|knot| *knot < to));
    let points = points[first - degree..last].to_vec();
    let ends = |t: f64| std::iter::repeat_n(t, degree + 1);
    (ends(from).chain(knots[first + 1..last].iter().copied()).chain(ends(to)).collect(), points)
}

impl Surface {
    /// The parts between places inside the range of a parameter where the line along the other, closed one is one
    /// point: as where a circle crosses the axis about which it is turned. None without such places. `near` is what
    /// counts as one point, millimetres.
    pub fn parts_between_points(&self, near: f64) -> Vec<Self> {
        for axis in 0..2 {
            if self.closed[1 - axis] {
                let places = self.points_inside(axis, near);
                if !places.is_empty() {
                    return self.parts(axis, &places, near);
                }
            }
        }
        Vec::new()
    }

    /// Makes the control points of poles of a parameter one point, to the last bit: the tangent around a pole is zero,
    /// and not some rounding in which a search would believe.
    pub fn gather_poles(&mut self, axis: usize) {
        for end in (0..2).filter(|end| self.poles[axis][*end]) {
            let along = if end == 0 { 0 } else { self.counts[axis] - 1 };
            let other = self.counts[1 - axis];
            let index = |k: usize| if axis == 0 { along * self.counts[1] + k } else { k * self.counts[1] + along };
            let indices: Vec<usize> = (0..other).map(index).collect();
            let first = self.points[indices[0]];
            let pole = first.truncate() / first.w;
            for index in indices {
                let weight = self.points[index].w;
                self.points[index] = (pole * weight).extend(weight);
            }
        }
    }

    fn points_inside(&self, axis: usize, near: f64) -> Vec<f64> {
        const SAMPLES: usize = 256;
        let ([low, high], [start, end]) = (self.range(axis), self.range(1 - axis));
        // Across the closed parameter.
        let width = |t: f64| {
            let at = |along: f64| self.at(if axis == 0 { DVec2::new(t, along) } else { DVec2::new(along, t) }).point;
            at(start).distance(at(0.5 * (start + end))).max(at(0.75 * start + 0.25 * end).distance(at(start)))
        };
        let at = |k: usize| low + (high - low) * k as f64 / SAMPLES as f64;
        let widths: Vec<f64> = (0..=SAMPLES).map(|k| width(at(k))).collect();
        let mut places = Vec::new();
        for k in 1..SAMPLES {
            if widths[k] > widths[k - 1] || widths[k] >= widths[k + 1] {
                continue;
            }
            let (mut a, mut b) = (at(k - 1), at(k + 1));
            for _ in 0..120 {
                let (c, d) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                if width(c) < width(d) { b = d } else { a = c }
            }
            let place = 0.5 * (a + b);
            let is_inside = (place - low).min(high - place) > 1e-9 * (high - low);
            if is_inside && width(place) <= near {
                // A knot there is the place: where the line only touches the axis, the search ends beside it.
                let is_place = |knot: &&f64| (**knot - place).abs() < 1e-4 * (high - low) && width(**knot) <= near;
                let knot = self.knots[axis].iter().find(is_place);
                places.push(knot.copied().unwrap_or(place));
            }
        }
        places
    }

    fn parts(&self, axis: usize, places: &[f64], near: f64) -> Vec<Self> {
        let [low, high] = self.range(axis);
        let goes_round = self.touching[axis];
        let mut borders = places.to_vec();
        if goes_round {
            borders.push(places[0] + (high - low));
        } else {
            borders = [low].into_iter().chain(borders).chain([high]).collect();
        }
        let (degree, other) = (self.degree[axis], self.counts[1 - axis]);
        let part = |pair: &[f64]| {
            let mut part = self.clone();
            let line = |k: usize| {
                let index = |i: usize| if axis == 0 { i * self.counts[1] + k } else { k * self.counts[1] + i };
                let mut points: Vec<DVec4> = (0..self.counts[axis]).map(|i| self.points[index(i)]).collect();
                let mut knots = self.knots[axis].clone();
                if pair[1] > high {
                    // Once round more.
                    let again: Vec<f64> = knots[degree + 1..].iter().map(|knot| knot + (high - low)).collect();
                    knots.pop();
                    knots.extend(again);
                    points.extend_from_within(1..);
                }
                cut(degree, knots, points, [pair[0], pair[1]])
            };
            let lines: Vec<_> = (0..other).map(line).collect();
            part.counts[axis] = lines[0].1.len();
            part.knots[axis].clone_from(&lines[0].0);
            part.points = if axis == 0 {
                (0..part.counts[0]).flat_map(|i| lines.iter().map(move |line| line.1[i])).collect()
            } else {
                lines.into_iter().flat_map(|line| line.1).collect()
            };
            part.find_ends(near);
            part.gather_poles(axis);
            part
        };
        borders.windows(2).map(part).collect()
    }

    /// The minimum and the maximum of a parameter.
    pub fn range(&self, axis: usize) -> [f64; 2] {
        [self.knots[axis][self.degree[axis]], self.knots[axis][self.counts[axis]]]
    }

    /// The width of the range of a parameter.
    pub fn period(&self, axis: usize) -> f64 {
        let [low, high] = self.range(axis);
        high - low
    }

    /// Parameters in their ranges: round a closed one, to the nearest end of an open one.
    pub fn wrapped(&self, uv: DVec2) -> DVec2 {
        let wrap = |axis: usize, value: f64| {
            let [low, high] = self.range(axis);
            if self.closed[axis] && !(low..=high).contains(&value) {
                low + (value - low).rem_euclid(high - low)
            } else {
                value.clamp(low, high)
            }
        };
        DVec2::new(wrap(0, uv.x), wrap(1, uv.y))
    }

    /// The point and its derivatives.
    pub fn at(&self, uv: DVec2) -> Jet {
        let is_few = self.degree.iter().all(|degree| *degree < FEW);
        if is_few { self.at_by::<FEW>(uv) } else { self.at_by::<{ MAX_DEGREE + 1 }>(uv) }
    }

    fn at_by<const N: usize>(&self, uv: DVec2) -> Jet {
        let uv = self.wrapped(uv);
        let along = |axis: usize| Basis::<N>::new(&self.knots[axis], self.degree[axis], self.counts[axis], uv[axis]);
        let (along_u, along_v) = (along(0), along(1));
        let mut sums = [DVec4::ZERO; 6];
        for i in 0..=self.degree[0] {
            let row = (along_u.first + i) * self.counts[1] + along_v.first;
            let mut line = [DVec4::ZERO; 3];
            for (j, point) in self.points[row..=row + self.degree[1]].iter().enumerate() {
                for (order, sum) in line.iter_mut().enumerate() {
                    *sum += *point * along_v.values[order][j];
                }
            }
            for (k, (a, b)) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)].into_iter().enumerate() {
                sums[k] += line[b] * along_u.values[a][i];
            }
        }
        let [s, u, v, uu, uv, vv] = sums;
        let w = s.w;
        let point = s.truncate() / w;
        let first = [u, v].map(|d| (d.truncate() - point * d.w) / w);
        let [fu, fv] = first;
        let second = [
            (uu.truncate() - fu * (2.0 * u.w) - point * uu.w) / w,
            (uv.truncate() - fv * u.w - fu * v.w - point * uv.w) / w,
            (vv.truncate() - fv * (2.0 * v.w) - point * vv.w) / w,
        ];
        Jet { point, first, second }
    }

    /// The curve on which parameter `axis` has a value, by the other parameter.
    pub fn line(&self, axis: usize, value: f64) -> Curve {
        let at = if axis == 0 { DVec2::new(value, 0.0) } else { DVec2::new(0.0, value) };
        let value = self.wrapped(at)[axis];
        let basis = Basis::<{ MAX_DEGREE + 1 }>::new(&self.knots[axis], self.degree[axis], self.counts[axis], value);
        let other = 1 - axis;
        let point = |k: usize| -> DVec4 {
            let index = |i: usize| if axis == 0 { i * self.counts[1] + k } else { k * self.counts[1] + i };
            (0..=self.degree[axis]).map(|i| self.points[index(basis.first + i)] * basis.values[0][i]).sum()
        };
        let points = (0..self.counts[other]).map(point).collect();
        Curve { degree: self.degree[other], knots: self.knots[other].clone(), points }
    }

    /// A hash of all that it follows from.
    pub fn hash(&self, hasher: &mut impl Hasher) {
        (self.degree, self.counts, self.closed, self.touching, self.poles).hash(hasher);
        let points = self.points.iter().flat_map(|point| point.to_array());
        let numbers = self.knots.iter().flatten().copied().chain(points);
        numbers.for_each(|number| number.to_bits().hash(hasher));
    }

    /// The unit normal `f_u × f_v`; at a pole, that of a point a millionth of the range away from it.
    pub fn normal(&self, uv: DVec2) -> DVec3 {
        let jet = self.at(uv);
        let cross = jet.cross();
        if cross.length() > 1e-9 * jet.first[0].length_squared().max(jet.first[1].length_squared()) {
            return cross.normalize();
        }
        let [u, v] = [0, 1].map(|axis| self.range(axis));
        let middle = DVec2::new(u[0] + u[1], v[0] + v[1]) * 0.5;
        self.at(uv + (middle - uv) * 1e-6).cross().normalize_or_zero()
    }

    /// Finds out where the surface closes on itself and where it has poles; `near` is what counts as one point.
    pub fn find_ends(&mut self, near: f64) {
        const STEPS: usize = 24;
        let at = |axis: usize, end: usize, k: usize| {
            let [low, high] = self.range(1 - axis);
            let along = low + (high - low) * k as f64 / STEPS as f64;
            let fixed = self.range(axis)[end];
            self.at(if axis == 0 { DVec2::new(fixed, along) } else { DVec2::new(along, fixed) })
        };
        // How far the line along the other parameter strays from its start.
        let extent = |axis: usize, share: f64| {
            let [[low, high], other] = [axis, 1 - axis].map(|axis| self.range(axis));
            let fixed = low + (high - low) * share;
            let point = |k: usize| {
                let along = other[0] + (other[1] - other[0]) * k as f64 / STEPS as f64;
                self.at(if axis == 0 { DVec2::new(fixed, along) } else { DVec2::new(along, fixed) }).point
            };
            (1..=STEPS).map(|k| point(k).distance(point(0))).fold(0.0, f64::max)
        };
        // A strip that is narrow everywhere has no pole, nor does it meet itself.
        let is_strip = |axis: usize| [0.3, 0.45, 0.65].into_iter().all(|share| extent(axis, share) <= near);
        let is_pole = |axis: usize, end: usize| !is_strip(axis) && extent(axis, end as f64) <= near;
        let poles = [0, 1].map(|axis| [0, 1].map(|end| is_pole(axis, end)));
        let touching = [0, 1].map(|axis| {
            poles[axis] != [true; 2]
                && !is_strip(1 - axis)
                && (0..=STEPS).all(|k| at(axis, 0, k).point.distance(at(axis, 1, k).point) <= near)
        });
        // A crease along the seam is an edge, and no place to go through.
        let is_smooth = |axis: usize| {
            let width = self.period(axis);
            (0..=STEPS).all(|k| {
                let [a, b] = [0, 1].map(|end| at(axis, end, k).first[axis]);
                // Where the lines along the other parameter meet there is no direction to compare.
                a.dot(b) >= 0.999_99 * a.length() * b.length() || a.length() * width < 1e3 * near
            })
        };
        let closed = [0, 1].map(|axis| touching[axis] && is_smooth(axis));
        self.touching = touching;
        (self.poles, self.closed) = (poles, closed);
    }
}
