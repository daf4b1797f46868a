//! Bodies that deform: a displacement of space that carries a rigid body's tables along (theory §15).
//!
//! A body at rest `f₀` becomes `f_q = f₀ + Σ qᵢ ψᵢ(f₀)`: each [`Mode`] displaces *space*, so degrees, weights, knots,
//! poles, smooth seams and the kinds of edges stay what they are. The tracker of [`crate::body`] runs on the displaced
//! patch; with [`Rigid`], the default, a displacement is no data and no code.

mod displaced;
mod jet;
mod modal;
mod mode;

pub use displaced::Displaced;
pub(crate) use modal::within;
pub use modal::{Modal, ModalStep};
pub use mode::{Bump, Field, FieldBounds, MAX_MODES, Mode, Quadratic};

use crate::math::Vec3;
use crate::patch::{ALL_KINDS, CurvedPoint, KindSet, Kinds, ShapeBounds, SurfacePoint};

/// A displacement of space `Φ`, by which a body at rest is deformed.
pub trait Displacement: Copy {
    /// The kinds of patches of the body at rest.
    type Kinds: Kinds;

    /// Evaluations of curves that a plane and a curve take which separate two faces ([`crate::body::Separator`]).
    const SEPARATORS: [u32; 2];

    /// Whether it displaces nothing.
    fn is_rest(&self) -> bool;

    /// `Φ(X)`, metres.
    fn point(&self, rest: Vec3) -> Vec3;

    /// `DΦ(X) w` for a direction `w` at a point `X` of the body at rest.
    fn direction(&self, at: Vec3, direction: Vec3) -> Vec3;

    /// A vector along `DΦ(X)⁻ᵀ n`, the displaced normal, of any positive length, for a vector `n` along the normal at
    /// `X`.
    fn normal(&self, at: Vec3, normal: Vec3) -> Vec3;

    /// Displaces a point of a surface with its tangents. In place, as the next ones: a rigid body copies nothing.
    fn displace(&self, point: &mut SurfacePoint);

    /// Displaces a point of a surface with all derivatives up to the second.
    fn displace_curved(&self, point: &mut CurvedPoint);

    /// Displaces a point of a curve with its tangent and half its second derivative.
    fn displace_curve(&self, point: &mut Vec3, tangent: &mut Vec3, half_second: &mut Vec3);

    /// Bounds of a displaced patch.
    fn shape(&self, rest: &ShapeBounds) -> ShapeBounds;

    /// Bounds of a displaced curve: `‖c''‖`, `‖c'''‖` and the jump of `c''`. `stretch` gives a bound of `‖c'‖²`, m².
    fn curve_bounds(&self, rest: [f32; 3], stretch: impl FnOnce() -> f32) -> [f32; 3];

    /// The point of the space at rest that is displaced to `probe`, within some distance of it, metres: where the locator
    /// is asked.
    fn undo(&self, probe: Vec3, within: f32) -> Vec3;
}

/// No displacement: a rigid body, of these kinds of patches ([`Kinds::MASK`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rigid<const KINDS: u32 = ALL_KINDS>;

impl<const KINDS: u32> Displacement for Rigid<KINDS> {
    type Kinds = KindSet<KINDS>;
    const SEPARATORS: [u32; 2] = [0, 1];

    #[inline(always)]
    fn is_rest(&self) -> bool {
        true
    }

    #[inline(always)]
    fn point(&self, rest: Vec3) -> Vec3 {
        rest
    }

    #[inline(always)]
    fn direction(&self, _at: Vec3, direction: Vec3) -> Vec3 {
        direction
    }

    #[inline(always)]
    fn normal(&self, _at: Vec3, normal: Vec3) -> Vec3 {
        normal
    }

    #[inline(always)]
    fn displace(&self, _point: &mut SurfacePoint) {}

    #[inline(always)]
    fn displace_curved(&self, _point: &mut CurvedPoint) {}

    #[inline(always)]
    fn displace_curve(&self, _point: &mut Vec3, _tangent: &mut Vec3, _half_second: &mut Vec3) {}

    #[inline(always)]
    fn shape(&self, rest: &ShapeBounds) -> ShapeBounds {
        *rest
    }

    #[inline(always)]
    fn curve_bounds(&self, rest: [f32; 3], _stretch: impl FnOnce() -> f32) -> [f32; 3] {
        rest
    }

    #[inline(always)]
    fn undo(&self, probe: Vec3, _within: f32) -> Vec3 {
        probe
    }
}
