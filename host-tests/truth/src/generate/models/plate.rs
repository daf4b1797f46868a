//! A cuboid from six planes.

use super::text::BezierPatch;

/// A cuboid from the origin to a corner.
pub(super) fn patches([x, y, z]: [f64; 3]) -> Vec<BezierPatch> {
    let plane = |name: &str, origin: [f64; 3], u: [f64; 3], v: [f64; 3]| {
        let at = |s: f64, t: f64| {
            let [x, y, z] = [0, 1, 2].map(|axis| origin[axis] + s * u[axis] + t * v[axis]);
            [x, y, z, 1.0]
        };
        let points = vec![vec![at(0.0, 0.0), at(0.0, 1.0)], vec![at(1.0, 0.0), at(1.0, 1.0)]];
        BezierPatch { name: name.to_owned(), degree: [1, 1], points, flip: false }
    };
    let (along_x, along_y, along_z) = ([x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]);
    vec![
        plane("top", along_z, along_x, along_y),
        plane("bottom", [0.0; 3], along_y, along_x),
        plane("front", [0.0; 3], along_x, along_z),
        plane("back", along_y, along_z, along_x),
        plane("left", [0.0; 3], along_z, along_y),
        plane("right", along_x, along_y, along_z),
    ]
}
