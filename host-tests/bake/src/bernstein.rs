//! Polynomials in two variables on a rectangle, in Bernstein form: their values are weighted means of their
//! coefficients, which is what makes a bound on the coefficients a bound on the polynomial.

/// A polynomial with `D` components over `[0, 1]²`; coefficient `(i, j)` is entry `i · (degree[1] + 1) + j`.
#[derive(Clone, Debug)]
pub(super) struct Bernstein<const D: usize> {
    pub degree: [usize; 2],
    pub coefficients: Vec<[f64; D]>,
}

impl<const D: usize> Bernstein<D> {
    fn from_fn(degree: [usize; 2], mut entry: impl FnMut(usize, usize) -> [f64; D]) -> Self {
        let mut coefficients = Vec::with_capacity((degree[0] + 1) * (degree[1] + 1));
        for i in 0..=degree[0] {
            for j in 0..=degree[1] {
                coefficients.push(entry(i, j));
            }
        }
        Self { degree, coefficients }
    }

    pub(super) fn at(&self, i: usize, j: usize) -> &[f64; D] {
        &self.coefficients[i * (self.degree[1] + 1) + j]
    }

    /// From powers of `s` and `t` over `[s₀, s₁] × [t₀, t₁]`.
    pub(super) fn from_powers(degree: [usize; 2], powers: &[[f64; D]], s: [f64; 2], t: [f64; 2]) -> Self {
        let table = Self { degree, coefficients: powers.to_vec() };
        let blossoms = |degree: usize, range: [f64; 2]| -> Vec<Vec<f64>> {
            (0..=degree).map(|index| (0..=degree).map(|power| blossom(degree, power, index, range)).collect()).collect()
        };
        let (blossoms_s, blossoms_t) = (blossoms(degree[0], s), blossoms(degree[1], t));
        let along_t = Self::from_fn(degree, |i, j| sum(degree[1], |k| (*table.at(i, k), blossoms_t[j][k])));
        Self::from_fn(degree, |i, j| sum(degree[0], |k| (*along_t.at(k, j), blossoms_s[i][k])))
    }

    /// The derivative along one axis (0 or 1), as a derivative by the unit-square parameter.
    pub(super) fn derivative(&self, axis: usize) -> Self {
        let mut degree = self.degree;
        if degree[axis] == 0 {
            return Self::from_fn(degree, |_, _| [0.0; D]);
        }
        let factor = degree[axis] as f64;
        degree[axis] -= 1;
        Self::from_fn(degree, |i, j| {
            let (low, high) = (self.at(i, j), if axis == 0 { self.at(i + 1, j) } else { self.at(i, j + 1) });
            std::array::from_fn(|c| factor * (high[c] - low[c]))
        })
    }

    /// The product with a scalar polynomial; its degree is the sum.
    pub(super) fn times(&self, scalar: &Bernstein<1>) -> Self {
        let [a, b] = [self.degree, scalar.degree];
        let degree = [a[0] + b[0], a[1] + b[1]];
        // Computed once a product: they would be most of its cost.
        let shares = [0, 1].map(|axis| {
            let share = |whole: usize, own: usize| {
                let other = whole.checked_sub(own).map_or(0.0, |other| binomial(b[axis], other));
                binomial(a[axis], own) * other / binomial(degree[axis], whole)
            };
            (0..=degree[axis]).map(|whole| (0..=a[axis]).map(|own| share(whole, own)).collect()).collect()
        });
        let [shares_u, shares_v]: [Vec<Vec<f64>>; 2] = shares;
        let range = |axis: usize, whole: usize| whole.saturating_sub(b[axis])..=whole.min(a[axis]);
        Self::from_fn(degree, |i, j| {
            let mut total = [0.0; D];
            for k in range(0, i) {
                for l in range(1, j) {
                    let factor = shares_u[i][k] * shares_v[j][l] * scalar.at(i - k, j - l)[0];
                    accumulate(&mut total, self.at(k, l), factor);
                }
            }
            total
        })
    }

    /// `self + factor · other`; the two are raised to a common degree.
    pub(super) fn plus(&self, factor: f64, other: &Self) -> Self {
        let degree = [0, 1].map(|axis| self.degree[axis].max(other.degree[axis]));
        let (mut total, other) = (self.raised(degree), other.raised(degree));
        for (entry, added) in total.coefficients.iter_mut().zip(&other.coefficients) {
            accumulate(entry, added, factor);
        }
        total
    }

    fn raised(&self, degree: [usize; 2]) -> Self {
        if degree == self.degree {
            return self.clone();
        }
        let missing = [degree[0] - self.degree[0], degree[1] - self.degree[1]];
        let one = Bernstein::<1>::from_fn(missing, |_, _| [1.0]);
        self.times(&one)
    }

    /// Some of the components, as a polynomial of their own.
    pub(super) fn components<const E: usize>(&self, pick: impl Fn(&[f64; D]) -> [f64; E]) -> Bernstein<E> {
        Bernstein { degree: self.degree, coefficients: self.coefficients.iter().map(pick).collect() }
    }

    /// Both halves along one axis, by de Casteljau's averaging.
    pub(super) fn halves(&self, axis: usize) -> [Self; 2] {
        let (mut low, mut high) = (self.clone(), self.clone());
        let columns = self.degree[1] + 1;
        let (lines, stride, start) = if axis == 0 { (columns, columns, 1) } else { (self.degree[0] + 1, 1, columns) };
        for line in 0..lines {
            let index = |k: usize| line * start + k * stride;
            for round in 1..=self.degree[axis] {
                for k in 0..=self.degree[axis] - round {
                    let (a, b) = (high.coefficients[index(k)], high.coefficients[index(k + 1)]);
                    high.coefficients[index(k)] = std::array::from_fn(|c| 0.5 * (a[c] + b[c]));
                }
                low.coefficients[index(round)] = high.coefficients[index(0)];
            }
        }
        [low, high]
    }
}

/// The coefficient `index` of `xᵖᵒʷᵉʳ` over `[a, b]` at a degree: the mean of all products of `power` out of
/// `index` times `b` and `degree − index` times `a`.
fn blossom(degree: usize, power: usize, index: usize, [a, b]: [f64; 2]) -> f64 {
    let term = |from_b: usize| {
        let from_a = power - from_b;
        if from_b > index || from_a > degree - index {
            return 0.0;
        }
        binomial(index, from_b) * binomial(degree - index, from_a) * power_of(b, from_b) * power_of(a, from_a)
    };
    (0..=power).map(term).sum::<f64>() / binomial(degree, power)
}

/// Exact up to the degree 15 of a second derivative of a rational quintic.
pub(super) fn binomial(n: usize, k: usize) -> f64 {
    // Of more than n there are none: the product passes 0.
    (0..k).fold(1.0, |product, i| product * n.saturating_sub(i) as f64 / (i + 1) as f64)
}

/// `xᵏ` by multiplication: the standard library's power may differ in the last bit from machine to machine.
pub(super) fn power_of(x: f64, exponent: usize) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * x)
}

fn sum<const D: usize>(degree: usize, term: impl Fn(usize) -> ([f64; D], f64)) -> [f64; D] {
    let mut total = [0.0; D];
    for k in 0..=degree {
        let (entry, factor) = term(k);
        accumulate(&mut total, &entry, factor);
    }
    total
}

fn accumulate<const D: usize>(total: &mut [f64; D], entry: &[f64; D], factor: f64) {
    for (total, entry) in total.iter_mut().zip(entry) {
        *total += entry * factor;
    }
}

// A polynomial on the unit square with a bound of what `f64` rounded in its Bernstein coefficients.

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
