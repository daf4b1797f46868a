//! Horner's rule for a tensor-product polynomial with all derivatives up to the second, in one sweep over the
//! coefficients.
//!
//! # Minimum cost
//! Counted by hand for a biquadratic polynomial span on a Cortex-M4F, as in [`super::horner`].
//!
//! | | a component | three |
//! |---|---|---|
//! | loads of coefficients | 9 | 27 |
//! | three rows: `p = c₂ t`, `q = p + c₁`, derivative `p + q`, value `q t + c₀`; half the second derivative is `c₂` |
//! 3 × 4 | 36 |
//! | values joined along `s`: as a row, half of `f_ss` the highest | 4 | 12 |
//! | derivatives joined along `s`: as a row, for `f_t` and `f_st` | 4 | 12 |
//! | halves of `f_tt` joined along `s`: two multiply-adds | 2 | 6 |
//! | stores of point, tangents, second derivatives | 6 | 18 |
//! | `u`, `v` to the span's centre; call and return | | 4 |
//! | in all | | 115 |

use super::horner::horner_step;
use core::array::from_fn;

/// Value and derivatives of a polynomial with `D` components; second derivatives of one variable are halved, as
/// Horner's rule gives them.
pub(super) struct Taylor<const D: usize> {
    pub value: [f32; D],
    pub along: [[f32; D]; 2],
    pub half_ss: [f32; D],
    pub mixed: [f32; D],
    pub half_tt: [f32; D],
}

/// Evaluates `Σᵢⱼ c[i][j] sⁱ tʲ` with its derivatives; the coefficients as of [`super::horner::evaluate`]. One
/// component after the other: together they would not fit into the registers.
#[inline(always)]
pub(super) fn evaluate<const D: usize, const Q: usize>(coefficients: &[[f32; D]], s: f32, t: f32) -> Taylor<D> {
    // Of many coefficients the compiler keeps the loop: filled in order, its result need not be zeroed first, which takes
    // 60 instructions.
    if Q >= 5 || coefficients.len() > 16 {
        let parts: [_; D] = from_fn(|component| evaluate_one::<D, Q>(coefficients, component, s, t));
        let of = |index: usize| parts.map(|part: [f32; 6]| part[index]);
        return Taylor { value: of(0), along: [of(1), of(2)], half_ss: of(3), mixed: of(4), half_tt: of(5) };
    }
    let zero = [0.0; D];
    let mut d = Taylor { value: zero, along: [zero; 2], half_ss: zero, mixed: zero, half_tt: zero };
    for component in 0..D {
        // A branch for each component, never taken: in one block the compiler loads the coefficients of all at once,
        // and runs out of registers.
        if D == 3 && ((component == 1 && s.is_nan()) || (component == 2 && t.is_nan())) {
            return d;
        }
        let [value, along_s, along_t, half_ss, mixed, half_tt] = evaluate_one::<D, Q>(coefficients, component, s, t);
        d.value[component] = value;
        d.along[0][component] = along_s;
        d.along[1][component] = along_t;
        d.half_ss[component] = half_ss;
        d.mixed[component] = mixed;
        d.half_tt[component] = half_tt;
    }
    d
}

/// One component: value, `∂/∂s`, `∂/∂t`, `½ ∂²/∂s²`, `∂²/∂s∂t`, `½ ∂²/∂t²`.
#[inline(always)]
fn evaluate_one<const D: usize, const Q: usize>(
    coefficients: &[[f32; D]],
    component: usize,
    s: f32,
    t: f32,
) -> [f32; 6] {
    let Some((lower, highest)) = coefficients.split_last_chunk::<Q>() else { return [0.0; 6] };
    let Some((mut lower, next)) = lower.split_last_chunk::<Q>() else { return [0.0; 6] };
    // The first rows differ: a derivative that is zero so far needs no multiplication.
    let (highest, next) = (row(highest, component, t), row(next, component, t));
    let (mut value, mut along_s) = (highest[0] * s + next[0], highest[0]);
    let (mut along_t, mut mixed) = (highest[1] * s + next[1], highest[1]);
    // A row of two has no second derivative.
    let mut half_tt = if Q > 2 { highest[2] * s + next[2] } else { 0.0 };
    let mut half_ss = 0.0;
    let mut is_third = true;
    while let Some((rest, coefficients)) = lower.split_last_chunk::<Q>() {
        let row = row(coefficients, component, t);
        half_ss = if is_third { along_s } else { half_ss * s + along_s };
        is_third = false;
        along_s = along_s * s + value;
        value = value * s + row[0];
        mixed = mixed * s + along_t;
        along_t = along_t * s + row[1];
        if Q > 2 {
            half_tt = half_tt * s + row[2];
        }
        lower = rest;
    }
    [value, along_s, along_t, half_ss, mixed, half_tt]
}

/// One component of a row's polynomial in `t` with its first derivative, and half its second.
#[inline(always)]
fn row<const D: usize, const Q: usize>(coefficients: &[[f32; D]; Q], component: usize, t: f32) -> [f32; 3] {
    let [mut value, mut along, mut half] = [coefficients[Q - 1][component], 0.0, 0.0];
    for (index, power) in coefficients.iter().rev().skip(1).enumerate() {
        match index {
            0 => along = value,
            1 => {
                half = along;
                along = along * t + value;
            }
            _ => {
                half = half * t + along;
                along = along * t + value;
            }
        }
        value = value * t + power[component];
    }
    [value, along, half]
}

/// The same for rows of any length, by loops: slower, and small.
#[inline(always)]
pub(super) fn evaluate_rows<const D: usize>(coefficients: &[[f32; D]], columns: usize, s: f32, t: f32) -> Taylor<D> {
    let zero = [0.0; D];
    let mut d = Taylor { value: zero, along: [zero; 2], half_ss: zero, mixed: zero, half_tt: zero };
    for row in coefficients.rchunks_exact(columns) {
        let (mut value, mut along, mut half) = (zero, zero, zero);
        for power in row.iter().rev() {
            half = horner_step(half, t, along);
            along = horner_step(along, t, value);
            value = horner_step(value, t, *power);
        }
        d.half_ss = horner_step(d.half_ss, s, d.along[0]);
        d.along[0] = horner_step(d.along[0], s, d.value);
        d.mixed = horner_step(d.mixed, s, d.along[1]);
        d.value = horner_step(d.value, s, value);
        d.along[1] = horner_step(d.along[1], s, along);
        d.half_tt = horner_step(d.half_tt, s, half);
    }
    d
}
