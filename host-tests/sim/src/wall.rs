//! The plainest surface there is.

use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch};

/// Rows: 1, s; columns: 1, t. A square of 160 mm about the origin, level.
static LEVEL: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.16, 0.0], [0.16, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// A level wall through the origin, felt from above.
pub static WALL: SplinePatch = SplinePatch::from_table(
    [1, 1],
    &[0.0, 1.0],
    &[0.0, 1.0],
    Coefficients::Polynomial(&LEVEL),
    ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
    Orientation::Outward,
    0.16,
);
