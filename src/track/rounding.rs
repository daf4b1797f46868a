//! Limits of rounding.

use crate::math::{ROOT_EXCESS, Vec3, sqrt, sqrt_from_above};
use crate::patch::SurfacePoint;

/// A rise of the squared distance is rounding as long as it is below this many units in the last place of the
/// coordinates and the size (partial sums are as large as either), times the distance. Horner's rule at degree 5 in
/// both parameters rounds about 20 times a coordinate, at both ends of a step, and uneven weights double it; a rise `δ`
/// of the distance shows as `2 R δ`. So `V` may rise by 32 units in the last place, 4 µm on a body of 1 m.
const ROUNDING: f32 = 64.0 * f32::EPSILON;

/// Whether `x > 0`; for a NaN, its sign bit. As bits it is one comparison that waits for no flags.
#[inline]
pub(super) fn is_above_zero(x: f32) -> bool {
    x.to_bits().cast_signed() > 0
}

/// Whether the squared distance rose by more than rounding. Written so that NaN counts as a rise.
#[inline(always)]
pub(super) fn rises(before: &SurfacePoint, after: &SurfacePoint, probe: Vec3, squared: f32, size: f32) -> bool {
    let now = (after.point - probe).length_squared();
    if now <= squared {
        return false;
    }
    // The size alone is usually enough, with a root that is not above the distance.
    if now - squared <= (ROUNDING / ROOT_EXCESS) * size * sqrt_from_above(squared) {
        return false;
    }
    let coordinates = (before.point.abs() + probe.abs()).max_element() + size;
    let within_rounding = now - squared <= ROUNDING * coordinates * sqrt(squared);
    !within_rounding
}
