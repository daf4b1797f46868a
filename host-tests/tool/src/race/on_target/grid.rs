//! Tables of the distance grids, sampled by the oracle.

use glam::DVec3;
use rayon::prelude::*;

/// Cells around the bounding box that a cubic reaches into.
const BORDER: usize = 1;
/// Bytes of a grid's head.
const HEAD: usize = 28;

/// Distances at the nodes of a grid.
#[derive(Clone, Debug)]
pub struct Samples {
    corner: DVec3,
    spacing: f64,
    counts: [usize; 3],
    values: Vec<f64>,
}

impl Samples {
    /// As many as these bytes hold, over a box.
    pub fn new(flash: usize, [low, high]: [DVec3; 2], distance: impl Fn(DVec3) -> f64 + Sync) -> Self {
        let length = high - low;
        let counts =
            |spacing: f64| length.to_array().map(|length| (length / spacing).ceil().max(1.0) as usize + 1 + 2 * BORDER);
        let fits = |spacing: f64| HEAD + 4 * counts(spacing).iter().product::<usize>() <= flash;
        let (mut fine, mut coarse) = (1e-6 * length.max_element(), length.max_element());
        for _ in 0..60 {
            let middle = 0.5 * (fine + coarse);
            if fits(middle) {
                coarse = middle;
            } else {
                fine = middle;
            }
        }
        let (spacing, counts) = (coarse, counts(coarse));
        let cells = DVec3::from_array(counts.map(|count| (count - 1) as f64));
        let corner = 0.5 * (low + high) - 0.5 * spacing * cells;
        let node = |index: usize| {
            let [x, y, z] = [index / (counts[1] * counts[2]), index / counts[2] % counts[1], index % counts[2]];
            distance(corner + spacing * DVec3::new(x as f64, y as f64, z as f64))
        };
        let values = (0..counts.iter().product()).into_par_iter().map(node).collect();
        Self { corner, spacing, counts, values }
    }

    /// The table of a trilinear grid.
    pub fn linear(&self) -> Vec<u32> {
        self.words(&self.values)
    }

    /// The table of a tricubic grid: coefficients of the B-spline through the samples, which is straight at its ends.
    pub fn cubic(&self) -> Vec<u32> {
        let mut values = self.values.clone();
        let [_, y, z] = self.counts;
        for (axis, stride) in [y * z, z, 1].into_iter().enumerate() {
            for first in (0..values.len()).filter(|index| (index / stride).is_multiple_of(self.counts[axis])) {
                interpolate(&mut values, first, stride, self.counts[axis]);
            }
        }
        self.words(&values)
    }

    fn words(&self, values: &[f64]) -> Vec<u32> {
        let head = self.corner.to_array().into_iter().chain([1.0 / self.spacing]);
        let numbers = head.chain(values.iter().copied()).map(|number| (number as f32).to_bits());
        self.counts.iter().map(|count| *count as u32).chain(numbers).collect()
    }
}

/// Solves `(c[i − 1] + 4 c[i] + c[i + 1]) / 6 = s[i]` in place, with `c = s` at both ends.
fn interpolate(values: &mut [f64], first: usize, stride: usize, count: usize) {
    let at = |index: usize| first + index * stride;
    let mut factors = vec![0.0; count];
    for index in 1..count - 1 {
        let pivot = 4.0 - factors[index - 1];
        factors[index] = 1.0 / pivot;
        values[at(index)] = (6.0 * values[at(index)] - values[at(index - 1)]) / pivot;
    }
    for index in (1..count - 1).rev() {
        values[at(index)] -= factors[index] * values[at(index + 1)];
    }
}
