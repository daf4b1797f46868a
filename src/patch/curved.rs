//! A point with both tangents and all second derivatives: what a cold start needs, and the tick does not.

use super::SurfacePoint;
use super::coefficients::Coefficients;
use super::horner::horner_step;
use super::spline::SplinePatch;
use crate::math::{Vec3, vec3};

/// A point of a patch with its derivatives up to the second: one evaluation, at about twice the cost of the first derivatives alone.
///
/// # Units
/// Metres, metres per unit of parameter, metres per unit squared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvedPoint {
    /// The point and both tangents.
    pub surface: SurfacePoint,
    /// `f_uu`.
    pub second_uu: Vec3,
    /// `f_uv`.
    pub second_uv: Vec3,
    /// `f_vv`.
    pub second_vv: Vec3,
}

/// Value and derivatives of a polynomial with `D` components; second derivatives of one variable are halved, as Horner's rule
/// gives them.
struct Taylor<const D: usize> {
    value: [f32; D],
    along: [[f32; D]; 2],
    half_ss: [f32; D],
    mixed: [f32; D],
    half_tt: [f32; D],
}

impl SplinePatch {
    /// The point and its derivatives up to the second at `(u, v)`, by Horner's rule on the span that holds it.
    pub fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        // A single span needs no search: it goes from 0 to 1.
        let (span, [s, t]) = if self.grid.is_one_span() { (0, [u - 0.5, v - 0.5]) } else { self.grid.locate(u, v) };
        match self.spans.coefficients() {
            Coefficients::Polynomial(entries) => {
                let d = self.taylor(entries, span, s, t);
                let [tangent_u, tangent_v] = d.along.map(Vec3::from_array);
                let surface = SurfacePoint { point: Vec3::from_array(d.value), tangent_u, tangent_v };
                let second_uu = Vec3::from_array(d.half_ss) * 2.0;
                let second_vv = Vec3::from_array(d.half_tt) * 2.0;
                CurvedPoint { surface, second_uu, second_uv: Vec3::from_array(d.mixed), second_vv }
            }
            Coefficients::Rational(entries) => divide_by_weight(&self.taylor(entries, span, s, t)),
        }
    }

    /// Horner's rule over one span; every loop ends with the degree.
    fn taylor<const D: usize>(&self, entries: &[[f32; D]], span: usize, s: f32, t: f32) -> Taylor<D> {
        let [rows, columns] = self.grid.degree.map(|degree| usize::from(degree) + 1);
        let first = span * rows * columns;
        // The constructor counted the entries: the empty slice is never taken, it only keeps a panic out of the search.
        let powers = entries.get(first..first + rows * columns).unwrap_or(&[]);
        let zero = [0.0; D];
        let mut d = Taylor { value: zero, along: [zero; 2], half_ss: zero, mixed: zero, half_tt: zero };
        for (index, row) in powers.chunks_exact(columns).rev().enumerate() {
            let row = Row::new(row, t);
            // Of a derivative that is zero so far there is nothing to multiply: the first rows are not like the others.
            match index {
                0 => (d.value, d.along[1], d.half_tt) = (row.value, row.along, row.half),
                1 => {
                    (d.along[0], d.mixed) = (d.value, d.along[1]);
                    d.join(&row, s);
                }
                _ => {
                    d.half_ss = if index == 2 { d.along[0] } else { horner_step(d.half_ss, s, d.along[0]) };
                    d.along[0] = horner_step(d.along[0], s, d.value);
                    d.mixed = horner_step(d.mixed, s, d.along[1]);
                    d.join(&row, s);
                }
            }
        }
        d
    }
}

impl<const D: usize> Taylor<D> {
    /// One row more for what is not derived along `s`.
    #[inline(always)]
    fn join(&mut self, row: &Row<D>, s: f32) {
        self.value = horner_step(self.value, s, row.value);
        self.along[1] = horner_step(self.along[1], s, row.along);
        self.half_tt = horner_step(self.half_tt, s, row.half);
    }
}

/// A row's polynomial in `t` with its first derivative, and half its second.
struct Row<const D: usize> {
    value: [f32; D],
    along: [f32; D],
    half: [f32; D],
}

impl<const D: usize> Row<D> {
    #[inline(always)]
    fn new(coefficients: &[[f32; D]], t: f32) -> Self {
        let zero = [0.0; D];
        let mut row = Self { value: zero, along: zero, half: zero };
        let mut powers = coefficients.iter().rev();
        if let Some(power) = powers.next() {
            row.value = *power;
        }
        if let Some(power) = powers.next() {
            row.along = row.value;
            row.value = horner_step(row.value, t, *power);
        }
        if let Some(power) = powers.next() {
            row.half = row.along;
            row.along = horner_step(row.along, t, row.value);
            row.value = horner_step(row.value, t, *power);
        }
        for power in powers {
            row.half = horner_step(row.half, t, row.along);
            row.along = horner_step(row.along, t, row.value);
            row.value = horner_step(row.value, t, *power);
        }
        row
    }
}

/// Leibniz' rule on `w P = A`, solved for the highest derivative of `P`.
fn divide_by_weight(d: &Taylor<4>) -> CurvedPoint {
    let split = |[x, y, z, w]: [f32; 4]| (vec3(x, y, z), w);
    let ((a, w), (a_u, w_u), (a_v, w_v)) = (split(d.value), split(d.along[0]), split(d.along[1]));
    let ((a_uu, w_uu), (a_uv, w_uv), (a_vv, w_vv)) = (split(d.half_ss), split(d.mixed), split(d.half_tt));
    let inverse = 1.0 / w;
    let point = a * inverse;
    let tangent_u = (a_u - point * w_u) * inverse;
    let tangent_v = (a_v - point * w_v) * inverse;
    CurvedPoint {
        surface: SurfacePoint { point, tangent_u, tangent_v },
        second_uu: (a_uu - tangent_u * w_u - point * w_uu) * (2.0 * inverse),
        second_uv: (a_uv - tangent_u * w_v - tangent_v * w_u - point * w_uv) * inverse,
        second_vv: (a_vv - tangent_v * w_v - point * w_vv) * (2.0 * inverse),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::{Orientation, Patch as _, SecondDerivativeBounds, ShapeBounds};

    const BOUNDS: ShapeBounds = ShapeBounds::unknown(SecondDerivativeBounds { uu: 1.0, uv: 1.0, vv: 1.0 });
    /// As wide as makes the error of the difference, a sixth of the step squared times the third derivative, and its rounding alike.
    const STEP: f32 = 1.0 / 64.0;

    /// Numbers without a pattern, the weights near 1.
    const fn entries<const D: usize, const N: usize>() -> [[f32; D]; N] {
        let mut entries = [[1.0; D]; N];
        let mut index = 0;
        while index < N {
            let mut component = 0;
            while component < D {
                let number = ((index * D + component) * 7 % 11) as f32 / 11.0 - 0.5;
                entries[index][component] =
                    if component == 3 { if index == 0 { 1.0 } else { 0.05 * number } } else { number };
                component += 1;
            }
            index += 1;
        }
        entries
    }

    fn check(degree: [u8; 2], coefficients: Coefficients) {
        let breaks: &[f32] = &[0.0, 1.0];
        let patch = SplinePatch::from_table(degree, breaks, breaks, coefficients, BOUNDS, Orientation::Outward, 1.0);
        for (u, v) in [(0.1, 0.2), (0.5, 0.5), (0.9, 0.3)] {
            let curved = patch.evaluate_curved(u, v);
            let at = patch.evaluate(u, v);
            for (found, known) in [
                (curved.surface.point, at.point),
                (curved.surface.tangent_u, at.tangent_u),
                (curved.surface.tangent_v, at.tangent_v),
            ] {
                // Ten roundings of numbers of the size of 1.
                assert!((found - known).length() < 2e-6, "{degree:?}: {found} {known}");
            }
            let [right, left] = [STEP, -STEP].map(|step| patch.evaluate(u + step, v));
            let [above, below] = [STEP, -STEP].map(|step| patch.evaluate(u, v + step));
            let differences = [
                (curved.second_uu, right.tangent_u - left.tangent_u),
                (curved.second_uv, right.tangent_v - left.tangent_v),
                (curved.second_uv, above.tangent_u - below.tangent_u),
                (curved.second_vv, above.tangent_v - below.tangent_v),
            ];
            for (found, change) in differences {
                let known = change / (2.0 * STEP);
                // Third derivatives are a few dozen at degree 5.
                assert!((found - known).length() < 0.01, "{degree:?} at {u}, {v}: {found}, by differences {known}");
            }
        }
    }

    #[test]
    fn second_derivatives_are_those_of_the_differences() {
        check([1, 1], Coefficients::Polynomial(&const { entries::<3, 4>() }));
        check([1, 2], Coefficients::Polynomial(&const { entries::<3, 6>() }));
        check([2, 2], Coefficients::Polynomial(&const { entries::<3, 9>() }));
        check([3, 2], Coefficients::Polynomial(&const { entries::<3, 12>() }));
        check([3, 3], Coefficients::Polynomial(&const { entries::<3, 16>() }));
        check([5, 4], Coefficients::Polynomial(&const { entries::<3, 30>() }));
        check([2, 2], Coefficients::Rational(&const { entries::<4, 9>() }));
        check([3, 5], Coefficients::Rational(&const { entries::<4, 24>() }));
    }
}
