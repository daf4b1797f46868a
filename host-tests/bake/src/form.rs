//! First-order Taylor forms: a function on a cell as `centre + slope · (x, y)`, `x, y ∈ [−1, 1]`, give or take a
//! radius.
//!
//! Every operation encloses: what it drops and what `f64` rounds goes into the radius. The radius of a result falls
//! with the square of the cell's width, so few cells are enough where intervals would need thousands.

/// An enclosure of a function on a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    pub centre: f64,
    pub slope: [f64; 2],
    pub radius: f64,
}

/// At least the rounding of a few dependent operations, relative to the largest number in them: each rounds by half of
/// `f64::EPSILON`, no formula here has more than ten in a row.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

impl Form {
    pub(super) const fn constant(value: f64) -> Self {
        Self { centre: value, slope: [0.0; 2], radius: 0.0 }
    }

    /// A bound of the part that is kept.
    fn kept(&self) -> f64 {
        self.centre.abs() + self.slope[0].abs() + self.slope[1].abs()
    }

    /// A bound of the absolute value.
    fn magnitude(&self) -> f64 {
        (self.kept() + self.radius) * (1.0 + ROUNDING)
    }

    /// Bounds of its minimum and maximum.
    pub(super) fn range(&self) -> [f64; 2] {
        let reach = self.slope[0].abs() + self.slope[1].abs() + self.radius + ROUNDING * self.magnitude();
        [self.centre - reach, self.centre + reach]
    }

    /// Finishes an operation whose numbers were at most `largest`.
    fn rounded(centre: f64, slope: [f64; 2], radius: f64, largest: f64) -> Self {
        Self { centre, slope, radius: radius * (1.0 + ROUNDING) + ROUNDING * largest }
    }

    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let along = |axis: usize| self.slope[axis] + factor * other.slope[axis];
        let radius = self.radius + factor.abs() * other.radius;
        let largest = self.magnitude() + factor.abs() * other.magnitude();
        Self::rounded(self.centre + factor * other.centre, [along(0), along(1)], radius, largest)
    }

    /// The squares of `x` and `y` lie in `[0, 1]`: half of them is kept in the centre.
    pub(super) fn times(&self, other: &Self) -> Self {
        let along = |axis: usize| self.centre * other.slope[axis] + self.slope[axis] * other.centre;
        let square = |axis: usize| 0.5 * self.slope[axis] * other.slope[axis];
        let mixed = self.slope[0] * other.slope[1] + self.slope[1] * other.slope[0];
        let radius = square(0).abs()
            + square(1).abs()
            + mixed.abs()
            + self.radius * other.magnitude()
            + other.radius * self.kept();
        let centre = self.centre * other.centre + square(0) + square(1);
        Self::rounded(centre, [along(0), along(1)], radius, 2.0 * self.magnitude() * other.magnitude())
    }

    pub(super) fn scaled(&self, factor: f64) -> Self {
        Self::constant(0.0).plus(factor, self)
    }

    /// `offset + factor · self ± radius`.
    fn mapped(&self, offset: f64, factor: f64, radius: f64) -> Self {
        let line = Self::constant(offset).plus(factor, self);
        Self { radius: line.radius + radius, ..line }
    }

    /// `1/self`, or `None` if it is not proved positive. The line through the ends of the range, halfway down to the
    /// parallel tangent, at `√(low · high)`.
    pub(super) fn reciprocal(&self) -> Option<Self> {
        let [low, high] = self.range();
        if !(low > 0.0 && high < f64::INFINITY) {
            return None;
        }
        let (ends, least) = (1.0 / low + 1.0 / high, 2.0 / (low * high).sqrt());
        let off = 0.5 * (ends - least).max(0.0) + ROUNDING * ends;
        Some(self.mapped(0.5 * (ends + least), -1.0 / (low * high), off))
    }

    /// `√self`, or `None` if it is not proved positive. The same with the chord's slope `1/(√low + √high)`.
    pub(super) fn root(&self) -> Option<Self> {
        let [low, high] = self.range();
        if !(low > 0.0 && high < f64::INFINITY) {
            return None;
        }
        let (low, high) = (low.sqrt(), high.sqrt());
        let (ends, most) = (low * high / (low + high), 0.25 * (low + high));
        let off = 0.5 * (most - ends).max(0.0) + ROUNDING * high;
        Some(self.mapped(0.5 * (ends + most), 1.0 / (low + high), off))
    }
}

/// Bounds of both eigenvalues, over the cell, of the symmetric matrix `[[a, b], [b, c]]`.
///
/// The larger eigenvalue is a convex function of the matrix, the smaller a concave one: over a polytope of matrices
/// they are extreme at its corners, even for equal eigenvalues. The corners are those of the cell, with the radii
/// added; both eigenvalues rise with `a` and `c`.
pub(super) fn eigenvalues([a, b, c]: &[Form; 3]) -> [f64; 2] {
    let mut bounds = [f64::INFINITY, f64::NEG_INFINITY];
    let rounding = ROUNDING * (a.magnitude() + b.magnitude() + c.magnitude());
    for [x, y, side] in (0..8).map(|corner| [1, 2, 4].map(|bit| if corner & bit == 0 { -1.0 } else { 1.0 })) {
        let [p, q, r] = [a, b, c].map(|entry| entry.centre + entry.slope[0] * x + entry.slope[1] * y);
        let q = q + side * b.radius;
        let [least, _] = symmetric([p - a.radius, q, r - c.radius]);
        let [_, greatest] = symmetric([p + a.radius, q, r + c.radius]);
        bounds = [bounds[0].min(least), bounds[1].max(greatest)];
    }
    [bounds[0] - rounding, bounds[1] + rounding]
}

/// The eigenvalues of `[[a, b], [b, c]]`, rounded.
pub(super) fn symmetric([a, b, c]: [f64; 3]) -> [f64; 2] {
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let off = (half * half + b * b).sqrt();
    [mean - off, mean + off]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation, on a grid of cells and points, against the number itself.
    #[test]
    fn forms_enclose() {
        let inside = |form: &Form, [x, y]: [f64; 2], value: f64, what: &str| {
            let off = (form.centre + form.slope[0] * x + form.slope[1] * y - value).abs();
            // The comparison itself rounds.
            assert!(off <= form.radius + 1e-15 * value.abs(), "{what}: off by {off:e}, radius {:e}", form.radius);
        };
        let at = |form: &Form, [x, y]: [f64; 2]| form.centre + form.slope[0] * x + form.slope[1] * y;
        for step in 0..40 {
            let turn = f64::from(step);
            let a = Form { centre: 3.0, slope: [(0.7 * turn).sin(), 0.9 * (1.3 * turn).cos()], radius: 0.0 };
            let b = Form { centre: -1.0 + 0.1 * turn, slope: [(2.1 * turn).cos(), 0.4], radius: 0.0 };
            let (product, sum) = (a.times(&b), a.plus(-0.3, &b));
            let (inverse, root) = (a.reciprocal().unwrap(), a.root().unwrap());
            let bounds = eigenvalues(&[a, b, sum]);
            for i in -4..=4 {
                for j in -4..=4 {
                    let point = [f64::from(i) / 4.0, f64::from(j) / 4.0];
                    let (p, q) = (at(&a, point), at(&b, point));
                    inside(&product, point, p * q, "product");
                    inside(&sum, point, p - 0.3 * q, "sum");
                    inside(&inverse, point, 1.0 / p, "reciprocal");
                    inside(&root, point, p.sqrt(), "root");
                    let [least, greatest] = symmetric([p, q, at(&sum, point)]);
                    assert!(bounds[0] <= least && greatest <= bounds[1]);
                }
            }
        }
        assert!(Form { centre: 1.0, slope: [0.5, 0.5], radius: 0.1 }.reciprocal().is_none());
    }
}
