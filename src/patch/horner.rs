//! Horner's rule for a tensor-product polynomial and its two partial derivatives, in one sweep over the coefficients.
//!
//! # Minimum cost
//! Counted by hand for a biquadratic polynomial span on a Cortex-M4F, in instructions. There is no fused multiply-add,
//! because host and target would differ; `vmla`, which rounds twice, counts as one.
//!
//! | | a component | three |
//! |---|---|---|
//! | loads of coefficients | 9 | 27 |
//! | three rows: `p = c₂ t`, `q = p + c₁`, derivative `p + q`, value `q t + c₀` | 3 × 4 | 36 |
//! | joined along `t`: two multiply-adds | 2 | 6 |
//! | joined along `s`: as a row | 4 | 12 |
//! | stores of point and tangents | 3 | 9 |
//! | `u`, `v` to the span's centre; call and return | | 4 |
//! | in all | | 94 |
//!
//! With each of the 42 multiply-adds a `vmla`, no product shared, it would be 82; but `vmla` takes three cycles and
//! the sums that share a product one each. The budget test limits the evaluation to 1.25 × 94. The 94 leave out the
//! choice of the kind of table, and of the span in a patch of several.

use core::array;

/// Value and both partial derivatives of a polynomial with `D` components.
pub(super) struct Derivatives<const D: usize> {
    pub value: [f32; D],
    pub along_s: [f32; D],
    pub along_t: [f32; D],
}

/// Evaluates `Σᵢⱼ c[i][j] sⁱ tʲ` with `∂/∂s` and `∂/∂t`.
///
/// `coefficients` are one span's: rows of `Q` entries (`Q - 1` the degree along `t`), two rows or more, row `i` for the
/// power `i` of `s`. Work: per component `2Q - 3` multiply-adds a row and 3 a row to join them, 4 fewer for the two
/// highest.
#[inline(always)]
pub(super) fn evaluate<const D: usize, const Q: usize>(coefficients: &[[f32; D]], s: f32, t: f32) -> Derivatives<D> {
    let none = Derivatives { value: [0.0; D], along_s: [0.0; D], along_t: [0.0; D] };
    let Some((lower, highest)) = coefficients.split_last_chunk::<Q>() else { return none };
    let Some((mut lower, next)) = lower.split_last_chunk::<Q>() else { return none };
    // The derivative along s starts with the highest row: a step of Horner's rule before it would multiply zero.
    let (along_s, highest_along_t) = row(highest, t);
    let (next, next_along_t) = row(next, t);
    let mut joined = Derivatives {
        value: horner_step(along_s, s, next),
        along_s,
        along_t: horner_step(highest_along_t, s, next_along_t),
    };
    while let Some((rest, coefficients)) = lower.split_last_chunk::<Q>() {
        let (value, along_t) = row(coefficients, t);
        joined.along_s = horner_step(joined.along_s, s, joined.value);
        joined.value = horner_step(joined.value, s, value);
        joined.along_t = horner_step(joined.along_t, s, along_t);
        lower = rest;
    }
    joined
}

/// One row's value and derivative along `t`.
#[inline(always)]
fn row<const D: usize, const Q: usize>(coefficients: &[[f32; D]; Q], t: f32) -> ([f32; D], [f32; D]) {
    let [lower @ .., highest] = coefficients.as_slice() else { return ([0.0; D], [0.0; D]) };
    let mut value = *highest;
    let mut derivative = [0.0; D];
    for (index, coefficient) in lower.iter().rev().enumerate() {
        // The first derivative step would only multiply zero.
        derivative = if index == 0 { value } else { horner_step(derivative, t, value) };
        value = horner_step(value, t, *coefficient);
    }
    (value, derivative)
}

/// `accumulated · x + next`, component by component.
#[inline(always)]
pub(crate) fn horner_step<const D: usize>(accumulated: [f32; D], x: f32, next: [f32; D]) -> [f32; D] {
    array::from_fn(|component| accumulated[component] * x + next[component])
}
