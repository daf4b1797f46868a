//! A bar along y with a round groove along its top: an arc that bends inward, exact as a rational patch.

use super::net::{Net, plain};
use std::f64::consts::FRAC_1_SQRT_2;

/// Half the bar's width, its length, and how deep it reaches.
const HALF: [f64; 2] = [26.0, 19.0];
const BOTTOM: f64 = -14.0;
const TOP: f64 = 11.0;
/// Of the groove, a quarter of a circle whose middle lies over the top.
const RADIUS: f64 = 9.0;

/// Three columns, the middle one under the groove.
pub(super) fn nets() -> Vec<Net> {
    let [half, length] = HALF;
    let rim = RADIUS * FRAC_1_SQRT_2;
    // [x, z, weight] from left to right; the tangents at both ends of the arc meet a whole rim below the top.
    let columns: [Vec<[f64; 3]>; 3] = [
        vec![[-half, TOP, 1.0], [-rim, TOP, 1.0]],
        vec![[-rim, TOP, 1.0], [0.0, TOP - rim, FRAC_1_SQRT_2], [rim, TOP, 1.0]],
        vec![[rim, TOP, 1.0], [half, TOP, 1.0]],
    ];
    let mut nets = Vec::new();
    for column in columns {
        let [left, right] = [column[0][0], column[column.len() - 1][0]];
        let upper = |y: f64| column.iter().map(|[x, z, w]| [*x, y, *z, *w]).collect::<Vec<_>>();
        // Evenly, and with weights of 1: the line as the bottom has it.
        let lower = |y: f64| {
            let at = |index: usize| left + (right - left) * index as f64 / (column.len() - 1) as f64;
            (0..column.len()).map(|index| plain([at(index), y, BOTTOM])).collect::<Vec<_>>()
        };
        nets.push(Net::bezier(vec![upper(-length), upper(length)]).flipped(true));
        nets.push(Net::bilinear([
            [[left, -length, BOTTOM], [right, -length, BOTTOM]],
            [[left, length, BOTTOM], [right, length, BOTTOM]],
        ]));
        nets.push(Net::bezier(vec![lower(-length), upper(-length)]).flipped(true));
        nets.push(Net::bezier(vec![lower(length), upper(length)]));
    }
    for x in [-half, half] {
        let corner = |y: f64, z: f64| [x, y, z];
        let wall = Net::bilinear([
            [corner(-length, BOTTOM), corner(-length, TOP)],
            [corner(length, BOTTOM), corner(length, TOP)],
        ]);
        nets.push(wall.flipped(x < 0.0));
    }
    nets
}
