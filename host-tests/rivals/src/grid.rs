//! A grid of distances over the body's bounding box.

use crate::Answer;
use palpate::math::{Vec3, inverse_sqrt};

/// Distances, or the coefficients of splines through them, at the nodes of a grid with cubic cells.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// The first node, metres.
    corner: Vec3,
    /// One over the spacing, 1/m.
    per_metre: f32,
    /// Nodes along x, y and z, at least 4 each.
    counts: [usize; 3],
    /// Metres; z runs fastest.
    values: &'a [f32],
}

/// A probe's cell and its place in it, both along x, y and z.
type Place = ([usize; 3], [f32; 3]);

impl<'a> Grid<'a> {
    /// The table: counts, corner, one over the spacing, then the values. `None` if it is cut short.
    pub fn of(words: &'a [u32]) -> Option<Self> {
        let (head, values) = words.split_first_chunk::<7>()?;
        let [x, y, z, rest @ ..] = *head;
        let [corner_x, corner_y, corner_z, per_metre] = rest.map(f32::from_bits);
        let counts = [x, y, z].map(|count| count as usize);
        let is_whole = counts.iter().all(|count| *count >= 4) && values.len() == counts.iter().product();
        is_whole.then(|| Self {
            corner: Vec3::new(corner_x, corner_y, corner_z),
            per_metre,
            counts,
            values: bytemuck::cast_slice(values),
        })
    }

    /// The trilinear interpolation of distances, and its gradient.
    pub fn trilinear(&self, probe: Vec3) -> Answer {
        let ([x, y, z], [s, t, w]) = self.place(probe);
        let row = |x, y| {
            let [low, high] = *self.row::<2>(x, y, z);
            [low + (high - low) * w, high - low]
        };
        // Value and slope along z, then along y, then along x.
        let [near, far] = [x, x + 1].map(|x| {
            let ([low, low_z], [high, high_z]) = (row(x, y), row(x, y + 1));
            [low + (high - low) * t, high - low, low_z + (high_z - low_z) * t]
        });
        let [value, along_y, along_z] = [0, 1, 2].map(|index| near[index] + (far[index] - near[index]) * s);
        answer(probe, value, Vec3::new(far[0] - near[0], along_y, along_z))
    }

    /// The cubic B-spline of these coefficients, and its gradient: continuous to the second derivative.
    pub fn tricubic(&self, probe: Vec3) -> Answer {
        let ([x, y, z], places) = self.place(probe);
        let [[over_x, slope_x], [over_y, slope_y], [over_z, slope_z]] =
            places.map(|place| [weights(place), slopes(place)]);
        let (mut value, mut gradient) = (0.0, Vec3::ZERO);
        for (i, (over_x, slope_x)) in over_x.iter().zip(slope_x).enumerate() {
            let mut plane = [0.0; 3];
            for (j, (over_y, slope_y)) in over_y.iter().zip(slope_y).enumerate() {
                let row = self.row::<4>(x + i - 1, y + j - 1, z - 1);
                let [on, along] = [sum(row, &over_z), sum(row, &slope_z)];
                plane = [plane[0] + on * over_y, plane[1] + on * slope_y, plane[2] + along * over_y];
            }
            value += plane[0] * over_x;
            gradient += Vec3::new(plane[0] * slope_x, plane[1] * over_x, plane[2] * over_x);
        }
        answer(probe, value, gradient)
    }

    /// A probe beyond the second node from a border takes the nearest cell.
    #[inline(always)]
    fn place(&self, probe: Vec3) -> Place {
        let places = ((probe - self.corner) * self.per_metre).to_array();
        let mut cells = [0; 3];
        let mut within = [0.0; 3];
        for axis in 0..3 {
            cells[axis] = (places[axis] as usize).clamp(1, self.counts[axis] - 3);
            within[axis] = places[axis] - cells[axis] as f32;
        }
        (cells, within)
    }

    #[inline(always)]
    fn row<const N: usize>(&self, x: usize, y: usize, z: usize) -> &'a [f32; N] {
        let first = (x * self.counts[1] + y) * self.counts[2] + z;
        self.values.get(first..).and_then(<[f32]>::first_chunk).unwrap_or(&[0.0; N])
    }
}

#[inline(always)]
fn answer(probe: Vec3, gap_m: f32, gradient: Vec3) -> Answer {
    let normal = gradient * inverse_sqrt(gradient.length_squared());
    Answer { gap_m, normal, point: probe - normal * gap_m }
}

#[inline(always)]
fn sum(row: &[f32; 4], weights: &[f32; 4]) -> f32 {
    row[0] * weights[0] + row[1] * weights[1] + row[2] * weights[2] + row[3] * weights[3]
}

/// The four cubic B-splines that are not zero within a cell.
#[inline(always)]
fn weights(t: f32) -> [f32; 4] {
    let (rest, third) = (1.0 - t, 1.0 / 6.0);
    let (first, last) = (rest * rest * rest * third, t * t * t * third);
    let second = 2.0 / 3.0 - t * t + 3.0 * last;
    [first, second, 1.0 - first - second - last, last]
}

/// Their derivatives.
#[inline(always)]
fn slopes(t: f32) -> [f32; 4] {
    let rest = 1.0 - t;
    let (first, last) = (-0.5 * rest * rest, 0.5 * t * t);
    let second = 3.0 * last - 2.0 * t;
    [first, second, -(first + second + last), last]
}
