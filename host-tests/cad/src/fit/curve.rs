//! One curve in space as a Bézier curve that begins and ends where and as it does.
//!
//! Its ends and the directions there are kept; how fast it runs is free. So an arc of a quarter needs degree 3 for
//! 2·10⁻⁴ of its radius, and meets the next one without a kink.

use super::least_squares::Normal;
use crate::bezier::{Points, bernstein, curve_at};
use glam::DVec3;

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
