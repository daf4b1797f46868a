//! Polynomials in the parameters that are affine in the probe, on a cell of the parameters, and the probes they are
//! bounded for.

use crate::bernstein::Bernstein;
use crate::tracked::Tracked;
use glam::DVec3;
use std::ops::Range;

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
    /// What a component can be multiplied with at most.
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
    /// greatest length of `b`.
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

/// What part of a cell is meant.
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
