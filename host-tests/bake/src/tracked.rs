//! A polynomial on the unit square with a bound of what `f64` rounded in its Bernstein coefficients.

use super::bernstein::{Bernstein, power_of};

/// Coefficient by coefficient within `error` of the exact polynomial.
#[derive(Clone, Debug)]
pub(super) struct Tracked {
    pub polynomial: Bernstein<1>,
    pub error: f64,
}

impl Tracked {
    /// The components of a span, from the powers of `s` and `t` over their ranges.
    ///
    /// A blossom is a sum of at most 6 products of at most 12 factors, and two of them with a coefficient make a term
    /// of the 36: each has seen fewer than 64 roundings relative to the sum of what the powers can reach.
    pub(super) fn of_span(degree: [usize; 2], powers: &[[f64; 4]], ranges: [[f64; 2]; 2]) -> [Self; 4] {
        let all = Bernstein::from_powers(degree, powers, ranges[0], ranges[1]);
        let reach = ranges.map(|[low, high]| low.abs().max(high.abs()));
        std::array::from_fn(|component| {
            let sum: f64 = (0..powers.len())
                .map(|index| {
                    let (k, l) = (index / (degree[1] + 1), index % (degree[1] + 1));
                    powers[index][component].abs() * power_of(reach[0], k) * power_of(reach[1], l)
                })
                .sum();
            Self { polynomial: all.components(|entry| [entry[component]]), error: 64.0 * f64::EPSILON * sum }
        })
    }

    pub(super) fn constant(value: f64) -> Self {
        Self { polynomial: Bernstein { degree: [0, 0], coefficients: vec![[value]] }, error: 0.0 }
    }

    pub(super) fn largest(&self) -> f64 {
        self.polynomial.coefficients.iter().map(|[value]| value.abs()).fold(0.0, f64::max)
    }

    pub(super) fn derivative(&self, axis: usize) -> Self {
        let factor = 2.0 * self.polynomial.degree[axis] as f64;
        let error = factor * (self.error + f64::EPSILON * self.largest());
        Self { polynomial: self.polynomial.derivative(axis), error }
    }

    /// A coefficient of the product is a mean of products, with shares that round fewer than 60 times (three binomials
    /// each way, of degrees up to 20), in a sum of as many terms as the smaller factor has.
    pub(super) fn times(&self, other: &Self) -> Self {
        let (a, b) = (self.largest(), other.largest());
        let terms = self.polynomial.coefficients.len().min(other.polynomial.coefficients.len());
        let error = a * other.error + b * self.error + self.error * other.error;
        let rounding = f64::EPSILON * (64 + terms) as f64 * a * b;
        Self { polynomial: self.polynomial.times(&other.polynomial), error: error * (1.0 + 1e-9) + rounding }
    }

    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let polynomial = self.polynomial.plus(factor, &other.polynomial);
        // Raising to the common degree is a product with 1.
        let rounding = 2.0 * f64::EPSILON * 128.0 * (self.largest() + factor.abs() * other.largest());
        Self { polynomial, error: (self.error + factor.abs() * other.error) * (1.0 + 1e-9) + rounding }
    }

    /// Raised to a degree, for polynomials that are to share one.
    pub(super) fn raised(&self, degree: [usize; 2]) -> Self {
        let count = (degree[0] + 1) * (degree[1] + 1);
        let zero = Bernstein { degree, coefficients: vec![[0.0]; count] };
        self.plus(0.0, &Self { polynomial: zero, error: 0.0 })
    }

    /// Whether every coefficient is zero, which is exact: sums of zeros do not round.
    pub(super) fn is_zero(&self) -> bool {
        self.largest() == 0.0
    }
}
