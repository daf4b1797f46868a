//! An ellipsoid from eight octants of degree (2, 2), each with a side that is one point, the pole.

use super::text::BezierPatch;
use std::f64::consts::FRAC_1_SQRT_2;

/// A quarter of the unit circle: control points and weights.
pub(super) const QUARTER: [[f64; 3]; 3] = [[1.0, 0.0, 1.0], [1.0, 1.0, FRAC_1_SQRT_2], [0.0, 1.0, 1.0]];

/// The quarter turned by so many right angles about the origin.
pub(super) fn quarter(turns: usize) -> [[f64; 3]; 3] {
    QUARTER.map(|[x, y, w]| match turns % 4 {
        0 => [x, y, w],
        1 => [-y, x, w],
        2 => [-x, -y, w],
        _ => [y, -x, w],
    })
}

/// `u` runs about z, `v` from the equator to a pole.
pub(super) fn patches(half_axes: [f64; 3]) -> Vec<BezierPatch> {
    let octant = |sector: usize, upper: bool| {
        let point = |[x, y, w]: [f64; 3], [radius, height, weight]: [f64; 3]| {
            let height = if upper { height } else { -height };
            let [x, y, z] = [x * radius, y * radius, height];
            [x * half_axes[0], y * half_axes[1], z * half_axes[2], w * weight]
        };
        let points = quarter(sector).map(|about| QUARTER.map(|along| point(about, along)).to_vec()).to_vec();
        let name = format!("{}{sector}", if upper { "upper" } else { "lower" });
        BezierPatch { name, degree: [2, 2], points, flip: !upper }
    };
    [true, false].into_iter().flat_map(|upper| (0..4).map(move |sector| octant(sector, upper))).collect()
}
