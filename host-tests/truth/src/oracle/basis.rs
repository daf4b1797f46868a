//! B-spline basis functions with two derivatives, by the recursion of Cox and de Boor.

use palpate::patch::MAX_DEGREE;

const ORDER: usize = MAX_DEGREE + 1;

/// The `degree + 1` basis functions that are not zero at a parameter; the first belongs to control point `first`.
pub(super) struct Basis {
    pub first: usize,
    /// `[derivative][function]`.
    pub values: [[f64; ORDER]; 3],
}

impl Basis {
    /// At a parameter in `[0, 1]`; on an inner knot the span above it is taken, at 1 the last.
    pub(super) fn new(knots: &[f64], degree: usize, parameter: f64) -> Self {
        let points = knots.len() - degree - 1;
        let above = knots[degree + 1..points].partition_point(|knot| *knot <= parameter);
        let span = degree + above;
        let first = span - degree;
        // levels[d][k]: function k of degree d that is not zero on the span; it starts at knot span - d + k.
        let mut levels = [[0.0; ORDER]; ORDER];
        levels[0][0] = 1.0;
        for d in 1..=degree {
            for k in 0..=d {
                let start = span + k - d;
                let rising = if k > 0 { levels[d - 1][k - 1] } else { 0.0 };
                let falling = if k < d { levels[d - 1][k] } else { 0.0 };
                levels[d][k] = ratio(rising * (parameter - knots[start]), knots[start + d] - knots[start])
                    + ratio(falling * (knots[start + d + 1] - parameter), knots[start + d + 1] - knots[start + 1]);
            }
        }
        // N' = d (N⁻/width - N⁺/width) with the functions, or the derivatives, of one degree less.
        let differentiate = |lower: &[f64; ORDER], d: usize| {
            let mut derivative = [0.0; ORDER];
            for (k, entry) in derivative.iter_mut().enumerate().take(d + 1) {
                let start = span + k - d;
                let rising = if k > 0 { ratio(lower[k - 1], knots[start + d] - knots[start]) } else { 0.0 };
                let falling = if k < d { ratio(lower[k], knots[start + d + 1] - knots[start + 1]) } else { 0.0 };
                *entry = d as f64 * (rising - falling);
            }
            derivative
        };
        let first_derivative = differentiate(&levels[degree - 1], degree);
        let second_derivative = if degree >= 2 {
            differentiate(&differentiate(&levels[degree - 2], degree - 1), degree)
        } else {
            [0.0; ORDER]
        };
        Self { first, values: [levels[degree], first_derivative, second_derivative] }
    }
}

/// `0 / 0 = 0`, the convention of the recursion for functions that repeated knots have squeezed out.
fn ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { numerator / denominator } else { 0.0 }
}
