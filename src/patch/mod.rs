//! Parametric surfaces: a point and both tangents in one evaluation.
//!
//! A *patch* maps `(u, v) ∈ [0, 1]²` to a point of the body, in metres. [`SplinePatch`] is any NURBS patch of degree 1
//! to 5, kept as polynomial spans so that the target evaluates by Horner's rule and never by de Boor's recursion.
//! Another kind of surface (a cylinder, a torus) implements [`Patch`].

mod coefficients;
mod crc;
mod curved;
mod curved_point;
mod horner;
mod kinds;
mod shape;
mod span_grid;
mod spans;
mod spline;
mod table;
mod taylor;

pub use coefficients::Coefficients;
pub(crate) use coefficients::coefficient_word;
pub use crc::crc32;
pub(crate) use crc::{crc32_of, crc32_with};
pub use curved_point::{CurvedPoint, SecondDerivatives};
pub(crate) use horner::horner_step;
pub use kinds::{ALL_KINDS, KindSet, Kinds};
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
    /// Result of a table without coefficients, which no check lets pass.
    const NOWHERE: Self = Self { point: Vec3::ZERO, tangent_u: Vec3::ZERO, tangent_v: Vec3::ZERO };

    /// `Df w`.
    #[inline]
    pub(crate) fn along(&self, [w_u, w_v]: [f32; 2]) -> Vec3 {
        self.tangent_u * w_u + self.tangent_v * w_v
    }
}

/// A parametric surface patch over `[0, 1]²`.
///
/// A surface of your own, here a cylinder of 30 mm radius and 0.1 m length:
///
/// ```
/// use palpate::math::{sin_cos, vec3};
/// use palpate::patch::{Patch, SecondDerivativeBounds, SurfacePoint};
/// use palpate::track::{Controller, Probe, Witness};
///
/// struct Cylinder;
/// const RADIUS: f32 = 0.03;
///
/// impl Patch for Cylinder {
///     fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
///         let (sine, cosine) = sin_cos(u); // one radian
///         SurfacePoint {
///             point: vec3(RADIUS * cosine, RADIUS * sine, 0.1 * v),
///             tangent_u: vec3(-RADIUS * sine, RADIUS * cosine, 0.0),
///             tangent_v: vec3(0.0, 0.0, 0.1),
///         }
///     }
///     fn bounds(&self) -> SecondDerivativeBounds {
///         SecondDerivativeBounds { uu: RADIUS, uv: 0.0, vv: 0.0 }
///     }
///     fn orientation(&self) -> f32 {
///         1.0
///     }
///     fn size(&self) -> f32 {
///         0.1
///     }
/// }
///
/// // Without second derivatives the default controller takes certified steps of first order.
/// let mut witness = Witness::at(&Cylinder, 0.5, 0.5);
/// for _ in 0..100 {
///     Controller::SecondOrder.step(&Cylinder, &mut witness, Probe::at(vec3(0.05, 0.02, 0.07)), 0.001);
/// }
/// assert!((witness.parameters[1] - 0.7).abs() < 1e-3);
/// ```
pub trait Patch {
    /// The point and both tangents at `(u, v)`. Parameters outside `[0, 1]` extrapolate the nearest span; the
    /// controller never uses them.
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint;

    /// The same with all second derivatives. The default returns those of a plane, and the controller takes
    /// first-order steps: [`ShapeBounds::third_derivatives`] does not certify a plane's.
    #[inline]
    fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        CurvedPoint { surface: self.evaluate(u, v), second: SecondDerivatives::NONE }
    }

    /// For a step from one pair of parameters to another: how far it ends beyond the knots that it crosses, along `u`
    /// and along `v`, as the sum of the squares. The knot at its start counts if the evaluation took the span that the
    /// step leaves. 0 within a span.
    #[inline]
    fn beyond_knots(&self, _from: [f32; 2], _to: [f32; 2]) -> [f32; 2] {
        [0.0; 2]
    }

    /// Bounds on the second derivatives over the whole patch.
    fn bounds(&self) -> SecondDerivativeBounds;

    /// All proved bounds of the shape; by default only [`Self::bounds`].
    fn shape(&self) -> ShapeBounds {
        ShapeBounds::unknown(self.bounds())
    }

    /// `+1` if `f_u × f_v` points out of the body, `-1` if into it.
    fn orientation(&self) -> f32;

    /// Largest side of the bounding box, metres: relative tolerances refer to it.
    fn size(&self) -> f32;

    /// The `index`-th word of the patch's table, for the check that flash still holds the baked table; `None` past the
    /// end, and always for a patch without a table.
    fn table_word(&self, _index: usize) -> Option<u32> {
        None
    }

    /// CRC-32 of the words as they were baked; `None` for a patch that carries none: there is nothing to compare with.
    fn baked_crc(&self) -> Option<u32> {
        None
    }
}
