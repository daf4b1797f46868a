//! A border of a patch as polynomial spans, in double precision: the curve and the derivative across it.

use crate::bernstein::{binomial, power_of};
use crate::spline::{BELOW_SINGLE, Spans};
use crate::topology::{Border, Sense};
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::patch::span_centre;
use std::ops::{Add, Mul, Sub};

/// Both as `(w x, w y, w z, w)`, in the border's parameter or, after [`Self::in_sense`], in its edge's.
#[derive(Clone, Debug)]
pub struct BorderSpans {
    /// The homogeneous curve `A`.
    pub curve: Piecewise<DVec4>,
    /// Its derivative across the border, out of the patch.
    pub across: Piecewise<DVec4>,
}

impl BorderSpans {
    /// The border of a patch with these spans and degrees.
    pub fn new(spans: &Spans, degree: [usize; 2], border: Border) -> Self {
        let (axis, fixed) = (border.axis(), 1 - border.axis());
        let breaks = &spans.breaks[fixed];
        let counts = spans.breaks.each_ref().map(|breaks| breaks.len() - 1);
        let line = if border.is_upper() { counts[fixed] - 1 } else { 0 };
        let at = if border.is_upper() { 1.0 } else { 0.0 } - f64::from(span_centre(breaks[line], breaks[line + 1]));
        let sign = if border.is_upper() { 1.0 } else { -1.0 };
        let mut curve = Vec::with_capacity(counts[axis]);
        let mut across = Vec::with_capacity(counts[axis]);
        for span in 0..counts[axis] {
            let index = if axis == 1 { line * counts[1] + span } else { span * counts[1] + line };
            let power = |along: usize, off: usize| {
                let [k, l] = if axis == 1 { [off, along] } else { [along, off] };
                spans.powers[index][k * (degree[1] + 1) + l]
            };
            // Horner's rule for the value and the derivative at the fixed parameter.
            let at_border = |along: usize| {
                (0..=degree[fixed]).rev().fold((DVec4::ZERO, DVec4::ZERO), |(value, slope), off| {
                    (value * at + power(along, off), slope * at + value)
                })
            };
            let values: Vec<_> = (0..=degree[axis]).map(at_border).collect();
            curve.push(values.iter().map(|(value, _)| *value).collect());
            across.push(values.iter().map(|(_, slope)| *slope * sign).collect());
        }
        let breaks = spans.breaks[axis].clone();
        Self { curve: Piecewise { breaks: breaks.clone(), spans: curve }, across: Piecewise { breaks, spans: across } }
    }

    /// In the parameter of the edge.
    pub fn in_sense(self, sense: Sense) -> Self {
        match sense {
            Sense::Same => self,
            Sense::Reversed => Self { curve: self.curve.reversed(), across: self.across.reversed() },
        }
    }

    /// Whether the weight is the same all along.
    pub fn has_constant_weight(&self) -> bool {
        let first = self.curve.spans[0][0].w;
        let is_constant = |span: &Vec<DVec4>| {
            (span[0].w - first).abs() <= CONSTANT * first
                && span[1..].iter().all(|power| power.w.abs() <= CONSTANT * first)
        };
        self.curve.spans.iter().all(is_constant)
    }

    /// A positive multiple of the derivative across: that of a polynomial patch itself, of a rational one `w²` times
    /// it, `A_u w − A w_u`, a polynomial of twice the degree.
    pub fn outward(&self) -> Piecewise<DVec3> {
        if self.has_constant_weight() && self.across.spans.iter().flatten().all(|power| power.w == 0.0) {
            return self.across.map(|power| power.xyz());
        }
        let spans = self.curve.spans.iter().zip(&self.across.spans).map(|(curve, across)| {
            let mut product = vec![DVec3::ZERO; 2 * curve.len() - 1];
            for (k, a) in curve.iter().enumerate() {
                for (l, a_u) in across.iter().enumerate() {
                    product[k + l] += a_u.xyz() * a.w - a.xyz() * a_u.w;
                }
            }
            product
        });
        Piecewise { breaks: self.curve.breaks.clone(), spans: spans.collect() }
    }
}

/// Weights that differ by less are one: the rounding of `f64` in the change of basis.
const CONSTANT: f64 = 1e-13;

// Piecewise polynomials of one parameter: each span in powers of the distance from its `f32` centre, as the target has
// it.

/// Polynomials of one degree over the spans between `breaks`, which rise from 0 to 1.
#[derive(Clone, Debug)]
pub struct Piecewise<V> {
    /// Span borders.
    pub breaks: Vec<f32>,
    /// Coefficients of each span, entry `k` the power `k`.
    pub spans: Vec<Vec<V>>,
}

/// Operations that a coefficient needs.
pub trait Coefficient: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> {
    /// Zero.
    const NONE: Self;
    /// The largest component's absolute value.
    fn largest(self) -> f64;
}

impl Coefficient for glam::DVec3 {
    const NONE: Self = Self::ZERO;
    fn largest(self) -> f64 {
        self.abs().max_element()
    }
}

impl Coefficient for glam::DVec4 {
    const NONE: Self = Self::ZERO;
    fn largest(self) -> f64 {
        self.abs().max_element()
    }
}

impl<V: Coefficient> Piecewise<V> {
    /// The degree of the spans.
    pub fn degree(&self) -> usize {
        self.spans[0].len() - 1
    }

    /// The centre of a span.
    pub fn centre(&self, span: usize) -> f64 {
        f64::from(span_centre(self.breaks[span], self.breaks[span + 1]))
    }

    /// Half its width.
    fn reach(&self, span: usize) -> f64 {
        0.5 * (f64::from(self.breaks[span + 1]) - f64::from(self.breaks[span]))
    }

    /// The same with other coefficients.
    pub fn map<W>(&self, of: impl Fn(V) -> W) -> Piecewise<W> {
        let spans = self.spans.iter().map(|span| span.iter().map(|power| of(*power)).collect()).collect();
        Piecewise { breaks: self.breaks.clone(), spans }
    }

    /// The value at `t`, of the span below a border.
    pub fn at(&self, t: f64) -> V {
        let last = self.spans.len() - 1;
        let span = (0..last).find(|span| t <= f64::from(self.breaks[span + 1])).unwrap_or(last);
        let s = t - self.centre(span);
        self.spans[span].iter().rev().fold(V::NONE, |value, power| value * s + *power)
    }

    /// In the parameter `1 − t`.
    pub fn reversed(&self) -> Self {
        let breaks: Vec<f32> = self.breaks.iter().rev().map(|t| 1.0 - t).collect();
        let count = self.spans.len();
        let mirrored = |span: usize| {
            let own = count - 1 - span;
            // t = 1 − t', each from its span's centre: s = shift − s'. The shift is the rounding of the borders.
            let shift = 1.0 - self.centre(own) - f64::from(span_centre(breaks[span], breaks[span + 1]));
            let powers = &self.spans[own];
            let power = |k: usize| {
                let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
                let terms = (k..powers.len()).map(|n| powers[n] * (sign * binomial(n, k) * power_of(shift, n - k)));
                terms.fold(V::NONE, |sum, term| sum + term)
            };
            (0..powers.len()).map(power).collect()
        };
        Self { spans: (0..count).map(mirrored).collect(), breaks }
    }

    /// The largest value that a power takes on the spans.
    fn share(&self, power: usize) -> f64 {
        let of = |(span, powers): (usize, &Vec<V>)| powers[power].largest() * power_of(self.reach(span), power);
        self.spans.iter().enumerate().map(of).fold(0.0, f64::max)
    }

    /// Without the highest powers, down to `least`, as long as they add less than `f32` can tell.
    pub fn trimmed(mut self, least: usize) -> Self {
        let largest = (0..=self.degree()).map(|power| self.share(power)).fold(0.0, f64::max);
        while self.degree() > least && self.share(self.degree()) <= BELOW_SINGLE * largest {
            self.spans.iter_mut().for_each(|span| span.truncate(span.len() - 1));
        }
        self
    }

    /// Divides by the factor `t` or `1 − t` that makes it vanish at 0 or at 1, up to twice: the quotient has the same
    /// direction everywhere, and a direction at that end too. Other spans stay unchanged, because their own positive
    /// factors do not matter.
    pub fn without_root(mut self, at_upper_end: bool) -> Self {
        let span = if at_upper_end { self.spans.len() - 1 } else { 0 };
        let (end, inward) = if at_upper_end { (1.0, -1.0) } else { (0.0, 1.0) };
        let root = end - self.centre(span);
        for _ in 0..2 {
            let powers = &self.spans[span];
            let value = powers.iter().rev().fold(V::NONE, |value, power| value * root + *power);
            let largest = self.share_of_span(span);
            if powers.len() < 2 || value.largest() > ROOT * largest {
                break;
            }
            // Horner's rule at the root leaves the quotient by (s − root); inward · (t − end) is positive inside.
            let mut quotient = vec![V::NONE; powers.len()];
            for k in (0..powers.len() - 1).rev() {
                quotient[k] = quotient[k + 1] * root + powers[k + 1];
            }
            let scale = inward * 2.0 * self.reach(span);
            self.spans[span] = quotient.into_iter().map(|power| power * scale).collect();
        }
        self
    }

    fn share_of_span(&self, span: usize) -> f64 {
        let reach = self.reach(span);
        let of = |(k, power): (usize, &V)| power.largest() * power_of(reach, k);
        self.spans[span].iter().enumerate().map(of).fold(0.0, f64::max)
    }
}

/// A value at an end below this, beside the largest on the span, is the rounding of a zero.
const ROOT: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn example() -> Piecewise<DVec3> {
        let power = |k: f64| DVec3::new(1.0 + k, 0.3 * k * k, -2.0);
        Piecewise { breaks: vec![0.0, 0.3, 1.0], spans: vec![(0..4).map(|k| power(f64::from(k))).collect(); 2] }
    }

    #[test]
    fn reversing_runs_the_other_way() {
        let (there, back) = (example(), example().reversed());
        for t in [0.0, 0.1, 0.299, 0.31, 0.77, 1.0] {
            assert!(there.at(t).distance(back.at(1.0 - t)) < 1e-14, "{t}");
        }
    }

    #[test]
    fn a_root_at_an_end_is_divided_out_and_the_direction_kept() {
        // (1 − t) (1, 2 t, 3), about the centre 1/2: 1 − t = 1/2 − s.
        let spans = vec![vec![DVec3::new(0.5, 0.5, 1.5), DVec3::new(-1.0, 0.0, -3.0), DVec3::new(0.0, -2.0, 0.0)]];
        let field = Piecewise { breaks: vec![0.0, 1.0], spans };
        let left = field.clone().without_root(true);
        assert!(left.at(1.0).distance(DVec3::new(1.0, 2.0, 3.0)) < 1e-12);
        assert!(left.at(0.4).cross(field.at(0.4)).length() < 1e-12 && left.at(0.4).dot(field.at(0.4)) > 0.0);
        assert_eq!(left.trimmed(0).degree(), 1);
    }
}
