//! Horner's rule for a tensor-product polynomial and its two partial derivatives, in one sweep over the coefficients.

use core::array;

/// Value and both partial derivatives of a polynomial with `D` components.
pub(super) struct Derivatives<const D: usize> {
    pub value: [f32; D],
    pub along_s: [f32; D],
    pub along_t: [f32; D],
}

/// Evaluates `Σᵢⱼ c[i][j] sⁱ tʲ` with `∂/∂s` and `∂/∂t`.
///
/// `rows` holds one span's coefficients, row `i` (the power of `s`) of `Q` entries each (`Q - 1` the degree along `t`).
/// Work: per component `(2Q - 3)` multiply-adds a row and 3 a row to join them.
pub(super) fn evaluate<const D: usize, const Q: usize>(rows: &[[[f32; D]; Q]], s: f32, t: f32) -> Derivatives<D> {
    let mut joined = Derivatives { value: [0.0; D], along_s: [0.0; D], along_t: [0.0; D] };
    let Some((highest, lower)) = rows.split_last() else { return joined };
    (joined.value, joined.along_t) = row(highest, t);
    for coefficients in lower.iter().rev() {
        let (value, along_t) = row(coefficients, t);
        joined.along_s = horner_step(joined.along_s, s, joined.value);
        joined.value = horner_step(joined.value, s, value);
        joined.along_t = horner_step(joined.along_t, s, along_t);
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
fn horner_step<const D: usize>(accumulated: [f32; D], x: f32, next: [f32; D]) -> [f32; D] {
    array::from_fn(|component| accumulated[component] * x + next[component])
}
