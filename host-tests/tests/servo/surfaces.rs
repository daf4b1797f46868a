//! Surfaces to touch.

use palpate::math::{Vec3, vec3};
use palpate::patch::{Coefficients, Orientation, Patch, SecondDerivativeBounds, SplinePatch, SurfacePoint};

static BREAKS: [f32; 2] = [0.0, 1.0];
/// Rows: 1, s; columns: 1, t. A square of 160 mm about the origin, level.
static LEVEL: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [0.0, 0.16, 0.0], [0.16, 0.0, 0.0], [0.0, 0.0, 0.0]];

/// A level wall through the origin, felt from above.
pub static WALL: SplinePatch = SplinePatch::from_table(
    [1, 1],
    &BREAKS,
    &BREAKS,
    Coefficients::Polynomial(&LEVEL),
    SecondDerivativeBounds { uu: 0.0, uv: 0.0, vv: 0.0 },
    Orientation::Outward,
    0.16,
);

/// A ball's cap with its top in the origin, by stereographic projection from the opposite pole: `(u, v) ∈ [0, 1]²` is a square around the top.
#[derive(Clone, Copy, Debug)]
pub struct Cap {
    /// Metres.
    pub radius: f32,
}

impl Patch for Cap {
    fn evaluate(&self, u: f32, v: f32) -> SurfacePoint {
        // p = (2a, 2b, 1 − q)/(1 + q) with q = a² + b², (a, b) = (u, v) − ½.
        let (a, b) = (u - 0.5, v - 0.5);
        let d = 1.0 / (1.0 + a * a + b * b);
        let top = vec3(2.0 * a, 2.0 * b, 1.0 - a * a - b * b);
        let slope = |direction: Vec3, along: f32| (direction - top * (2.0 * along * d)) * (d * self.radius);
        SurfacePoint {
            point: top * (d * self.radius) - Vec3::Z * self.radius,
            tangent_u: slope(vec3(2.0, 0.0, -2.0 * a), a),
            tangent_v: slope(vec3(0.0, 2.0, -2.0 * b), b),
        }
    }

    fn bounds(&self) -> SecondDerivativeBounds {
        // Second derivatives of stereographic projection of the unit ball are at most 4 (at the middle) in each direction.
        SecondDerivativeBounds { uu: 4.0 * self.radius, uv: 4.0 * self.radius, vv: 4.0 * self.radius }
    }

    fn orientation(&self) -> f32 {
        // f_u × f_v points up: a along x, b along y, the top towards z.
        1.0
    }

    fn size(&self) -> f32 {
        2.0 * self.radius
    }
}
