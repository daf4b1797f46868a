//! A border of a patch as polynomial spans, in double precision: the curve and the derivative across it.

use super::polynomial::Piecewise;
use crate::spline::Spans;
use crate::topology::{Border, Sense};
use glam::{DVec3, DVec4, Vec4Swizzles as _};
use palpate::patch::span_centre;

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
