//! Border curves as the target has them, in `f32`.

use super::border::BorderSpans;
use super::polynomial::Piecewise;
use crate::bounds;
use crate::{BakedCoefficients, PatchFault};
use glam::{DVec3, Vec4Swizzles as _};
use palpate::body::SplineCurve;
use palpate::patch::Coefficients;

/// [`palpate::body::SplineCurve`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedCurve {
    /// Degree.
    pub degree: u8,
    /// Span borders.
    pub breaks: Vec<f32>,
    /// Coefficients of all spans.
    pub coefficients: BakedCoefficients,
    /// `sup ‖c''‖`, proved of the stored numbers (see [`bounds`]).
    pub second_derivative: f32,
}

impl BakedCurve {
    /// The curve of an edge.
    ///
    /// # Errors
    /// [`PatchFault::NoBounds`] where a number or a bound does not fit `f32`.
    pub fn of_edge(border: &BorderSpans) -> Result<Self, PatchFault> {
        if border.has_constant_weight() {
            let weight = border.curve.spans[0][0].w;
            return Self::polynomial(&border.curve.map(|power| power.xyz() * (1.0 / weight)).trimmed(1));
        }
        let curve = border.curve.clone().trimmed(1);
        let entries = curve.spans.iter().flatten().map(|power| power.as_vec4().to_array()).collect();
        Self::new(curve.degree(), curve.breaks, BakedCoefficients::Rational(entries))
    }

    /// A polynomial curve.
    ///
    /// # Errors
    /// [`PatchFault::NoBounds`] where a number or a bound does not fit `f32`.
    pub fn polynomial(curve: &Piecewise<DVec3>) -> Result<Self, PatchFault> {
        let entries = curve.spans.iter().flatten().map(|power| power.as_vec3().to_array()).collect();
        Self::new(curve.degree(), curve.breaks.clone(), BakedCoefficients::Polynomial(entries))
    }

    fn new(degree: usize, breaks: Vec<f32>, coefficients: BakedCoefficients) -> Result<Self, PatchFault> {
        let second_derivative = bounds::prove_curve(degree, &breaks, &coefficients).ok_or(PatchFault::NoBounds)?;
        Ok(Self { degree: degree as u8, breaks, coefficients, second_derivative })
    }

    /// `sup ‖c'''‖` and the largest jump of `c''`: what a step of second order needs of the curve of an edge.
    ///
    /// # Errors
    /// [`PatchFault::NoBounds`] where a bound does not fit `f32`.
    pub fn third_derivative(&self) -> Result<[f32; 2], PatchFault> {
        bounds::prove_third_of_curve(usize::from(self.degree), &self.breaks, &self.coefficients)
            .ok_or(PatchFault::NoBounds)
    }

    /// The curve as the firmware has it; its numbers stay allocated for good.
    pub fn to_curve(&self) -> SplineCurve<'static> {
        let coefficients = match &self.coefficients {
            BakedCoefficients::Polynomial(entries) => Coefficients::Polynomial(entries.clone().leak()),
            BakedCoefficients::Rational(entries) => Coefficients::Rational(entries.clone().leak()),
        };
        SplineCurve {
            degree: self.degree,
            breaks: self.breaks.clone().leak(),
            coefficients,
            second_derivative: self.second_derivative,
        }
    }
}
