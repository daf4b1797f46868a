//! Border curves as the target has them, in `f32`.

use super::border::{BorderSpans, Piecewise};
use crate::topology::Border;
use crate::{BakedCoefficients, NurbsPatch, PatchFault, bounds};
use glam::{DVec3, Vec4Swizzles as _};
use palpate::body::{Separator, SplineCurve};
use palpate::math::Vec3;
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

// Where a face's Voronoi region ends along one of its sides.

/// [`palpate::body::Separator`] with the numbers owned.
#[derive(Clone, Debug, PartialEq)]
pub enum BakedSeparator {
    /// Left iff `across · Q > offset`.
    Plane {
        /// Out of the face, per metre.
        across: [f32; 3],
        /// Offset of the plane.
        offset: f32,
    },
    /// The derivative across the border.
    Ruled(BakedCurve),
}

/// A border that strays less from its chord, in units of its largest coordinate, is straight: half a unit in the last
/// place of `f32`.
const STRAIGHT: f64 = 6e-8;
/// Normals that turn less are one: the rounding of a unit vector to `f32`.
const CONSTANT: f64 = 1e-7;
/// Points at which both are looked at: more than a rational border of degree 5 with a normal of degree 20 has freedoms.
const SAMPLES: usize = 32;

/// Lengths that differ by less are one: the rounding of `f64` in the change of basis.
const SAME_LENGTH: f64 = 1e-9;

impl BakedSeparator {
    /// The separator of a face at a border, in the edge's parameter. `spans` are the border's, in that parameter;
    /// `poles` says whether the sides at the edge's ends 0 and 1 are points.
    ///
    /// # Errors
    /// [`PatchFault::NoBounds`] where a number does not fit `f32`.
    pub fn new(patch: &NurbsPatch, border: Border, spans: &BorderSpans, poles: [bool; 2]) -> Result<Self, PatchFault> {
        if let Some(plane) = plane(patch, border) {
            return Ok(plane);
        }
        let mut outward = spans.outward();
        for (end, pole) in poles.into_iter().enumerate() {
            // Towards a pole the derivative across vanishes; its direction has a limit.
            if pole {
                outward = outward.without_root(end == 1);
            }
        }
        let (length, known) = (border.at(patch, 0.5).across.length(), outward.at(0.5).length());
        if known > 0.0 && (length - known).abs() > SAME_LENGTH * length {
            outward = outward.map(|power| power * (length / known));
        }
        Ok(Self::Ruled(BakedCurve::polynomial(&outward.trimmed(0))?))
    }

    /// The separator as the firmware has it; its numbers stay allocated for good.
    pub fn to_separator(&self) -> Separator<'static> {
        match self {
            Self::Plane { across, offset } => Separator::Plane { across: Vec3::from_array(*across), offset: *offset },
            Self::Ruled(curve) => Separator::Ruled(curve.to_curve()),
        }
    }
}

/// The plane, if the border is straight and the normal constant along it, both within what `f32` can tell.
fn plane(patch: &NurbsPatch, border: Border) -> Option<BakedSeparator> {
    let intervals =
        SAMPLES * (patch.borders(if border.axis() == 0 { crate::Axis::U } else { crate::Axis::V }).len() - 1);
    let points: Vec<_> = (0..=intervals).map(|k| border.at(patch, k as f64 / intervals as f64)).collect();
    let extent = points.iter().map(|at| at.point.abs().max_element()).fold(0.0, f64::max);
    let (first, last) = (points[0].point, points[intervals].point);
    let along = (last - first).normalize_or_zero();
    let strays = |point: DVec3| (point - first - along * (point - first).dot(along)).length() > STRAIGHT * extent;
    if along == DVec3::ZERO || points.iter().any(|at| strays(at.point)) {
        return None;
    }
    let middle = points[intervals / 2];
    // At a pole there is no normal to compare.
    let turns = |normal: DVec3| normal != DVec3::ZERO && normal.cross(middle.normal).length() > CONSTANT;
    if middle.normal == DVec3::ZERO || points.iter().any(|at| turns(at.normal) || at.normal.dot(middle.normal) < 0.0) {
        return None;
    }
    let conormal = middle.conormal();
    let rounded = (conormal / middle.across.dot(conormal)).as_vec3();
    // Of the stored vector, so that the plane holds the middle of the border; it is that of the whole within the
    // tolerances.
    let offset = rounded.as_dvec3().dot(middle.point);
    Some(BakedSeparator::Plane { across: rounded.to_array(), offset: offset as f32 })
}
