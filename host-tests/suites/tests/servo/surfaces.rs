//! Surfaces to touch.

use palpate::math::{Vec3, vec3};
use palpate::patch::{
    Coefficients, Orientation, Patch, SecondDerivativeBounds, ShapeBounds, SplinePatch, SplineTable, SurfacePoint,
};

/// A level wall through the origin, felt from above.
pub use palpate_sim::wall::WALL;

/// A ball's cap with its top in the origin, by stereographic projection from the opposite pole: `(u, v) ∈ [0, 1]²` is a
/// square around the top.
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
        // Second derivatives of stereographic projection of the unit ball are at most 4 (at the middle) in each
        // direction.
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

/// Table I's convex companion from its model file, in powers about the spans' centres.
pub fn table1c() -> SplinePatch<'static> {
    #[derive(serde::Deserialize)]
    struct Model {
        patch: Vec<Net>,
    }
    #[derive(serde::Deserialize)]
    struct Net {
        knots_u: Vec<f64>,
        knots_v: Vec<f64>,
        points: Vec<Vec<[f64; 3]>>,
    }
    let model: Model = toml::from_str(include_str!("../../../models/table1c.toml")).unwrap();
    let net = &model.patch[0];
    // Quadratic basis functions by their recursion.
    fn basis(knots: &[f64], index: usize, degree: usize, x: f64) -> f64 {
        if degree == 0 {
            return f64::from(knots[index] <= x && x < knots[index + 1]);
        }
        let part = |from: usize, to: usize, value: f64, weight: f64| {
            let width = knots[to] - knots[from];
            if width > 0.0 { weight / width * value } else { 0.0 }
        };
        part(index, index + degree, basis(knots, index, degree - 1, x), x - knots[index])
            + part(index + 1, index + degree + 1, basis(knots, index + 1, degree - 1, x), knots[index + degree + 1] - x)
    }
    let surface = |u: f64, v: f64| {
        let mut point = [0.0; 3];
        for (i, row) in net.points.iter().enumerate() {
            for (j, control) in row.iter().enumerate() {
                let weight = basis(&net.knots_u, i, 2, u) * basis(&net.knots_v, j, 2, v);
                (0..3).for_each(|axis| point[axis] += 0.01 * weight * control[axis]);
            }
        }
        point
    };
    // Three values at −h, 0, h to the powers of a parabola.
    let powers = |h: f64, [a, b, c]: [f64; 3]| [b, (c - a) / (2.0 * h), (a - 2.0 * b + c) / (2.0 * h * h)];
    let breaks: &'static [f32] = Box::leak(Box::new([0.0_f32, 1.0 / 3.0, 2.0 / 3.0, 1.0]));
    let h = 0.1;
    let (mut coefficients, mut greatest) = (Vec::new(), [0.0_f64; 3]);
    for (i, j) in (0..9).map(|span| (span / 3, span % 3)) {
        let centre = |index: usize| f64::from(0.5 * (breaks[index] + breaks[index + 1]));
        let mut rows = [[[0.0_f32; 3]; 3]; 3];
        let mut columns = [[[0.0; 3]; 3]; 3];
        for axis in 0..3 {
            let value = |s: f64, t: f64| surface(centre(i) + s, centre(j) + t)[axis];
            let along_t = [-h, 0.0, h].map(|s| powers(h, [-h, 0.0, h].map(|t| value(s, t))));
            for power_t in 0..3 {
                let along_s = powers(h, [0, 1, 2].map(|s: usize| along_t[s][power_t]));
                for power_s in 0..3 {
                    rows[power_s][power_t][axis] = along_s[power_s] as f32;
                    columns[power_s][power_t][axis] = along_s[power_s];
                }
            }
        }
        // The derivatives' bounds from the powers' lengths, for |s|, |t| up to a sixth.
        let length = |s: usize, t: usize| columns[s][t].iter().map(|x: &f64| x * x).sum::<f64>().sqrt();
        let w = 1.0 / 6.0;
        let found = [
            2.0 * (length(2, 0) + w * length(2, 1) + w * w * length(2, 2)),
            length(1, 1) + 2.0 * w * (length(2, 1) + length(1, 2)) + 4.0 * w * w * length(2, 2),
            2.0 * (length(0, 2) + w * length(1, 2) + w * w * length(2, 2)),
        ];
        greatest = [0, 1, 2].map(|k: usize| greatest[k].max(found[k] * 1.001));
        coefficients.extend(rows.into_iter().flatten());
    }
    let [uu, uv, vv] = greatest.map(|bound| bound as f32);
    SplineTable {
        degree: [2, 2],
        breaks_u: breaks,
        breaks_v: breaks,
        coefficients: Coefficients::Polynomial(Box::leak(coefficients.into_boxed_slice())),
        shape: ShapeBounds::unknown(SecondDerivativeBounds { uu, uv, vv }),
        orientation: Orientation::Inward,
        size_m: 0.1,
        crc: None,
    }
    .checked()
}
