//! A block whose top is a wave of degree (5, 4): hills, hollows and saddles.

use super::net::{Net, plain};

const HALF: [f64; 2] = [27.0, 20.0];
const BOTTOM: f64 = -15.0;
/// The top's control points over an even grid.
const HEIGHTS: [[f64; 5]; 6] = [
    [10.0, 13.0, 8.0, 12.0, 9.0],
    [12.0, 24.0, -2.0, 20.0, 11.0],
    [7.0, -4.0, 25.0, 1.0, 14.0],
    [12.0, 21.0, -6.0, 26.0, 6.0],
    [9.0, 2.0, 22.0, -1.0, 12.0],
    [11.0, 14.0, 6.0, 13.0, 10.0],
];

pub(super) fn nets() -> Vec<Net> {
    let point = |i: usize, j: usize| {
        let x = HALF[0] * (2.0 * i as f64 / 5.0 - 1.0);
        let y = HALF[1] * (2.0 * j as f64 / 4.0 - 1.0);
        [x, y, HEIGHTS[i][j]]
    };
    let below = |[x, y, _]: [f64; 3]| [x, y, BOTTOM];
    let top = (0..6).map(|i| (0..5).map(|j| plain(point(i, j))).collect()).collect();
    // Along a border of the top, then up.
    let wall =
        |border: Vec<[f64; 3]>| Net::bezier(border.into_iter().map(|at| vec![plain(below(at)), plain(at)]).collect());
    let corner = |i, j| below(point(i, j));
    vec![
        Net::bezier(top),
        wall((0..6).map(|i| point(i, 0)).collect()),
        wall((0..6).map(|i| point(i, 4)).collect()).flipped(true),
        wall((0..5).map(|j| point(0, j)).collect()).flipped(true),
        wall((0..5).map(|j| point(5, j)).collect()),
        Net::bilinear([[corner(0, 0), corner(0, 4)], [corner(5, 0), corner(5, 4)]]).flipped(true),
    ]
}
