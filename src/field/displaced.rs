//! A displaced patch.

use super::Displacement;
use crate::patch::{CurvedPoint, Kinds as _, Patch, SecondDerivativeBounds, ShapeBounds, SplinePatch, SurfacePoint};

/// A patch of a body at rest, displaced: a pointer and the displacement.
#[derive(Clone, Copy, Debug)]
pub struct Displaced<'p, D> {
    pub(crate) rest: &'p SplinePatch<'p>,
    pub(crate) by: D,
}

impl<'p, D: Displacement> Displaced<'p, D> {
    /// A patch at rest and its displacement.
    pub const fn new(rest: &'p SplinePatch<'p>, by: D) -> Self {
        Self { rest, by }
    }

    /// [`Patch::evaluate_curved`] in a copy of its own.
    #[inline(always)]
    pub(crate) fn evaluate_apart(&self, parameters: [f32; 2]) -> CurvedPoint {
        if self.by.is_rest() {
            return self.rest.evaluate_apart::<D::Kinds>(parameters);
        }
        let mut point = self.rest.evaluate_apart::<D::Kinds>(parameters);
        self.by.displace_curved(&mut point);
        point
    }

    /// Whether it has weights. An image without such patches has no code for them.
    #[inline(always)]
    pub(crate) fn is_rational(&self) -> bool {
        self.rest.is_rational() && const { D::Kinds::MASK >> 16 != 0 }
    }
}

impl<D: Displacement> Patch for Displaced<'_, D> {
    #[inline(always)]
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
        let mut point = self.rest.evaluate(u, v);
        self.by.displace(&mut point);
        point
    }

    #[inline(always)]
    fn evaluate_curved(&self, u: f32, v: f32) -> CurvedPoint {
        // A rigid body's point is not copied.
        if self.by.is_rest() {
            return self.rest.evaluate_kinds::<D::Kinds>(u, v);
        }
        let mut point = self.rest.evaluate_kinds::<D::Kinds>(u, v);
        self.by.displace_curved(&mut point);
        point
    }

    #[inline(always)]
    fn beyond_knots(&self, from: [f32; 2], to: [f32; 2]) -> [f32; 2] {
        self.rest.beyond_knots(from, to)
    }

    #[inline(always)]
    fn bounds(&self) -> SecondDerivativeBounds {
        self.shape().second_derivatives
    }

    #[inline(always)]
    fn shape(&self) -> ShapeBounds {
        self.by.shape(self.rest.bounds_of_shape())
    }

    #[inline(always)]
    fn orientation(&self) -> f32 {
        self.rest.orientation()
    }

    #[inline(always)]
    fn size(&self) -> f32 {
        self.rest.size()
    }
}
