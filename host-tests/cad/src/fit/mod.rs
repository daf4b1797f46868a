//! Exact curves and surfaces as polynomials within a tolerance.

use crate::bezier::{Bezier, Points, bernstein, curve_at};
use crate::mesh::Quad;
use crate::nurbs::Surface;
use glam::{DVec2, DVec3};

// Linear least squares by the normal equations.

/// Rows gathered into the normal equations `Aᵀ A x = Aᵀ b`.
struct Normal {
    count: usize,
    matrix: Vec<f64>,
    right: Vec<f64>,
}

impl Normal {
    /// For `count` unknowns.
    pub fn new(count: usize) -> Self {
        Self { count, matrix: vec![0.0; count * count], right: vec![0.0; count] }
    }

    /// Adds `Σ factor · x[index] = value`.
    pub fn add(&mut self, row: &[(usize, f64)], value: f64) {
        for (i, a) in row {
            self.right[*i] += a * value;
            for (j, b) in row {
                self.matrix[i * self.count + j] += a * b;
            }
        }
    }

    /// Pulls every unknown towards 0, by this share of the mean of the diagonal.
    pub fn damp(&mut self, share: f64) {
        let trace: f64 = (0..self.count).map(|i| self.matrix[i * self.count + i]).sum();
        let pull = share * trace / self.count.max(1) as f64 + f64::MIN_POSITIVE;
        for i in 0..self.count {
            self.matrix[i * self.count + i] += pull;
        }
    }

    /// By Cholesky's decomposition; none if the matrix is not positive.
    pub fn solve(mut self) -> Option<Vec<f64>> {
        let n = self.count;
        for j in 0..n {
            for k in 0..j {
                let factor = self.matrix[j * n + k];
                for i in j..n {
                    self.matrix[i * n + j] -= self.matrix[i * n + k] * factor;
                }
            }
            let pivot = self.matrix[j * n + j];
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let root = pivot.sqrt();
            for i in j..n {
                self.matrix[i * n + j] /= root;
            }
        }
        let mut x = self.right;
        for i in 0..n {
            for k in 0..i {
                x[i] -= self.matrix[i * n + k] * x[k];
            }
            x[i] /= self.matrix[i * n + i];
        }
        for i in (0..n).rev() {
            for k in i + 1..n {
                x[i] -= self.matrix[k * n + i] * x[k];
            }
            x[i] /= self.matrix[i * n + i];
        }
        Some(x)
    }
}

// One curve in space as a Bézier curve that begins and ends where and as it does.
//
// Its ends and the directions there are kept; how fast it runs is free. So an arc of a quarter needs degree 3 for
// 2·10⁻⁴ of its radius, and meets the next one without a kink.

const SAMPLES: usize = 96;
const ROUNDS: usize = 12;
/// The handles at the ends, beside what they are of a curve that runs evenly: of an arc of a quarter 1.05. With longer
/// ones it runs back.
const SHORTEST: f64 = 0.02;
const LONGEST: f64 = 3.0;
/// Weight of running evenly, beside a distance: where a curve is nearly straight, only this says how long its handles
/// are, and elsewhere it changes nothing that shows.
const EVEN: f64 = 1e-3;

/// A curve and how far it is off.
#[derive(Clone, Debug)]
pub struct FittedCurve {
    /// Bézier points.
    pub points: Points,
    /// The largest distance found between the two, millimetres.
    pub deviation: f64,
}

/// Fits a Bézier curve of degree 1, 3 or 5 to a curve over `[0, 1]`, given by position and derivative, from one node to
/// another.
pub fn fit_curve(exact: impl Fn(f64) -> [DVec3; 2], ends: [DVec3; 2], degree: usize) -> FittedCurve {
    let samples: Vec<_> = (0..=SAMPLES).map(|k| exact(k as f64 / SAMPLES as f64)).collect();
    let mut lengths = vec![0.0];
    for pair in samples.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0][0].distance(pair[1][0]));
    }
    let length = lengths[SAMPLES];
    if degree == 1 || length == 0.0 {
        let points = vec![ends[0], ends[1]];
        let mut at: Vec<f64> = lengths.iter().map(|along| along / length.max(f64::MIN_POSITIVE)).collect();
        let deviation = project(&points, &samples, &mut at);
        return FittedCurve { points, deviation };
    }
    // Where the derivative vanishes, the chord to the next sample has its direction.
    let direction = |k: usize, next: usize| {
        let way = samples[k.max(next)][0] - samples[k.min(next)][0];
        if samples[k][1].length() > 1e-6 * length { samples[k][1].normalize() } else { way.normalize_or_zero() }
    };
    let tangents = [direction(0, 1), direction(SAMPLES, SAMPLES - 1)];
    let mut at: Vec<f64> = lengths.iter().map(|along| along / length).collect();
    // Unknowns: the lengths of both handles, then the points between.
    let free = degree - 3;
    let count = 2 + 3 * free;
    let build = |x: &[f64]| {
        let mut points = vec![ends[0], ends[0] + tangents[0] * x[0]];
        points.extend((0..free).map(|k| DVec3::new(x[2 + 3 * k], x[3 + 3 * k], x[4 + 3 * k])));
        points.extend([ends[1] - tangents[1] * x[1], ends[1]]);
        points
    };
    let handle = length / degree as f64;
    let mut x = vec![handle, handle];
    for k in 0..free {
        let share = (k + 2) as f64 / degree as f64;
        x.extend(samples[(share * SAMPLES as f64).round() as usize][0].to_array());
    }
    let mut best = FittedCurve { points: build(&x), deviation: f64::INFINITY };
    for _ in 0..ROUNDS {
        let points = build(&x);
        let mut normal = Normal::new(count);
        for (sample, t) in samples.iter().zip(&at).skip(1).take(SAMPLES - 1) {
            let [values, _] = bernstein(degree, *t);
            let here = curve_at(&points, *t)[0];
            let along = sample[1].normalize_or_zero();
            let off = sample[0] - here;
            // Two directions across the curve.
            let across = along.any_orthonormal_vector();
            for axis in [across, along.cross(across)] {
                let mut row =
                    vec![(0, values[1] * tangents[0].dot(axis)), (1, -values[degree - 1] * tangents[1].dot(axis))];
                for k in 0..free {
                    row.extend((0..3).map(|c| (2 + 3 * k + c, values[2 + k] * axis[c])));
                }
                normal.add(&row, off.dot(axis));
            }
        }
        (0..2).for_each(|end| normal.add(&[(end, EVEN)], EVEN * (handle - x[end])));
        normal.damp(1e-9);
        let Some(step) = normal.solve() else { break };
        let trial: Vec<f64> = x.iter().zip(&step).map(|(value, step)| value + step).collect();
        let is_sound = |trial: &f64| (SHORTEST * handle..=LONGEST * handle).contains(trial);
        if !(trial[..2].iter().all(is_sound) && trial.iter().all(|value| value.is_finite())) {
            break;
        }
        x = trial;
        let points = build(&x);
        let deviation = project(&points, &samples, &mut at);
        if deviation < best.deviation {
            let gain = best.deviation - deviation;
            let last = gain < 1e-3 * deviation;
            best = FittedCurve { points, deviation };
            if last {
                break;
            }
        }
    }
    if best.deviation == f64::INFINITY {
        best.deviation = project(&best.points, &samples, &mut at);
    }
    best
}

/// Brings the parameters to the feet of the samples; gives the largest distance.
fn project(points: &[DVec3], samples: &[[DVec3; 2]], at: &mut [f64]) -> f64 {
    let mut largest: f64 = 0.0;
    for (sample, t) in samples.iter().zip(at.iter_mut()) {
        for _ in 0..6 {
            let [here, slope] = curve_at(points, *t);
            let step = (sample[0] - here).dot(slope) / slope.length_squared().max(f64::MIN_POSITIVE);
            *t = (*t + step).clamp(0.0, 1.0);
            if step.abs() < 1e-12 {
                break;
            }
        }
        largest = largest.max(curve_at(points, *t)[0].distance(sample[0]));
    }
    largest
}

// The inside of a patch whose borders are given.
//
// Only the inner control points are free. What is asked of them, in the sense of least squares, is distance zero from
// the surface, seen along its normal, and along the borders tangents that lie in the surface's tangent plane: so that
// faces that are tangent stay so. How the patch runs within the surface is nobody's concern, and stays as Coons's
// patch has it.

/// Weight of a border's tangent beside a distance, both in millimetres: of a patch of length 1 a slope of 1 counts as
/// this.
const TANGENT: f64 = 0.3;
/// Weight of staying where it is, along the surface.
const STAY: f64 = 0.03;
const PATCH_ROUNDS: usize = 8;

/// Fits a patch of at least these degrees to the part of a surface that a quad is; with more `firmness` than 1 its inner
/// points stay nearer to Coons's. `curves` are the borders bottom,
/// right, top and left, the first and the third along `u`, the others along `v`.
pub fn fit_patch(surface: &Surface, quad: &Quad, curves: &[Points; 4], least: [usize; 2], firmness: f64) -> Bezier {
    let [bottom, right, top, left] = curves;
    let mut patch = Bezier::coons(bottom, top, left, right, least);
    let [p, q] = patch.degree;
    if p < 2 || q < 2 || surface.degree == [1, 1] && surface.counts == [2, 2] {
        return patch;
    }
    let unknown = |i: usize, j: usize| (i - 1) * (q - 1) + j - 1;
    let is_inner = |i: usize, j: usize| i > 0 && j > 0 && i < p && j < q;
    let count = 3 * (p - 1) * (q - 1);
    let steps = [2 * p + 3, 2 * q + 3];
    let mut guesses: Vec<DVec2> = Vec::new();
    for k in 0..=steps[0] {
        for l in 0..=steps[1] {
            guesses.push(quad.map(k as f64 / steps[0] as f64, l as f64 / steps[1] as f64));
        }
    }
    let mut before = f64::INFINITY;
    for _ in 0..PATCH_ROUNDS {
        let mut normal = Normal::new(count);
        let mut largest: f64 = 0.0;
        for k in 0..=steps[0] {
            for l in 0..=steps[1] {
                let (s, t) = (k as f64 / steps[0] as f64, l as f64 / steps[1] as f64);
                let [a, b] = [bernstein(p, s), bernstein(q, t)];
                let [here, du, dv] = patch.at(s, t);
                let guess = &mut guesses[k * (steps[1] + 1) + l];
                let foot = surface.project(here, *guess);
                *guess = foot.uv;
                let across = surface.normal(foot.uv);
                largest = largest.max(foot.distance);
                // Along the surface it stays where it is.
                let tangents = [across.any_orthonormal_vector(), across.cross(across.any_orthonormal_vector())];
                for tangent in tangents {
                    let mut row = Vec::with_capacity(count);
                    for i in 1..p {
                        for j in 1..q {
                            let share = a[0][i] * b[0][j] * STAY * firmness;
                            row.extend((0..3).map(|c| (3 * unknown(i, j) + c, share * tangent[c])));
                        }
                    }
                    normal.add(&row, 0.0);
                }
                let mut add = |factor: &dyn Fn(usize, usize) -> f64, value: f64, weight: f64| {
                    let mut row = Vec::with_capacity(count);
                    for i in 1..p {
                        for j in 1..q {
                            let share = factor(i, j) * weight;
                            row.extend((0..3).map(|c| (3 * unknown(i, j) + c, share * across[c])));
                        }
                    }
                    normal.add(&row, value * weight);
                };
                let inside = k > 0 && l > 0 && k < steps[0] && l < steps[1];
                if inside {
                    add(&|i, j| a[0][i] * b[0][j], (foot.point - here).dot(across), 1.0);
                    continue;
                }
                if (k == 0 || k == steps[0]) && l > 0 && l < steps[1] {
                    add(&|i, j| a[1][i] * b[0][j], -du.dot(across), TANGENT / p as f64);
                }
                if (l == 0 || l == steps[1]) && k > 0 && k < steps[0] {
                    add(&|i, j| a[0][i] * b[1][j], -dv.dot(across), TANGENT / q as f64);
                }
            }
        }
        if largest <= 1e-9 || largest > 0.99 * before && largest <= before {
            break;
        }
        before = largest;
        normal.damp(1e-7);
        let Some(step) = normal.solve() else { break };
        for i in 0..=p {
            for j in 0..=q {
                if is_inner(i, j) {
                    let k = 3 * unknown(i, j);
                    let index = patch.index(i, j);
                    patch.points[index] += DVec3::new(step[k], step[k + 1], step[k + 2]);
                }
            }
        }
    }
    patch
}
