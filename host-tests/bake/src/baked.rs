//! A patch as the target has it: the table, in `f32`.

use super::error::{ModelError, PatchFault};
use super::model::Model;
use super::patch::NurbsPatch;
use super::{bounds, shape, spline};
use crate::patch::Axis;
use crate::spline::BakedCoefficients;
use palpate::patch::{Coefficients, Orientation, ShapeBounds, SplinePatch, SplineTable, TableError};

/// The table of one patch.
#[derive(Clone, Debug, PartialEq)]
pub struct BakedPatch {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Degrees along `u` and `v`.
    pub degree: [u8; 2],
    /// Span borders along `u` and `v`.
    pub breaks: [Vec<f32>; 2],
    /// Coefficients of all spans, in the order of the table.
    pub coefficients: BakedCoefficients,
    /// Proved bounds of its shape.
    pub shape: ShapeBounds,
    /// Direction of the outward normal.
    pub orientation: Orientation,
    /// The largest side of the bounding box, metres.
    pub size: f32,
}

impl BakedPatch {
    /// Bakes one patch.
    ///
    /// # Errors
    /// [`PatchFault::Uneven`] where the weights or knots do not fit `f32`.
    pub fn new(patch: &NurbsPatch) -> Result<Self, PatchFault> {
        let baked = Self::without_shape(patch)?;
        let ShapeBounds { second_derivatives, third_derivatives, .. } = baked.shape;
        let shape = shape::prove(
            baked.degree.map(usize::from),
            &baked.breaks,
            &baked.coefficients,
            baked.orientation,
            second_derivatives,
        )
        .ok_or(PatchFault::NoBounds)?;
        Ok(Self { shape: ShapeBounds { third_derivatives, ..shape }, ..baked })
    }

    /// Bakes one patch with the bounds that the controller's gain needs and no others: curvature and stretch are proved
    /// by a search that takes seconds on some patches, and a sweep over thousands does without.
    ///
    /// # Errors
    /// [`PatchFault::Uneven`] where the weights or knots do not fit `f32`.
    pub fn without_shape(patch: &NurbsPatch) -> Result<Self, PatchFault> {
        let mut spans = spline::extract(patch).map_err(|spline::UnevenSpan([u, v])| PatchFault::Uneven { u, v })?;
        let degree = spans.lower(patch.degree);
        let spans_v = spans.breaks[1].len() - 1;
        for (span, powers) in spans.powers.iter().enumerate() {
            // Rounded here, once; a number beyond f32 becomes infinite.
            if powers.iter().any(|entry| !entry.as_vec4().is_finite()) {
                return Err(PatchFault::Uneven { u: span / spans_v, v: span % spans_v });
            }
        }
        let entries = spans.powers.iter().flatten();
        let coefficients = if patch.is_rational() {
            BakedCoefficients::Rational(entries.map(|entry| entry.as_vec4().to_array()).collect())
        } else {
            BakedCoefficients::Polynomial(entries.map(|entry| entry.truncate().as_vec3().to_array()).collect())
        };
        let orientation = if patch.flip { Orientation::Inward } else { Orientation::Outward };
        let bounds = bounds::prove(degree, &spans.breaks, &coefficients).ok_or(PatchFault::NoBounds)?;
        let has_crease = [Axis::U, Axis::V].map(|axis| !patch.creases(axis).is_empty());
        let third_derivatives =
            bounds::prove_third(degree, &spans.breaks, &coefficients, has_crease).ok_or(PatchFault::NoBounds)?;
        Ok(Self {
            name: patch.name.clone(),
            degree: degree.map(|degree| degree as u8),
            breaks: spans.breaks,
            coefficients,
            shape: ShapeBounds { third_derivatives, ..ShapeBounds::unknown(bounds) },
            orientation,
            size: patch.size() as f32,
        })
    }

    /// Bakes all patches of a model; `file` is what messages call it.
    ///
    /// # Errors
    /// The first patch that cannot be baked.
    pub fn all(model: &Model, file: &str) -> Result<Vec<Self>, ModelError> {
        let bake = |(index, patch): (usize, &NurbsPatch)| {
            let label = patch.name.as_ref().map_or_else(|| index.to_string(), |name| format!("\"{name}\""));
            Self::new(patch).map_err(|fault| ModelError::Patch { file: file.to_owned(), patch: label, fault })
        };
        model.patches.iter().enumerate().map(bake).collect()
    }

    /// The patch as the firmware has it, with the same bits. Its numbers are leaked: meant for a host that bakes a few
    /// models in its life.
    ///
    /// # Errors
    /// A fault that the library finds in the table; a baked table has none.
    pub fn to_patch(&self) -> Result<SplinePatch<'static>, TableError> {
        let coefficients = match &self.coefficients {
            BakedCoefficients::Polynomial(entries) => Coefficients::Polynomial(entries.clone().leak()),
            BakedCoefficients::Rational(entries) => Coefficients::Rational(entries.clone().leak()),
        };
        let [breaks_u, breaks_v] = self.breaks.clone().map(|breaks| -> &'static [f32] { breaks.leak() });
        SplineTable {
            degree: self.degree,
            breaks_u,
            breaks_v,
            coefficients,
            shape: self.shape,
            orientation: self.orientation,
            size_m: self.size,
            crc: None,
        }
        .try_checked()
    }
}
