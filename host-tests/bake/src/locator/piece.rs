//! A rectangle of a face's parameters with everything that is bounded on it.
//!
//! With `f = A / w` and `B_u = A_u w − A w_u`, `C_uv = (B_u)_v w − 2 B_u w_v`, half the squared distance `φ = ½‖f −
//! Q‖²` and its derivatives are, up to powers of the positive weight, polynomials that are affine in the probe `Q`:
//! - `w² (φ − φ₀) = ½‖A‖² − ½‖P‖² w² − Q · (A w − P w²)` against the value `φ₀` at any point `P`;
//! - `w³ φ_u = (A − Q w) · B_u`;
//! - `w⁴ φ_uv = B_u · B_v + (A − Q w) · C_uv`.

use super::osculating::Osculating;
use super::stored::StoredSurface;
use crate::bernstein::Bernstein;
use crate::bernstein::{Tracked, power_of};
use glam::DVec3;
use std::ops::Range;
use std::sync::OnceLock;

/// How often a span is quartered at most.
pub(crate) const LEVELS: u8 = 6;

/// A part of a span of a face.
#[derive(Debug)]
pub(crate) struct Piece {
    pub face: u16,
    /// The minimum and maximum `u` and `v`, parameters of the face.
    pub low: [f64; 2],
    pub high: [f64; 2],
    pub level: u8,
    /// Whether a side lies on the face's own: `u` low, `u` high, `v` low, `v` high.
    pub on_border: [bool; 4],
    /// Whether that side is one point.
    pub on_pole: [bool; 4],
    /// Whether a side across `u`, `v` is a crease.
    pub on_crease: [bool; 4],
    /// `½‖A‖²`, `A w`, `w²`.
    pub place: Field<5>,
    /// `φ_u`, `φ_v`.
    pub gradient: [Field<4>; 2],
    /// `φ_uu`, `φ_uv`, `φ_vv`.
    pub hessian: Field<12>,
    /// At most `w⁴`.
    pub least_weight: f64,
    /// At least the curvature of its span in any direction, 1/m; infinite unless the span is plane up to rounding.
    pub curvature: f64,
    /// A box that holds it, metres.
    pub bounds: [DVec3; 2],
    /// At least the distance between any two of its points, metres.
    pub diameter: f64,
    quarters: OnceLock<Box<[Self; 4]>>,
    /// As its middle sees it.
    near: OnceLock<Osculating>,
}

/// The common start of a span's pieces.
pub(super) struct Span<'a> {
    pub face: u16,
    pub low: [f64; 2],
    pub high: [f64; 2],
    pub on_border: [bool; 4],
    pub on_pole: [bool; 4],
    pub on_crease: [bool; 4],
    /// `A`, `w` over the unit square.
    pub homogeneous: &'a [Tracked; 4],
    /// Widths of the parameters.
    pub widths: [f64; 2],
    /// No probe has a greater coordinate, in absolute value.
    pub reach: f64,
}

impl Piece {
    /// The whole of a span; `None` if a weight is not positive.
    pub(super) fn of_span(span: &Span<'_>) -> Option<Self> {
        let weight = &span.homogeneous[3];
        if weight.polynomial.coefficients.iter().any(|[w]| w.is_nan() || *w <= weight.error) {
            return None;
        }
        let is_polynomial = weight.polynomial.coefficients.iter().all(|w| *w == [1.0]);
        let points = [0, 1, 2].map(|c| span.homogeneous[c].clone());
        let one = Tracked::constant(1.0);
        let weight = if is_polynomial { &one } else { weight };
        let times_weight = |entry: &Tracked| if is_polynomial { entry.clone() } else { entry.times(weight) };
        let first: [[Tracked; 3]; 2] = [0, 1].map(|axis| {
            points.each_ref().map(|point| {
                let along = times_weight(&point.derivative(axis));
                if is_polynomial { along } else { along.plus(-1.0, &point.times(&weight.derivative(axis))) }
            })
        });
        let second = |a: usize, b: usize| {
            first[a].each_ref().map(|tangent| {
                let along = times_weight(&tangent.derivative(b));
                if is_polynomial { along } else { along.plus(-2.0, &tangent.times(&weight.derivative(b))) }
            })
        };
        let reach = span.reach;
        let squared = dot(&points, &points);
        let weighted = points.each_ref().map(times_weight);
        let weight_squared = times_weight(weight);
        let [x, y, z] = &weighted;
        // Any point of the body and any probe are within reach: ½‖P‖² + |Q · P| is at most 4.5 of its squares.
        let place = Field::new(
            [&squared, x, y, z, &weight_squared],
            [0.5, 1.0, 1.0, 1.0, 1.0],
            [1.0, reach, reach, reach, 4.5 * reach * reach],
        );
        let gradient = [0, 1].map(|axis| {
            let value = dot(&points, &first[axis]);
            let [x, y, z] = first[axis].each_ref().map(times_weight);
            let factor = 1.0 / span.widths[axis];
            Field::new([&value, &x, &y, &z], [factor; 4], [1.0, reach, reach, reach])
        });
        let entries = [[0, 0], [0, 1], [1, 1]].map(|[a, b]| {
            let bent = second(a, b);
            let value = dot(&first[a], &first[b]).plus(1.0, &dot(&points, &bent));
            let [x, y, z] = bent.each_ref().map(times_weight);
            let factor = 1.0 / (span.widths[a] * span.widths[b]);
            ([value, x, y, z], factor)
        });
        let bent = [[0, 0], [0, 1], [1, 1]].map(|[a, b]| second(a, b));
        let curvature = if is_plane(&points, weight) { curvature(&first, &bent, weight) } else { f64::INFINITY };
        let components: [&Tracked; 12] = std::array::from_fn(|c| &entries[c / 4].0[c % 4]);
        let hessian = Field::new(
            components,
            std::array::from_fn(|c| entries[c / 4].1),
            std::array::from_fn(|c| if c % 4 == 0 { 1.0 } else { reach }),
        );
        let Span { face, low, high, on_border, on_pole, on_crease, .. } = *span;
        Some(Self::finish(Self {
            face,
            low,
            high,
            level: 0,
            on_border,
            on_pole,
            on_crease,
            place,
            gradient,
            hessian,
            least_weight: 0.0,
            curvature,
            bounds: [DVec3::ZERO; 2],
            diameter: 0.0,
            quarters: OnceLock::new(),
            near: OnceLock::new(),
        }))
    }

    /// Weight and diameter, from the Bernstein points: the surface lies in the hull of `A w / w²`.
    fn finish(mut self) -> Self {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut weight = f64::INFINITY;
        for [_, x, y, z, w] in &self.place.polynomial.coefficients {
            let point = DVec3::new(*x, *y, *z) / *w;
            (low, high) = (low.min(point), high.max(point));
            weight = weight.min(*w);
        }
        self.bounds = [low, high];
        self.diameter = (high - low).length();
        self.least_weight = weight * weight;
        self
    }

    /// Its quarters, computed when first asked for; `None` at the last level.
    pub(crate) fn quarters(&self) -> Option<&[Self; 4]> {
        (self.level < LEVELS).then(|| &**self.quarters.get_or_init(|| Box::new(self.split())))
    }

    /// As its middle sees it, computed when first asked for; the surface is its face's.
    pub(super) fn near(&self, surface: &StoredSurface) -> Osculating {
        *self.near.get_or_init(|| Osculating::new(surface, [self.low, self.high]))
    }

    fn split(&self) -> [Self; 4] {
        let places = self.place.quarters();
        let [gradients_u, gradients_v] = self.gradient.each_ref().map(Field::quarters);
        let hessians = self.hessian.quarters();
        let middle = [0, 1].map(|axis| 0.5 * (self.low[axis] + self.high[axis]));
        let mut pieces = Vec::with_capacity(4);
        let parts = places.into_iter().zip(gradients_u).zip(gradients_v).zip(hessians);
        for (index, (((place, gradient_u), gradient_v), hessian)) in parts.enumerate() {
            let upper = [index / 2 == 1, index % 2 == 1];
            let kept = [!upper[0], upper[0], !upper[1], upper[1]];
            let sides = |flags: [bool; 4]| std::array::from_fn(|side| flags[side] && kept[side]);
            pieces.push(Self::finish(Self {
                face: self.face,
                low: [0, 1].map(|axis| if upper[axis] { middle[axis] } else { self.low[axis] }),
                high: [0, 1].map(|axis| if upper[axis] { self.high[axis] } else { middle[axis] }),
                level: self.level + 1,
                on_border: sides(self.on_border),
                on_pole: sides(self.on_pole),
                on_crease: sides(self.on_crease),
                place,
                gradient: [gradient_u, gradient_v],
                hessian,
                least_weight: 0.0,
                curvature: self.curvature,
                bounds: [DVec3::ZERO; 2],
                diameter: 0.0,
                quarters: OnceLock::new(),
                near: OnceLock::new(),
            }));
        }
        pieces.try_into().unwrap_or_else(|_| unreachable!("four quarters"))
    }
}

/// How far a point of a plane face may be from the plane, relative to the face: more than the rounding of a table.
const PLANE: f64 = 1e-5;
/// The degree up to which the rounding of a product is bounded, see [`Tracked::times`].
const MAX_DEGREE: usize = 20;

/// Whether a span is plane about as much as `f32` can tell; [`curvature`] bounds how much.
fn is_plane(points: &[Tracked; 3], weight: &Tracked) -> bool {
    let degree = [0, 1].map(|axis| points.iter().map(|point| point.polynomial.degree[axis]).max().unwrap_or_default());
    let coefficients = |component: &Tracked| component.raised(degree).polynomial.coefficients;
    let [x, y, z, w] = [&points[0], &points[1], &points[2], weight].map(coefficients);
    let points: Vec<_> = (0..x.len()).map(|at| DVec3::new(x[at][0], y[at][0], z[at][0]) / w[at][0]).collect();
    let width = degree[1] + 1;
    let corner = |u: usize, v: usize| points[u * degree[0] * width + v * degree[1]];
    let normal = (corner(1, 1) - corner(0, 0)).cross(corner(0, 1) - corner(1, 0)).normalize_or_zero();
    let height = |point: &DVec3| normal.dot(*point - points[0]).abs();
    let size = points.iter().map(|point| point.distance(points[0])).fold(0.0, f64::max);
    normal != DVec3::ZERO && points.iter().all(|point| height(point) <= PLANE * size)
}

/// A bound of the normal curvature of a span in any direction, 1/m; infinite if none is found.
///
/// With `N = B_u × B_v` the second fundamental form is `N · C_ij / (|N| w³)`, the first has the determinant `N² / w⁸`,
/// and no direction bends more than the largest entry of the second times the trace of the first over its determinant.
fn curvature(first: &[[Tracked; 3]; 2], bent: &[[Tracked; 3]; 3], weight: &Tracked) -> f64 {
    let [u, v] = first;
    let normal = [0, 1, 2].map(|c| {
        let (a, b) = ((c + 1) % 3, (c + 2) % 3);
        u[a].times(&v[b]).plus(-1.0, &u[b].times(&v[a]))
    });
    let degree = |vector: &[Tracked; 3], axis: usize| {
        vector.iter().map(|component| component.polynomial.degree[axis]).max().unwrap_or_default()
    };
    let is_bounded = |bent: &[Tracked; 3]| (0..2).all(|axis| degree(&normal, axis) + degree(bent, axis) <= MAX_DEGREE);
    if !bent.iter().all(is_bounded) {
        return f64::INFINITY;
    }
    let mean = |component: &Tracked| component.polynomial.coefficients.iter().map(|[value]| value).sum::<f64>();
    let along = DVec3::from_array(normal.each_ref().map(mean)).normalize_or_zero().to_array();
    let facing = (0..3).fold(Tracked::constant(0.0), |sum, c| sum.plus(along[c], &normal[c]));
    let least = |component: &Tracked| {
        component.polynomial.coefficients.iter().map(|[value]| *value).fold(f64::INFINITY, f64::min) - component.error
    };
    let most = |component: &Tracked| component.largest() + component.error;
    let (length, [light, heavy]) = (least(&facing), [least(weight), most(weight)]);
    if length <= 0.0 {
        return f64::INFINITY;
    }
    let second = bent.iter().map(|bent| most(&dot(&normal, bent))).fold(0.0, f64::max) / (length * power_of(light, 3));
    let trace: f64 = first.iter().map(|tangent| most(&dot(tangent, tangent))).sum::<f64>() / power_of(light, 4);
    let determinant = length * length / power_of(heavy, 8);
    // Of a symmetric matrix of two rows the largest eigenvalue is at most twice the largest entry; and some rounding.
    2.0 * second * trace / determinant * (1.0 + 1e-9)
}

fn dot(a: &[Tracked; 3], b: &[Tracked; 3]) -> Tracked {
    let terms = a.iter().zip(b).filter(|(a, b)| !a.is_zero() && !b.is_zero());
    terms.fold(Tracked::constant(0.0), |sum, (a, b)| sum.plus(1.0, &a.times(b)))
}

// Polynomials in the parameters that are affine in the probe, on a cell of the parameters, and the probes they are
// bounded for.

/// A box of probes, metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Probes {
    pub centre: DVec3,
    pub half: DVec3,
}

impl Probes {
    pub(crate) fn cube(centre: DVec3, half: f64) -> Self {
        Self { centre, half: DVec3::splat(half) }
    }

    /// Half of the diagonal: no probe is farther from the centre.
    pub(crate) fn radius(&self) -> f64 {
        self.half.length()
    }

    /// Whether a probe is one of them, or beside them by rounding.
    pub(crate) fn holds(&self, probe: DVec3) -> bool {
        (probe - self.centre).abs().cmple(self.half * (1.0 + 1e-6)).all()
    }

    /// The corner of an index in `0..8`, a bit an axis.
    pub(crate) fn corner(&self, index: usize) -> DVec3 {
        let side = |bit: usize| if index & bit == 0 { -1.0 } else { 1.0 };
        self.centre + self.half * DVec3::new(side(1), side(2), side(4))
    }
}

/// Polynomials of one degree with a bound of what `f64` has rounded.
///
/// Values are weighted means of the coefficients, so what holds for every coefficient and is convex holds on the whole
/// cell.
#[derive(Clone, Debug)]
pub(crate) struct Field<const D: usize> {
    pub polynomial: Bernstein<D>,
    /// Maximum factor of each component.
    reach: [f64; D],
    /// At least what rounding can add to a sum of all components times their factors.
    pub slack: f64,
}

impl<const D: usize> Field<D> {
    /// From components, raised to a common degree.
    pub(super) fn new(components: [&Tracked; D], factors: [f64; D], reach: [f64; D]) -> Self {
        let degree = [0, 1].map(|axis| components.iter().map(|c| c.polynomial.degree[axis]).max().unwrap_or_default());
        let components: [Tracked; D] = std::array::from_fn(|c| components[c].raised(degree));
        let count = (degree[0] + 1) * (degree[1] + 1);
        let entry =
            |index: usize| std::array::from_fn(|c| components[c].polynomial.coefficients[index][0] * factors[c]);
        let polynomial = Bernstein { degree, coefficients: (0..count).map(entry).collect() };
        let errors: f64 = (0..D).map(|c| components[c].error * factors[c].abs() * reach[c]).sum();
        let mut field = Self { polynomial, reach, slack: 0.0 };
        // What is done with a coefficient, sums of at most 14 products, rounds fewer than 32 times.
        field.slack = errors * (1.0 + 1e-9) + 32.0 * f64::EPSILON * field.magnitude();
        field
    }

    fn magnitude(&self) -> f64 {
        let largest = |c: usize| self.polynomial.coefficients.iter().map(|entry| entry[c].abs()).fold(0.0, f64::max);
        (0..D).map(|c| largest(c) * self.reach[c]).sum()
    }

    /// The four quarters: `u` below or above, then `v`.
    pub(super) fn quarters(&self) -> [Self; 4] {
        // An average rounds once, and there are as many rounds as degrees.
        let rounds = (self.polynomial.degree[0] + self.polynomial.degree[1]) as f64;
        let slack = self.slack + rounds * f64::EPSILON * self.magnitude();
        let [low, high] = self.polynomial.halves(0).map(|half| half.halves(1));
        let [a, b] = low;
        let [c, d] = high;
        [a, b, c, d].map(|polynomial| Self { polynomial, reach: self.reach, slack })
    }

    /// The coefficients of a part of the cell, row by row: what runs through them is the bake's innermost loop, and
    /// one over a slice is the fastest.
    pub(crate) fn on(&self, part: Part) -> impl Iterator<Item = &[[f64; D]]> {
        let [rows, columns] = part.indices(self.polynomial.degree);
        let width = self.polynomial.degree[1] + 1;
        let rows = &self.polynomial.coefficients[rows.start * width..rows.end * width];
        rows.chunks_exact(width).map(move |row| &row[columns.clone()])
    }
}

/// A component that is affine in the probe, `a − Q · b`, of entries `[a, b]`.
impl Field<4> {
    /// Its sign on a part of the cell for all probes: 0 unless it stays farther from zero than `margin` times the
    /// maximum length of `b`.
    pub(crate) fn sign(&self, part: Part, probes: &Probes, margin: f64) -> i8 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut steepest: f64 = 0.0;
        for row in self.on(part) {
            for [a, x, y, z] in row {
                let b = DVec3::new(*x, *y, *z);
                let (middle, reach) = (a - probes.centre.dot(b), probes.half.dot(b.abs()));
                (low, high) = (low.min(middle - reach), high.max(middle + reach));
                if low <= self.slack && high >= -self.slack {
                    return 0;
                }
                steepest = steepest.max(b.length_squared());
            }
        }
        let margin = margin * steepest.sqrt();
        i8::from(low - self.slack > margin) - i8::from(high + self.slack < -margin)
    }
}

/// The part of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// All of it.
    Inside,
    /// All but the line of coefficients along one of its sides, where the polynomial is known to vanish.
    Without(u8),
    /// The side `u` low, `u` high, `v` low, `v` high.
    Side(u8),
    /// A side without its two ends.
    SideWithout(u8, [bool; 2]),
    /// The corner: bit 0 for `u` high, bit 1 for `v` high.
    Corner(u8),
}

impl Part {
    /// Rows and columns of the coefficients, of degrees `p` and `q`.
    fn indices(self, [p, q]: [usize; 2]) -> [Range<usize>; 2] {
        let end = |high: bool, degree: usize| if high { degree..degree + 1 } else { 0..1 };
        match self {
            Self::Inside => [0..p + 1, 0..q + 1],
            Self::Without(0) => [1..p + 1, 0..q + 1],
            Self::Without(1) => [0..p.max(1), 0..q + 1],
            Self::Without(2) => [0..p + 1, 1..q + 1],
            Self::Without(_) => [0..p + 1, 0..q.max(1)],
            Self::Side(side @ (0 | 1)) => [end(side == 1, p), 0..q + 1],
            Self::Side(side) => [0..p + 1, end(side == 3, q)],
            Self::SideWithout(side, [low, high]) => {
                let along = |degree: usize| usize::from(low)..(degree + 1 - usize::from(high)).max(usize::from(low));
                if side < 2 { [end(side == 1, p), along(q)] } else { [along(p), end(side == 3, q)] }
            }
            Self::Corner(corner) => [end(corner & 1 != 0, p), end(corner & 2 != 0, q)],
        }
    }
}
