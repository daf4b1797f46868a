//! A knob with four lobes: a wall of splines with inner knots, hollow between the lobes, and flat ends.

use super::net::{Net, plain};

/// A quarter of the outline in a plane across the axis, C¹ over the two inner knots; at its ends it meets the next
/// quarter smoothly.
const OUTLINE: [[f64; 2]; 5] = [[20.0, 0.0], [20.0, 9.0], [11.0, 11.0], [9.0, 20.0], [0.0, 20.0]];
const INNER: [f64; 2] = [1.0 / 3.0, 2.0 / 3.0];
/// Where a control point of a straight spline with these knots lies along the line.
const EVEN: [f64; 5] = [0.0, 1.0 / 6.0, 0.5, 5.0 / 6.0, 1.0];
/// Heights along the axis, and how wide the knob is there.
const WALL: [[f64; 2]; 3] = [[-13.0, 1.0], [0.0, 1.2], [13.0, 1.0]];
/// The corners of a square in the middle of each end lie this far out.
const MIDDLE: f64 = 8.0;

fn turned([x, y]: [f64; 2], turns: usize) -> [f64; 2] {
    (0..turns).fold([x, y], |[x, y], _| [-y, x])
}

/// Four quarters, each with two ends, and the two squares.
pub(super) fn nets() -> Vec<Net> {
    let mut nets = Vec::new();
    for turns in 0..4 {
        let wall = |at: [f64; 2]| {
            let [x, y] = turned(at, turns);
            WALL.map(|[z, scale]| plain([scale * x, scale * y, z])).to_vec()
        };
        let spline = |degree, points| Net { degree, inner_knots: [INNER.to_vec(), vec![]], points, flip: false };
        nets.push(spline([2, 2], OUTLINE.map(wall).to_vec()));
        for [z, _] in [WALL[0], WALL[2]] {
            let end = |index: usize| {
                let [x, y] = turned(OUTLINE[index], turns);
                let [a, b] = turned([MIDDLE * (1.0 - EVEN[index]), MIDDLE * EVEN[index]], turns);
                vec![plain([a, b, z]), plain([x, y, z])]
            };
            // Around and outward: down.
            nets.push(spline([2, 1], (0..5).map(end).collect()).flipped(z > 0.0));
        }
    }
    for [z, _] in [WALL[0], WALL[2]] {
        let corner = |turns| {
            let [x, y] = turned([MIDDLE, 0.0], turns);
            [x, y, z]
        };
        nets.push(Net::bilinear([[corner(3), corner(0)], [corner(2), corner(1)]]).flipped(z > 0.0));
    }
    nets
}
