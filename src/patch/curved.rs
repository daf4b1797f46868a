//! A point with both tangents and all second derivatives: what a cold start needs, and the tick does not.

use super::SurfacePoint;
use super::spline::{Coefficients, SplinePatch};
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
        let (span, [s, t]) = self.locate(u, v);
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
        let [rows, columns] = self.degree.map(|degree| usize::from(degree) + 1);
        let first = span * rows * columns;
        // The constructor counted the entries: the empty slice is never taken, it only keeps a panic out of the search.
        let powers = entries.get(first..first + rows * columns).unwrap_or(&[]);
        let zero = [0.0; D];
        let mut d = Taylor { value: zero, along: [zero; 2], half_ss: zero, mixed: zero, half_tt: zero };
        for row in powers.chunks_exact(columns).rev() {
            let (mut value, mut along, mut half) = (zero, zero, zero);
            for coefficient in row.iter().rev() {
                half = horner_step(half, t, along);
                along = horner_step(along, t, value);
                value = horner_step(value, t, *coefficient);
            }
            d.half_ss = horner_step(d.half_ss, s, d.along[0]);
            d.along[0] = horner_step(d.along[0], s, d.value);
            d.value = horner_step(d.value, s, value);
            d.mixed = horner_step(d.mixed, s, d.along[1]);
            d.along[1] = horner_step(d.along[1], s, along);
            d.half_tt = horner_step(d.half_tt, s, half);
        }
        d
    }
}

/// `accumulated · x + next`, component by component.
#[inline(always)]
fn horner_step<const D: usize>(accumulated: [f32; D], x: f32, next: [f32; D]) -> [f32; D] {
    core::array::from_fn(|component| accumulated[component] * x + next[component])
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
