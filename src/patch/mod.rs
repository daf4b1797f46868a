//! What a parametric surface gives: a point and both tangents in one evaluation.
//!
//! A *patch* maps `(u, v) ∈ [0, 1]²` to a point of the body, in metres. [`SplinePatch`] is any NURBS patch of degree
//! 1 to 5, kept as polynomial spans so that the target evaluates by Horner's rule and never by de Boor's recursion.
//! A new kind of surface (a cylinder, a torus) is a new file here that implements [`Patch`].

mod coefficients;
mod crc;
mod curved;
mod curved_point;
mod horner;
mod shape;
mod span_grid;
mod spans;
mod spline;
mod table;
mod taylor;

pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficient_word;
pub use crc::crc32;
pub use curved_point::{CurvedPoint, SecondDerivatives};
pub(crate) use horner::horner_step;
pub use shape::{Curvature, SecondDerivativeBounds, ShapeBounds, ThirdDerivativeBounds};
use span_grid::SpanGrid;
pub use span_grid::{MAX_SPANS, span_centre};
pub(crate) use span_grid::{beyond, bisect, breaks_are_valid};
pub use spline::SplinePatch;
pub use table::{MAX_DEGREE, Orientation, SplineTable, TableError};

use crate::math::Vec3;

/// A point of a patch with its two tangents: one evaluation.
///
/// # Units
/// Metres; the tangents are metres per unit of parameter and are *not* normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// `f(u, v)`.
    pub point: Vec3,
    /// `f_u = ∂f/∂u`.
    pub tangent_u: Vec3,
    /// `f_v = ∂f/∂v`.
    pub tangent_v: Vec3,
}

impl SurfacePoint {
    /// Zero throughout: what a table without coefficients would give, if there were one.
    const NOWHERE: Self = Self { point: Vec3::ZERO, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };

    /// `Df w`.
    #[inline]
    pub(crate) fn along(&self, [w_u, w_v]: [f32; 2]) -> Vec3 {
        self.tangent_u * w_u + self.tangent_v * w_v
    }
}

/// A parametric surface patch over `[0, 1]²`.
pub trait Patch {
    /// The point and both tangents at `(u, v)`. Parameters outside `[0, 1]` extrapolate the nearest span; the
    /// controller never asks for them.
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint;

    /// The same with all second derivatives. A patch that does not give them is stepped on to first order: nothing is
    /// certified with those of a plane as long as [`ShapeBounds::third_derivatives`] does not say that it is one.
    #[inline]
    fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        CurvedPoint { surface: self.evaluate(u, v), second: SecondDerivatives::NONE }
    }

    /// How far a step from one pair of parameters to another goes beyond the knots that it crosses, along `u` and along
    /// `v`: the sum of the squares. The knot that it starts on counts where the evaluation took the span that the step
    /// leaves. 0 within a span.
    #[inline]
    fn beyond_knots(&self, _from: [f32; 2], _to: [f32; 2]) -> [f32; 2] {
        [0.0; 2]
    }

    /// Bounds on the second derivatives over the whole patch.
    fn bounds(&self) -> SecondDerivativeBounds;

    /// What else is proved of the shape; nothing, if the patch does not say.
    fn shape(&self) -> ShapeBounds {
        ShapeBounds::unknown(self.bounds())
    }

    /// `+1` if `f_u × f_v` points out of the body, `-1` if into it.
    fn orientation(&self) -> f32;

    /// The largest side of the patch's bounding box, in metres: what relative tolerances are measured against.
    fn size(&self) -> f32;

    /// The `index`-th word of the patch's table, for the check that flash still holds what was baked; `None` past the
    /// end, and always for a patch without a table.
    fn table_word(&self, _index: usize) -> Option<u32> {
        None
    }

    /// CRC-32 of the words as they were baked; `None` for a patch that carries none: there is nothing to compare with.
    fn baked_crc(&self) -> Option<u32> {
        None
    }
}
