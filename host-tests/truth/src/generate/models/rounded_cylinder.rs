//! A cylinder with rounded rims, in four sectors, without poles.

use super::octants::{QUARTER, quarter};
use super::text::BezierPatch;

/// The shape, mm.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    /// Of the wall.
    pub radius: f64,
    /// From cap to cap.
    pub height: f64,
    /// Of the rims' rounding.
    pub rounding: f64,
}

/// The one that ships.
pub(super) const SHAPE: Shape = Shape { radius: 30.0, height: 50.0, rounding: 8.0 };

/// The middle of the body is the origin. A point of the profile is `[radius, height, weight]`.
pub(super) fn patches(shape: Shape) -> Vec<BezierPatch> {
    let Shape { radius, height, rounding } = shape;
    let (inner, wall) = (radius - rounding, 0.5 * height - rounding);
    let rim = QUARTER.map(|[r, h, w]| [inner + rounding * r, wall + rounding * h, w]);
    let mirrored = |[r, h, w]: [f64; 3]| [r, -h, w];
    let mut patches = Vec::new();
    for sector in 0..4 {
        // `u` runs about z, `v` up the profile.
        let turned = |kind: &str, profile: &[[f64; 3]]| {
            let point = |[x, y, w]: [f64; 3], [r, h, weight]: [f64; 3]| [x * r, y * r, h, w * weight];
            let row = |about| profile.iter().map(|along| point(about, *along)).collect();
            BezierPatch {
                name: format!("{kind}{sector}"),
                degree: [2, profile.len() - 1],
                points: quarter(sector).map(row).to_vec(),
                flip: false,
            }
        };
        patches.push(turned("wall", &[[radius, -wall, 1.0], [radius, wall, 1.0]]));
        patches.push(turned("upper_rim", &rim));
        let [a, b, c] = rim.map(mirrored);
        patches.push(turned("lower_rim", &[c, b, a]));
    }
    for (kind, z, flip) in [("top", 0.5 * height, false), ("bottom", -0.5 * height, true)] {
        patches.extend(cap(kind, inner, z, flip));
    }
    patches
}

/// A disc: a square whose corners lie halfway out, and between each of its sides and the circle a patch ruled by
/// straight lines. Along the side the weights are 1, as the square's are; along the arc they are the arc's.
fn cap(kind: &str, radius: f64, z: f64, flip: bool) -> Vec<BezierPatch> {
    let corner = |turns: usize| {
        let [[x, y, _], ..] = quarter(turns);
        [0.5 * radius * x, 0.5 * radius * y, z, 1.0]
    };
    let square = BezierPatch {
        name: format!("{kind}_middle"),
        degree: [1, 1],
        points: vec![vec![corner(3), corner(0)], vec![corner(2), corner(1)]],
        // The corners run clockwise from (u, v) = (0, 0).
        flip: !flip,
    };
    let sector = |turns: usize| {
        let (from, to) = (corner(turns), corner(turns + 1));
        let halfway = [0, 1, 2, 3].map(|axis| 0.5 * (from[axis] + to[axis]));
        let arc = quarter(turns).map(|[x, y, w]| [radius * x, radius * y, z, w]);
        let [a, b, c] = arc;
        BezierPatch {
            name: format!("{kind}{turns}"),
            degree: [1, 2],
            points: vec![vec![from, halfway, to], vec![a, b, c]],
            flip,
        }
    };
    [square].into_iter().chain((0..4).map(sector)).collect()
}
