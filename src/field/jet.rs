//! A displacement of space around a point: its value and derivatives up to the second, and the chain rule.

use crate::math::Vec3;
use crate::patch::{CurvedPoint, SurfacePoint};

/// `Φ = id + ψ` around a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    /// `Φ(X)`, metres.
    pub point: Vec3,
    /// The columns of `DΦ(X)`.
    pub columns: [Vec3; 3],
    /// `½ D²ψ[a, a]` as a polynomial in the components of `a`: of `xx, xy, xz, yy, yz, zz`, 1/m.
    pub half_bend: [Vec3; 6],
}

impl Jet {
    /// `DΦ w`.
    #[inline(always)]
    pub(super) fn along(&self, w: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        x * w.x + y * w.y + z * w.z
    }

    /// `½ D²ψ[a, a]`.
    #[inline(always)]
    fn half_bend(&self, a: Vec3) -> Vec3 {
        let [xx, xy, xz, yy, yz, zz] = self.half_bend;
        (xx * a.x + xy * a.y + xz * a.z) * a.x + (yy * a.y + yz * a.z) * a.y + zz * (a.z * a.z)
    }

    /// `D²ψ[a, b]`.
    #[inline(always)]
    fn bend(&self, a: Vec3, b: Vec3) -> Vec3 {
        let [xx, xy, xz, yy, yz, zz] = self.half_bend;
        let mixed = xy * (a.x * b.y + a.y * b.x) + xz * (a.x * b.z + a.z * b.x) + yz * (a.y * b.z + a.z * b.y);
        let pure = xx * (a.x * b.x) + yy * (a.y * b.y) + zz * (a.z * b.z);
        mixed + pure + pure
    }

    /// `f_w → DΦ f_w`.
    #[inline(always)]
    pub(super) fn displace(&self, SurfacePoint { point, tangent_u, tangent_v }: &mut SurfacePoint) {
        (*point, *tangent_u, *tangent_v) = (self.point, self.along(*tangent_u), self.along(*tangent_v));
    }

    /// `f_ww → DΦ f_ww + D²ψ[f_w, f_w]` as well.
    #[inline(always)]
    pub(super) fn displace_curved(&self, CurvedPoint { surface, second }: &mut CurvedPoint) {
        let (tangent_u, tangent_v) = (surface.tangent_u, surface.tangent_v);
        second.half_uu = self.along(second.half_uu) + self.half_bend(tangent_u);
        second.uv = self.along(second.uv) + self.bend(tangent_u, tangent_v);
        second.half_vv = self.along(second.half_vv) + self.half_bend(tangent_v);
        self.displace(surface);
    }

    /// The same of a curve: tangent and half the second derivative.
    #[inline(always)]
    pub(super) fn displace_curve(&self, point: &mut Vec3, tangent: &mut Vec3, half_second: &mut Vec3) {
        *half_second = self.along(*half_second) + self.half_bend(*tangent);
        (*point, *tangent) = (self.point, self.along(*tangent));
    }

    /// `cof DΦ · n`, which is `det DΦ · DΦ⁻ᵀ n`.
    #[inline(always)]
    pub(super) fn normal(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z
    }

    /// `DΦ⁻¹ w`; `None` where `DΦ` turns space inside out.
    pub(super) fn back(&self, w: Vec3) -> Option<Vec3> {
        /// Minimum of `det DΦ`: with less, space is nearly folded.
        const MIN_VOLUME: f32 = 0.05;
        let [x, y, z] = self.columns;
        let (yz, zx, xy) = (y.cross(z), z.cross(x), x.cross(y));
        let volume = x.dot(yz);
        (volume > MIN_VOLUME).then(|| Vec3::new(w.dot(yz), w.dot(zx), w.dot(xy)) * (1.0 / volume))
    }
}
