//! A biquadratic patch with all derivatives up to the second, by Horner's rule on palpate's own table, unrolled for the
//! degree.

use crate::scene::Scene;
use palpate::math::Vec3;

/// The table, cut into spans.
#[derive(Clone, Debug)]
pub struct Biquadratic {
    breaks: [Vec<f32>; 2],
    spans: Vec<[[Vec3; 3]; 3]>,
}

/// A point with first and second derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Derivatives {
    pub point: Vec3,
    pub first: [Vec3; 2],
    /// `f_uu`, `f_uv`, `f_vv`.
    pub second: [Vec3; 3],
}

impl Biquadratic {
    /// Of the scene's patch.
    pub fn new(scene: &Scene) -> Self {
        let rows: Vec<[Vec3; 3]> =
            scene.coefficients.chunks_exact(3).map(|row| [row[0], row[1], row[2]].map(Vec3::from_array)).collect();
        Self {
            breaks: scene.breaks.map(<[f32]>::to_vec),
            spans: rows.chunks_exact(3).map(|rows| [rows[0], rows[1], rows[2]]).collect(),
        }
    }

    /// The point alone.
    pub fn point(&self, [u, v]: [f32; 2]) -> Vec3 {
        let (span, s, t) = self.locate(u, v);
        let row = |row: &[Vec3; 3]| (row[2] * t + row[1]) * t + row[0];
        (row(&span[2]) * s + row(&span[1])) * s + row(&span[0])
    }

    /// Everything.
    #[inline]
    pub fn evaluate(&self, [u, v]: [f32; 2]) -> Derivatives {
        let (span, s, t) = self.locate(u, v);
        let value = |row: &[Vec3; 3]| (row[2] * t + row[1]) * t + row[0];
        let slope = |row: &[Vec3; 3]| row[2] * (2.0 * t) + row[1];
        let values = [value(&span[0]), value(&span[1]), value(&span[2])];
        let slopes = [slope(&span[0]), slope(&span[1]), slope(&span[2])];
        Derivatives {
            point: (values[2] * s + values[1]) * s + values[0],
            first: [values[2] * (2.0 * s) + values[1], (slopes[2] * s + slopes[1]) * s + slopes[0]],
            second: [
                values[2] * 2.0,
                slopes[2] * (2.0 * s) + slopes[1],
                ((span[2][2] * s + span[1][2]) * s + span[0][2]) * 2.0,
            ],
        }
    }

    /// The span, and the distances from its centre.
    #[inline]
    fn locate(&self, u: f32, v: f32) -> (&[[Vec3; 3]; 3], f32, f32) {
        let [(span_u, s), (span_v, t)] = [(0, u), (1, v)].map(|(axis, parameter)| {
            let breaks = &self.breaks[axis];
            let inner = &breaks[1..breaks.len() - 1];
            let span = inner.iter().take_while(|border| parameter >= **border).count();
            (span, parameter - 0.5 * (breaks[span] + breaks[span + 1]))
        });
        (&self.spans[span_u * (self.breaks[1].len() - 1) + span_v], s, t)
    }
}
