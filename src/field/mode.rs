//! Modes of deformation, and the field that they blend to.

use super::jet::Jet;
use super::{Displacement, Rigid};
use crate::math::{Vec3, saturate, sqrt_from_above};
use crate::patch::{
    ALL_KINDS, Curvature, CurvedPoint, KindSet, SecondDerivativeBounds, ShapeBounds, SurfacePoint,
    ThirdDerivativeBounds,
};

/// Maximum number of modes of a body.
pub const MAX_MODES: usize = 8;

/// A quadratic displacement of space, in metres per metre of `q`, in the frame of the body's tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic {
    /// At the origin.
    pub constant: Vec3,
    /// Of `x`, `y`, `z`, 1/m.
    pub linear: [Vec3; 3],
    /// Of `xx`, `xy`, `xz`, `yy`, `yz`, `zz`, 1/m².
    pub quadratic: [Vec3; 6],
}

impl Quadratic {
    /// No displacement.
    pub const ZERO: Self = Self { constant: Vec3::ZERO, linear: [Vec3::ZERO; 3], quadratic: [Vec3::ZERO; 6] };

    /// `ψ(X)` for 1 m of `q`.
    fn at(&self, at: Vec3) -> Vec3 {
        let ([x, y, z], [xx, xy, xz, yy, yz, zz]) = (self.linear, self.quadratic);
        let (a, b, c) = (xx * at.x + xy * at.y + xz * at.z, yy * at.y + yz * at.z, zz * at.z);
        self.constant + (x + a) * at.x + (y + b) * at.y + (z + c) * at.z
    }

    /// Adds another, `q` times.
    #[inline]
    fn add(&mut self, other: &Self, q: f32) {
        self.constant += other.constant * q;
        for (sum, term) in self.linear.iter_mut().zip(&other.linear) {
            *sum += *term * q;
        }
        for (sum, term) in self.quadratic.iter_mut().zip(&other.quadratic) {
            *sum += *term * q;
        }
    }

    #[inline(always)]
    fn jet(&self, at: Vec3) -> Jet {
        let ([x, y, z], [xx, xy, xz, yy, yz, zz]) = (self.linear, self.quadratic);
        let (a, b, c) = (xx * at.x + xy * at.y + xz * at.z, yy * at.y + yz * at.z, zz * at.z);
        let point = at + (self.constant + (x + a) * at.x + (y + b) * at.y + (z + c) * at.z);
        let columns = [
            Vec3::X + (x + (a + xx * at.x)),
            Vec3::Y + (y + (b + (xy * at.x + yy * at.y))),
            Vec3::Z + (z + (c + (xz * at.x + yz * at.y + zz * at.z))),
        ];
        Jet { point, columns, half_bend: self.quadratic }
    }
}

/// A local displacement: `direction (1 − ‖X − at‖²/radius²)³` within the radius. Twice continuously differentiable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bump {
    /// Metres per metre of `q`, at its middle.
    pub direction: Vec3,
    /// Its middle, metres.
    pub at: Vec3,
    /// Metres.
    pub radius: f32,
}

impl Bump {
    fn at(&self, at: Vec3) -> Vec3 {
        let left = 1.0 - (at - self.at).length_squared() / (self.radius * self.radius);
        if left > 0.0 { self.direction * (left * left * left) } else { Vec3::ZERO }
    }

    /// Adds the bump, `q` times.
    #[inline]
    fn add_to(&self, jet: &mut Jet, at: Vec3, q: f32) {
        let (offset, inverse) = (at - self.at, 1.0 / (self.radius * self.radius));
        let left = 1.0 - offset.length_squared() * inverse;
        // Written so that NaN adds nothing.
        let is_inside = left > 0.0;
        if !is_inside {
            return;
        }
        let direction = self.direction * q;
        jet.point += direction * (left * left * left);
        let slope = direction * (-6.0 * left * left * inverse);
        let [x, y, z] = &mut jet.columns;
        *x += slope * offset.x;
        *y += slope * offset.y;
        *z += slope * offset.z;
        // ½ D² of the bump: −3 left²/ρ² ‖a‖² + 12 left/ρ⁴ (offset·a)².
        let (even, twist) = (slope * 0.5, direction * (12.0 * left * inverse * inverse));
        let [xx, xy, xz, yy, yz, zz] = &mut jet.half_bend;
        *xx += even + twist * (offset.x * offset.x);
        *yy += even + twist * (offset.y * offset.y);
        *zz += even + twist * (offset.z * offset.z);
        let twice = twist + twist;
        *xy += twice * (offset.x * offset.y);
        *xz += twice * (offset.x * offset.z);
        *yz += twice * (offset.y * offset.z);
    }
}

/// Bounds of a displacement `ψ` over the convex hull of the body: of a mode a metre of `q`, of a field as it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldBounds {
    /// `sup ‖ψ‖`, metres.
    pub motion: f32,
    /// `sup ‖Dψ‖`.
    pub stretch: f32,
    /// `sup ‖D²ψ‖`, 1/m.
    pub bend: f32,
    /// `sup ‖D³ψ‖`, 1/m².
    pub twist: f32,
}

impl FieldBounds {
    /// Of no displacement.
    pub const ZERO: Self = Self { motion: 0.0, stretch: 0.0, bend: 0.0, twist: 0.0 };

    const fn is_valid(&self) -> bool {
        let Self { motion, stretch, bend, twist } = *self;
        let finite = motion < f32::INFINITY && stretch < f32::INFINITY && bend < f32::INFINITY && twist < f32::INFINITY;
        finite && motion >= 0.0 && stretch >= 0.0 && bend >= 0.0 && twist >= 0.0
    }
}

/// A mode of deformation, baked for one body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// The displacement of space.
    pub field: Quadratic,
    /// Added to it.
    pub bump: Option<Bump>,
    /// Maximum of `|q|`, metres: the budget.
    pub limit: f32,
    /// Its bounds, a metre of `q`.
    pub bounds: FieldBounds,
}

impl Mode {
    /// The displacement of a point of the body at rest, metres per metre of `q`.
    pub fn displacement(&self, at: Vec3) -> Vec3 {
        let of_field = self.field.at(at);
        match &self.bump {
            Some(bump) => of_field + bump.at(at),
            None => of_field,
        }
    }

    /// Whether its numbers can be a mode's: bounds and limit are finite and not negative, a radius is positive.
    pub const fn is_valid(&self) -> bool {
        let has_radius = match self.bump {
            Some(bump) => bump.radius > 0.0 && bump.radius < f32::INFINITY,
            None => true,
        };
        self.bounds.is_valid() && self.limit >= 0.0 && self.limit < f32::INFINITY && has_radius
    }
}

/// The displacement of a body at given `q`: the modes blended, in RAM, once a tick.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    blended: Quadratic,
    modes: &'a [Mode],
    q: [f32; MAX_MODES],
    has_bumps: bool,
    is_rest: bool,
    bounds: FieldBounds,
}

impl<'a> Field<'a> {
    /// No displacement.
    pub(crate) const REST: Self = Self {
        blended: Quadratic::ZERO,
        modes: &[],
        q: [0.0; MAX_MODES],
        has_bumps: false,
        is_rest: true,
        bounds: FieldBounds::ZERO,
    };

    /// Blends at most [`MAX_MODES`] modes. Each `q` is saturated to its mode's limit; a NaN becomes 0. A missing `q` is
    /// 0.
    #[inline(never)]
    pub fn new(modes: &'a [Mode], q: &[f32]) -> Self {
        let mut field = Self {
            blended: Quadratic::ZERO,
            modes,
            q: [0.0; MAX_MODES],
            has_bumps: false,
            is_rest: true,
            bounds: FieldBounds::ZERO,
        };
        for ((mode, given), own) in modes.iter().zip(q).zip(&mut field.q) {
            let given = if given.is_nan() { 0.0 } else { *given };
            let q = saturate(given, -mode.limit, mode.limit);
            // A zero has no sign here, and adds nothing.
            if q == 0.0 {
                continue;
            }
            *own = q;
            field.is_rest = false;
            field.has_bumps |= mode.bump.is_some();
            field.blended.add(&mode.field, q);
            let (size, bounds) = (q.abs(), &mut field.bounds);
            bounds.motion += size * mode.bounds.motion;
            bounds.stretch += size * mode.bounds.stretch;
            bounds.bend += size * mode.bounds.bend;
            bounds.twist += size * mode.bounds.twist;
        }
        field
    }

    /// `q` of each mode, saturated to its limit, metres.
    pub const fn q(&self) -> &[f32; MAX_MODES] {
        &self.q
    }

    /// Whether each `q` given to [`Self::new`] was within its limit.
    pub fn holds(&self, q: &[f32]) -> bool {
        self.modes.iter().zip(q).all(|(mode, q)| q.abs() <= mode.limit)
    }

    /// `Σ |qᵢ|` times the bounds of each mode.
    pub const fn bounds(&self) -> FieldBounds {
        self.bounds
    }

    /// Bound of how far a point of the body has moved since another field of the same modes, metres (theory §15).
    pub fn motion_since(&self, before: &[f32; MAX_MODES]) -> f32 {
        let moved = self.q.iter().zip(before).map(|(now, before)| (now - before).abs());
        self.modes.iter().zip(moved).map(|(mode, moved)| moved * mode.bounds.motion).sum()
    }

    /// Whether it is affine, so that a convex body stays convex.
    pub(crate) fn is_affine(&self) -> bool {
        self.bounds.bend == 0.0
    }

    #[inline(always)]
    fn jet(&self, at: Vec3) -> Jet {
        let mut jet = self.blended.jet(at);
        if self.has_bumps {
            self.add_bumps(&mut jet, at);
        }
        jet
    }

    #[inline(never)]
    fn add_bumps(&self, jet: &mut Jet, at: Vec3) {
        for (mode, q) in self.modes.iter().zip(self.q) {
            if let Some(bump) = &mode.bump {
                bump.add_to(jet, at, q);
            }
        }
    }

    /// In a copy of its own.
    #[inline(never)]
    fn jet_apart(&self, at: Vec3) -> Jet {
        self.jet(at)
    }
}

impl Displacement for &Field<'_> {
    type Kinds = KindSet<ALL_KINDS>;
    // Those at rest, and the place on the edge.
    const SEPARATORS: [u32; 2] = [1, 2];

    #[inline(always)]
    fn is_rest(&self) -> bool {
        self.is_rest
    }

    fn point(&self, rest: Vec3) -> Vec3 {
        if self.is_rest { rest } else { self.jet_apart(rest).point }
    }

    fn direction(&self, at: Vec3, direction: Vec3) -> Vec3 {
        if self.is_rest { direction } else { self.jet_apart(at).along(direction) }
    }

    fn normal(&self, at: Vec3, normal: Vec3) -> Vec3 {
        if self.is_rest { normal } else { self.jet_apart(at).normal(normal) }
    }

    fn displace(&self, point: &mut SurfacePoint) {
        if !self.is_rest {
            self.jet_apart(point.point).displace(point);
        }
    }

    #[inline(never)]
    fn displace_curved(&self, point: &mut CurvedPoint) {
        if !self.is_rest {
            self.jet(point.surface.point).displace_curved(point);
        }
    }

    fn displace_curve(&self, point: &mut Vec3, tangent: &mut Vec3, half_second: &mut Vec3) {
        if !self.is_rest {
            self.jet_apart(*point).displace_curve(point, tangent, half_second);
        }
    }

    /// Theory §15: with `ε, β, γ` the bounds of `Dψ, D²ψ, D³ψ` and `Λ ≥ ‖f_u‖², ‖f_v‖²`, the second derivatives are
    /// below `(1 + ε) m + β Λ`, the third ones below `(1 + ε) m + 3 β m₂ √Λ + γ Λ^{3/2}`, jumps below `(1 + ε) J`.
    #[inline(always)]
    fn shape(&self, rest: &ShapeBounds) -> ShapeBounds {
        if self.is_rest { *rest } else { self.displaced_shape(rest) }
    }

    fn curve_bounds(&self, rest: [f32; 3], stretch: impl FnOnce() -> f32) -> [f32; 3] {
        if self.is_rest {
            return Rigid::<ALL_KINDS>.curve_bounds(rest, stretch);
        }
        let FieldBounds { stretch: epsilon, bend, twist, .. } = self.bounds;
        let ([second, third, jump], stretch) = (rest, stretch());
        let (grown, length) = (ROUNDED + epsilon, sqrt_from_above(stretch));
        let second_now = grown * second + bend * stretch;
        [second_now, grown * third + length * (3.0 * bend * second + twist * stretch), grown * jump]
    }

    /// Newton's method, at most four rounds from the probe itself; where the field folds space, as far as it came.
    #[inline(never)]
    fn undo(&self, probe: Vec3, within: f32) -> Vec3 {
        let mut at = probe;
        if self.is_rest {
            return at;
        }
        let mut jet = self.jet_apart(at);
        for _ in 0..4 {
            let left = probe - jet.point;
            if left.length_squared() <= within * within {
                break;
            }
            let Some(back) = jet.back(left) else { break };
            let next = self.jet_apart(at + back);
            let is_nearer = (next.point - probe).length_squared() < left.length_squared();
            if !is_nearer {
                break;
            }
            (at, jet) = (at + back, next);
        }
        at
    }
}

/// 1, with the roundings of a bound.
const ROUNDED: f32 = 1.0 + 8.0 * f32::EPSILON;

impl Field<'_> {
    #[inline]
    fn displaced_shape(&self, rest: &ShapeBounds) -> ShapeBounds {
        let FieldBounds { stretch: epsilon, bend, twist, .. } = self.bounds;
        let (second, third) = (&rest.second_derivatives, &rest.third_derivatives);
        let (grown, square) = (ROUNDED + epsilon, rest.max_stretch);
        let (length, added) = (sqrt_from_above(square), bend * square);
        let (turn, twisted) = (bend * length, length * (twist * square));
        let grow = |third: f32, second: f32| grown * third + (turn * second + twisted);
        let second_derivatives = SecondDerivativeBounds {
            uu: grown * second.uu + added,
            uv: grown * second.uv + added,
            vv: grown * second.vv + added,
        };
        let third_derivatives = ThirdDerivativeBounds {
            uuu: grow(third.uuu, 3.0 * second.uu),
            uuv: grow(third.uuv, second.uu + 2.0 * second.uv),
            uvv: grow(third.uvv, second.vv + 2.0 * second.uv),
            vvv: grow(third.vvv, 3.0 * second.vv),
            jump_uu: grown * third.jump_uu,
            jump_vv: grown * third.jump_vv,
        };
        ShapeBounds { second_derivatives, third_derivatives, ..self.displaced_curvature(rest) }
    }

    /// A normal curvature `κ` becomes at most `((1 + ε) κ + β) / (1 − ε)²`.
    #[inline]
    fn displaced_curvature(&self, rest: &ShapeBounds) -> ShapeBounds {
        let FieldBounds { stretch: epsilon, bend, .. } = self.bounds;
        let (grown, shrunk) = (ROUNDED + epsilon, if epsilon < 1.0 { 1.0 - epsilon } else { 0.0 });
        let most = |curvature: f32| {
            let curvature = if curvature > 0.0 { curvature } else { 0.0 };
            let most = (grown * curvature + bend) * ROUNDED / (shrunk * shrunk);
            if shrunk > 0.0 { most } else { f32::INFINITY }
        };
        let curvature = Curvature { min: -most(-rest.curvature.min), max: most(rest.curvature.max) };
        ShapeBounds {
            curvature,
            min_stretch: rest.min_stretch * (shrunk * shrunk),
            max_stretch: rest.max_stretch * (grown * grown),
            ..ShapeBounds::unknown(SecondDerivativeBounds::ZERO)
        }
    }
}
