//! The plainest surface there is.

use palpate::patch::{Coefficients, Orientation, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable};

/// Rows: 1, s; columns: 1, t. A square of 160 mm about the origin, level.
static LEVEL: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.16, 0.0], [0.16, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// A level wall through the origin, felt from above.
pub static WALL: SplinePatch = SplineTable {
    degree: [1, 1],
    breaks_u: &[0.0, 1.0],
    breaks_v: &[0.0, 1.0],
    coefficients: Coefficients::Polynomial(&LEVEL),
    shape: ShapeBounds::unknown(SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 }),
    orientation: Orientation::Outward,
    size_m: 0.16,
    crc: None,
}
.checked();
