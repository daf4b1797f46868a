//! A cuboid with all edges rounded alike: planes, quarters of cylinders, and octants of spheres with a pole each.

use super::octants::{QUARTER, quarter};
use super::text::{self, BezierPatch};

/// The text of its model file; sides and radius in millimetres, the origin in its middle.
pub fn rounded_box(sides: [f64; 3], radius: f64) -> String {
    let about = format!("A box of {sides:?} mm, its edges rounded by {radius} mm.");
    text::model(&about, "rounded-box", &patches(sides, radius))
}

fn patches(sides: [f64; 3], radius: f64) -> Vec<BezierPatch> {
    let [x, y, z] = sides.map(|side| 0.5 * side - radius);
    // The centre of the octant of a sector about z.
    let corner = |sector: usize| match sector % 4 {
        0 => [x, y],
        1 => [-x, y],
        2 => [-x, -y],
        _ => [x, -y],
    };
    let at = |[cx, cy]: [f64; 2], [dx, dy, w]: [f64; 3], [out, up, weight]: [f64; 3], level: f64| {
        [cx + radius * dx * out, cy + radius * dy * out, level * (z + radius * up), w * weight]
    };
    let equator = [1.0, 0.0, 1.0];
    let mut patches = Vec::new();
    for sector in 0..4 {
        let [start, ..] = quarter(sector);
        // Along a side of the box, between two corners, in the direction in which a sector begins.
        let along = [corner(sector + 3), corner(sector)];
        let mut add = |name: &str, degree, points, flip| {
            patches.push(BezierPatch { name: format!("{name}{sector}"), degree, points, flip });
        };
        for (level, name) in [(1.0, "upper"), (-1.0, "lower")] {
            let octant = quarter(sector).map(|about| QUARTER.map(|up| at(corner(sector), about, up, level)).to_vec());
            add(&format!("{name}_corner"), [2, 2], octant.to_vec(), level < 0.0);
            let edge = along.map(|end| QUARTER.map(|up| at(end, start, up, level)).to_vec());
            add(&format!("{name}_edge"), [1, 2], edge.to_vec(), level < 0.0);
        }
        let upright = |centre, about| [-1.0, 1.0].map(|level| at(centre, about, equator, level)).to_vec();
        add("upright_edge", [2, 1], quarter(sector).map(|about| upright(corner(sector), about)).to_vec(), false);
        add("side", [1, 1], along.map(|end| upright(end, start)).to_vec(), false);
    }
    for (level, name) in [(1.0, "top"), (-1.0, "bottom")] {
        let point = |sector| at(corner(sector), [0.0, 0.0, 1.0], [0.0, 1.0, 1.0], level);
        let points = vec![vec![point(2), point(1)], vec![point(3), point(0)]];
        patches.push(BezierPatch { name: name.to_owned(), degree: [1, 1], points, flip: level < 0.0 });
    }
    patches
}
