//! The four borders of a patch, as curves with what the surface does beside them.

use crate::NurbsPatch;
use crate::jet::Jet;
use glam::DVec3;
use std::fmt;

/// One border of one patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Border {
    /// Index of the patch.
    pub patch: usize,
    /// 0 to 3: `u = 0`, `u = 1`, `v = 0`, `v = 1`.
    pub side: usize,
}

/// A point of a border, in double precision.
#[derive(Clone, Copy, Debug)]
pub struct BorderPoint {
    /// Metres.
    pub point: DVec3,
    /// By the parameter that runs along the border.
    pub tangent: DVec3,
    /// Second derivative by it.
    pub second: DVec3,
    /// The derivative across the border, out of the patch.
    pub across: DVec3,
    /// The outward unit normal; zero where the tangents span no plane.
    pub normal: DVec3,
}

impl BorderPoint {
    /// The outward conormal: the unit vector in the tangent plane, normal to the border, out of the patch. Zero where
    /// there is none.
    pub fn conormal(&self) -> DVec3 {
        let along = self.tangent.normalize_or_zero();
        (self.across - along * self.across.dot(along)).normalize_or_zero()
    }
}

/// Tangents at a smaller sine span no plane: their normal would be the rounding of the model's decimals.
const LEAST_SINE: f64 = 1e-7;

impl Border {
    /// All borders of `patches` patches.
    pub fn all(patches: usize) -> impl Iterator<Item = Self> {
        (0..patches).flat_map(|patch| (0..4).map(move |side| Self { patch, side }))
    }

    /// Which of the two parameters runs along it: 0 for `u`, 1 for `v`.
    pub const fn axis(self) -> usize {
        if self.side < 2 { 1 } else { 0 }
    }

    /// Whether it is the border where the other parameter is 1.
    pub const fn is_upper(self) -> bool {
        self.side % 2 == 1
    }

    /// The patch's parameters at `t` along it.
    pub const fn parameters(self, t: f64) -> [f64; 2] {
        let fixed = if self.is_upper() { 1.0 } else { 0.0 };
        if self.side < 2 { [fixed, t] } else { [t, fixed] }
    }

    /// Evaluates it on its patch.
    pub fn at(self, patch: &NurbsPatch, t: f64) -> BorderPoint {
        let [u, v] = self.parameters(t);
        let surface = Jet::of(patch, u, v);
        let (tangent, second, across) = if self.side < 2 {
            (surface.tangent_v, surface.second_vv, surface.tangent_u)
        } else {
            (surface.tangent_u, surface.second_uu, surface.tangent_v)
        };
        let cross = surface.tangent_u.cross(surface.tangent_v);
        let spans_plane = cross.length() > LEAST_SINE * surface.tangent_u.length() * surface.tangent_v.length();
        let turned = if patch.flip { -cross } else { cross };
        BorderPoint {
            point: surface.point,
            tangent,
            second,
            across: if self.is_upper() { across } else { -across },
            normal: if spans_plane { turned.normalize_or_zero() } else { DVec3::ZERO },
        }
    }

    /// The point alone.
    pub fn point(self, patch: &NurbsPatch, t: f64) -> DVec3 {
        let [u, v] = self.parameters(t);
        Jet::of(patch, u, v).point
    }

    /// Whether its parameter runs with the patch on its left, seen from outside the body. Two faces that meet on an
    /// edge and agree on where outside is run along it in opposite senses.
    pub const fn runs_with_patch_on_left(self, flip: bool) -> bool {
        (self.side == 1 || self.side == 2) != flip
    }

    /// Its control points and weights, where the knots are clamped there; its knots and degree are those along
    /// [`Self::axis`].
    pub fn controls(self, patch: &NurbsPatch) -> Option<Vec<(DVec3, f64)>> {
        let across = 1 - self.axis();
        let (knots, degree) = (&patch.knots[across], patch.degree[across]);
        let end = if self.is_upper() { &knots[knots.len() - degree - 1..] } else { &knots[..=degree] };
        if end.iter().any(|knot| *knot != end[0]) {
            return None;
        }
        let line = if self.is_upper() { patch.counts[across] - 1 } else { 0 };
        let index = |k: usize| if across == 0 { line * patch.counts[1] + k } else { k * patch.counts[1] + line };
        Some((0..patch.counts[self.axis()]).map(|k| (patch.points[index(k)], patch.weights[index(k)])).collect())
    }
}

impl fmt::Display for Border {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(["u = 0", "u = 1", "v = 0", "v = 1"][self.side])
    }
}
