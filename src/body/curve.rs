//! Border curves: polynomial spans in one parameter, kept like those of a patch.

use crate::math::{Vec3, vec3};
use crate::patch::{Coefficients, MAX_SPANS, bisect, horner_step};
use crate::tally;

/// The highest degree of a curve: the cross derivative of a rational patch of degree 5 has twice its degree.
pub const MAX_CURVE_DEGREE: usize = 10;

/// A point of a curve with its tangent and second derivative: one evaluation.
///
/// # Units
/// Metres; the tangent in metres per unit of parameter, *not* normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// `c(t)`.
    pub point: Vec3,
    /// `c' = dc/dt`.
    pub tangent: Vec3,
    /// `½ c''`, metres per unit of parameter squared.
    pub half_second: Vec3,
}

/// A piecewise polynomial or rational curve over `[0, 1]`, as a table in flash.
///
/// # Shapes
/// `breaks` are the span borders, rising from 0 to 1. Span `i` has `degree + 1` coefficients, entry `k` the power `k`
/// of the distance from the span's centre.
#[derive(Clone, Copy, Debug)]
pub struct SplineCurve<'a> {
    /// 1 to [`MAX_CURVE_DEGREE`]; 0 is a constant.
    pub degree: u8,
    /// Span borders.
    pub breaks: &'a [f32],
    /// Coefficients of all spans.
    pub coefficients: Coefficients<'a>,
    /// `sup ‖c''‖`, metres per unit of parameter squared, rounding included: for the certified step along the curve.
    pub second_derivative: f32,
}

impl SplineCurve<'_> {
    /// Whether borders and coefficients fit together and are finite.
    pub(super) const fn is_valid(&self) -> bool {
        let count = match self.coefficients {
            Coefficients::Polynomial(entries) => entries.len(),
            Coefficients::Rational(entries) => entries.len(),
        };
        let spans = self.breaks.len().wrapping_sub(1);
        if spans == 0 || spans > MAX_SPANS || self.degree as usize > MAX_CURVE_DEGREE {
            return false;
        }
        let bounded = self.second_derivative >= 0.0 && self.second_derivative < f32::INFINITY;
        bounded && count == spans * (self.degree as usize + 1) && crate::patch::breaks_are_valid(self.breaks)
    }

    /// The point with its derivatives at `t`. Parameters outside `[0, 1]` extrapolate the nearest span; the tracker
    /// never asks for them.
    #[inline(never)]
    pub fn evaluate(&self, t: f32) -> CurvePoint {
        tally::curve();
        match self.coefficients {
            Coefficients::Polynomial(entries) => {
                let [value, along, half] = self.span(entries, t);
                let [point, tangent, half_second] = [value, along, half].map(Vec3::from_array);
                CurvePoint { point, tangent, half_second }
            }
            Coefficients::Rational(entries) => {
                let [(a, w), (a_t, w_t), (a_tt, w_tt)] = self.span(entries, t).map(|[x, y, z, w]| (vec3(x, y, z), w));
                let inverse = 1.0 / w;
                let point = a * inverse;
                let tangent = (a_t - point * w_t) * inverse;
                CurvePoint { point, tangent, half_second: (a_tt - tangent * w_t - point * w_tt) * inverse }
            }
        }
    }

    /// [`crate::patch::Patch::beyond_knots`] of a curve.
    #[inline]
    pub(super) fn beyond_knots(&self, from: f32, to: f32) -> f32 {
        if self.breaks.len() == 2 {
            return 0.0;
        }
        crate::patch::beyond(self.breaks, bisect(self.breaks, from).0, bisect(self.breaks, to).0, to)
    }

    /// The point alone.
    #[inline(never)]
    pub fn point(&self, t: f32) -> Vec3 {
        tally::curve();
        match self.coefficients {
            Coefficients::Polynomial(entries) => Vec3::from_array(value(self.powers(entries, t))),
            Coefficients::Rational(entries) => {
                let [x, y, z, w] = value(self.powers(entries, t));
                vec3(x, y, z) * (1.0 / w)
            }
        }
    }

    /// Value, derivative, and half the second derivative at a parameter.
    #[inline]
    fn span<const D: usize>(&self, entries: &[[f32; D]], t: f32) -> [[f32; D]; 3] {
        let (zero, (powers, s)) = ([0.0; D], self.powers(entries, t));
        let Some((highest, lower)) = powers.split_last() else { return [zero; 3] };
        let Some((next, lower)) = lower.split_last() else { return [*highest, zero, zero] };
        // The derivative starts with the highest coefficient: a step of Horner's rule before it would multiply zero.
        let (mut value, mut along, mut half) = (horner_step(*highest, s, *next), *highest, zero);
        for coefficient in lower.iter().rev() {
            half = horner_step(half, s, along);
            along = horner_step(along, s, value);
            value = horner_step(value, s, *coefficient);
        }
        [value, along, half]
    }

    /// The coefficients of the span that holds a parameter, and its distance from the span's centre.
    #[inline]
    fn powers<'a, const D: usize>(&self, entries: &'a [[f32; D]], t: f32) -> (&'a [[f32; D]], f32) {
        // Most curves have one span, from 0 to 1.
        if self.breaks.len() == 2 {
            return (entries, t - 0.5);
        }
        let (order, (span, s)) = (self.degree as usize + 1, bisect(self.breaks, t));
        // The constructor counted the entries: the empty slice is never taken, it only keeps a panic out of the tick.
        (entries.get(span * order..(span + 1) * order).unwrap_or(&[]), s)
    }
}

/// Horner's rule.
#[inline]
fn value<const D: usize>((powers, s): (&[[f32; D]], f32)) -> [f32; D] {
    // Most often a parabola: without a loop.
    if let [first, next, highest] = powers {
        return horner_step(horner_step(*highest, s, *next), s, *first);
    }
    let Some((highest, mut lower)) = powers.split_last() else { return [0.0; D] };
    let mut value = *highest;
    // In twos: a step alone ends in other registers than it starts from.
    while let [rest @ .., next, coefficient] = lower {
        value = horner_step(horner_step(value, s, *coefficient), s, *next);
        lower = rest;
    }
    if let [coefficient] = lower { horner_step(value, s, *coefficient) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_without_a_bound_is_refused() {
        let curve = |second_derivative| SplineCurve {
            degree: 0,
            breaks: &[0.0, 1.0],
            coefficients: Coefficients::Polynomial(&[[0.0; 3]]),
            second_derivative,
        };
        assert!(curve(0.0).is_valid() && curve(f32::MAX).is_valid());
        for bad in [-1.0, f32::INFINITY, f32::NAN] {
            assert!(!curve(bad).is_valid(), "{bad}");
        }
    }
}
