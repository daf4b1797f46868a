//! Whether a patch bends outward everywhere.

use super::baked::BakedPatch;
use super::patch::NurbsPatch;
use super::shape::FLAT;
use std::fmt;

/// An edge on which no tangent is longer than this, in sizes, is a point to `f32`.
pub(super) const POLE: f64 = 1e-6;

/// Whether the patch bends outward everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Convexity {
    /// The minimum curvature is proved not to be negative.
    Proved,
    /// The minimum curvature is proved not to be below this, 1/m, which is within rounding of the maximum curvature:
    /// straight somewhere, like a cylinder.
    UpToRounding(f32),
    /// The minimum curvature is proved not to be below this, 1/m, and no sample is negative.
    Open(f32),
    /// A sample bends inward.
    Disproved {
        /// Its curvature, 1/m.
        curvature: f64,
        /// Where.
        parameters: [f64; 2],
    },
}

impl fmt::Display for Convexity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Proved => write!(formatter, "convex: proved"),
            Self::UpToRounding(least) => {
                write!(formatter, "convex: up to rounding (straight somewhere; no curvature is below {least:.1e} 1/m)")
            }
            Self::Open(least) if least.is_finite() => {
                write!(formatter, "convex: not proved (no curvature is below {least:.3e} 1/m)")
            }
            Self::Open(_) => write!(formatter, "convex: not proved (the curvature has no bound)"),
            Self::Disproved { curvature, parameters: [u, v] } => {
                write!(formatter, "convex: no (curvature {curvature:.3e} 1/m at u = {u:.3}, v = {v:.3})")
            }
        }
    }
}

/// From the proved bound and, where that is negative, the samples.
pub(super) fn convexity(patch: &NurbsPatch, baked: &BakedPatch) -> Convexity {
    let proved = baked.shape.curvature;
    if proved.is_convex() {
        return Convexity::Proved;
    }
    let size = patch.size();
    let (mut least, mut worst, mut largest) = (f64::INFINITY, [0.0; 2], 0.0_f64);
    patch.for_each_sample(12, |parameters, surface| {
        // At a pole the tangents are rounding, and so would be the curvature.
        if surface.tangent_u.cross(surface.tangent_v).length() <= POLE * size * size {
            return true;
        }
        let [low, high] = surface.principal_curvatures(patch.flip);
        if low < least {
            (least, worst) = (low, parameters);
        }
        largest = largest.max(low.abs()).max(high.abs());
        true
    });
    let rounding = (FLAT * largest).max(curvature_of_rounding(patch, baked));
    if least < -rounding {
        Convexity::Disproved { curvature: least, parameters: worst }
    } else if f64::from(proved.min) >= -rounding {
        Convexity::UpToRounding(proved.min)
    } else {
        Convexity::Open(proved.min)
    }
}

/// The normal curvature, 1/m, that rounding the coefficients to `f32` can add to a patch: what a plane or a rim that
/// runs out into one shows in its table. A coordinate moves by 2⁻²³ of the largest at most (a sum of powers); by
/// Markov's inequality a polynomial of degree `p` that is at most `ε` on a span of width `h` has a second derivative of
/// at most `p² (p² − 1)/3 · 4 ε/h²`; and the curvature is that over the stretch. Capped at an arrow height of 1e-5 of
/// the size: near a pole the stretch vanishes.
fn curvature_of_rounding(patch: &NurbsPatch, baked: &BakedPatch) -> f64 {
    let extent = patch.points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    let along = |axis: usize| {
        let square = (patch.degree[axis] * patch.degree[axis]) as f64;
        let narrowest = baked.breaks[axis].windows(2).map(|pair| f64::from(pair[1] - pair[0])).fold(1.0, f64::min);
        square * (square - 1.0) / 3.0 * 4.0 / (narrowest * narrowest)
    };
    let second = along(0).max(along(1)) * f64::from(f32::EPSILON) * extent;
    (second / f64::from(baked.shape.min_stretch)).min(8e-5 / patch.size())
}
