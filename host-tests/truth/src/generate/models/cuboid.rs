//! Patches as text of a model file, to be edited.

use std::fmt::Write as _;

/// A corner, in the model's unit.
pub type Corner = [f64; 3];

/// A cuboid's six patches as text, all normals inward if it is a hollow.
pub fn cuboid(name: &str, [x0, y0, z0]: Corner, [x1, y1, z1]: Corner, hollow: bool) -> String {
    // A corner, and where u and v lead from it.
    let sides = [
        ("top", [[x0, y0, z1], [x1, y0, z1], [x0, y1, z1]], false),
        ("bottom", [[x0, y0, z0], [x1, y0, z0], [x0, y1, z0]], true),
        ("left", [[x0, y0, z0], [x0, y1, z0], [x0, y0, z1]], true),
        ("right", [[x1, y0, z0], [x1, y1, z0], [x1, y0, z1]], false),
        ("front", [[x0, y0, z0], [x1, y0, z0], [x0, y0, z1]], false),
        ("back", [[x0, y1, z0], [x1, y1, z0], [x0, y1, z1]], true),
    ];
    let mut text = String::new();
    for (side, [from, u, v], flip) in sides {
        let far = [0, 1, 2].map(|axis| u[axis] + v[axis] - from[axis]);
        let flip = flip != hollow;
        let _ = write!(
            text,
            "[[patch]]\nname = \"{name} {side}\"\ndegree = [1, 1]\npoints = [[{from:?}, {v:?}], [{u:?}, {far:?}]]\nflip = {flip}\n"
        );
    }
    text
}

/// Why an edit cannot be made.
const MODEL: &str = "text of a model file";

/// The text of a model with all its points moved, in its unit.
///
/// # Panics
/// If it is no model.
pub fn moved(text: &str, offset: [f64; 3]) -> String {
    let mut model: toml::Table = text.parse().expect(MODEL);
    for patch in model["patch"].as_array_mut().expect(MODEL) {
        for point in
            patch["points"].as_array_mut().expect(MODEL).iter_mut().flat_map(|row| row.as_array_mut().expect(MODEL))
        {
            for (coordinate, by) in point.as_array_mut().expect(MODEL).iter_mut().zip(offset) {
                let at = coordinate.as_float().or_else(|| coordinate.as_integer().map(|at| at as f64)).expect(MODEL);
                *coordinate = toml::Value::Float(at + by);
            }
        }
    }
    model.to_string()
}
