//! Polynomial Bézier curves and patches: what a model file is made of.

use glam::DVec3;

/// A Bézier curve by its points, one more than its degree.
pub type Points = Vec<DVec3>;

/// A Bézier patch; point `(i, j)` is entry `i · (degree[1] + 1) + j`.
#[derive(Clone, Debug, PartialEq)]
pub struct Bezier {
    /// Degrees along `u` and `v`.
    pub degree: [usize; 2],
    /// Control points, millimetres.
    pub points: Points,
}

/// Bernstein's polynomials of a degree at `t`, and their first derivatives.
pub fn bernstein(degree: usize, t: f64) -> [[f64; 6]; 2] {
    let mut row = [0.0; 6];
    let mut lower = [0.0; 6];
    row[0] = 1.0;
    for level in 1..=degree {
        lower = row;
        let mut next = [0.0; 6];
        for i in 0..level {
            next[i] += (1.0 - t) * row[i];
            next[i + 1] += t * row[i];
        }
        row = next;
    }
    let mut slopes = [0.0; 6];
    for i in 0..degree {
        slopes[i] -= degree as f64 * lower[i];
        slopes[i + 1] += degree as f64 * lower[i];
    }
    [row, slopes]
}

/// Position and derivative of a curve.
pub fn curve_at(points: &[DVec3], t: f64) -> [DVec3; 2] {
    let [values, slopes] = bernstein(points.len() - 1, t);
    let sum = |factors: &[f64; 6]| points.iter().zip(factors).map(|(point, factor)| *point * *factor).sum::<DVec3>();
    [sum(&values), sum(&slopes)]
}

/// The same curve with one degree more.
pub fn elevated(points: &[DVec3]) -> Points {
    let degree = points.len() - 1;
    let along = |k: usize| {
        let share = k as f64 / (degree + 1) as f64;
        match k {
            0 => points[0],
            _ if k > degree => points[degree],
            _ => points[k - 1] * share + points[k] * (1.0 - share),
        }
    };
    (0..=degree + 1).map(along).collect()
}

/// The same curve with this degree, or its own if that is higher.
pub fn raised(points: &[DVec3], degree: usize) -> Points {
    let mut points = points.to_vec();
    while points.len() <= degree {
        points = elevated(&points);
    }
    points
}

impl Bezier {
    /// The index of a control point.
    pub const fn index(&self, i: usize, j: usize) -> usize {
        i * (self.degree[1] + 1) + j
    }

    /// Position and derivatives by `u` and `v`.
    pub fn at(&self, u: f64, v: f64) -> [DVec3; 3] {
        let [a, b] = [bernstein(self.degree[0], u), bernstein(self.degree[1], v)];
        let mut sums = [DVec3::ZERO; 3];
        for i in 0..=self.degree[0] {
            for j in 0..=self.degree[1] {
                let point = self.points[self.index(i, j)];
                for (sum, (k, l)) in sums.iter_mut().zip([(0, 0), (1, 0), (0, 1)]) {
                    *sum += point * (a[k][i] * b[l][j]);
                }
            }
        }
        sums
    }

    /// The patch of Coons over four curves: `bottom` and `top` run along `u`, `left` and `right` along `v`. Degrees are
    /// those of the higher of opposite curves, or `least` if that is higher. The curves are its borders to the last bit
    /// where they have its degree.
    pub fn coons(bottom: &[DVec3], top: &[DVec3], left: &[DVec3], right: &[DVec3], least: [usize; 2]) -> Self {
        let p = (bottom.len() - 1).max(top.len() - 1).max(least[0]);
        let q = (left.len() - 1).max(right.len() - 1).max(least[1]);
        let [bottom, top] = [raised(bottom, p), raised(top, p)];
        let [left, right] = [raised(left, q), raised(right, q)];
        let mut points = Vec::with_capacity((p + 1) * (q + 1));
        for i in 0..=p {
            for j in 0..=q {
                let (s, t) = (i as f64 / p as f64, j as f64 / q as f64);
                points.push(match (i, j) {
                    (i, 0) => bottom[i],
                    (i, j) if j == q => top[i],
                    (0, j) => left[j],
                    (i, j) if i == p => right[j],
                    (i, j) => {
                        let ruled = bottom[i] * (1.0 - t) + top[i] * t + left[j] * (1.0 - s) + right[j] * s;
                        let corners = bottom[0] * ((1.0 - s) * (1.0 - t))
                            + bottom[p] * (s * (1.0 - t))
                            + top[0] * ((1.0 - s) * t)
                            + top[p] * (s * t);
                        ruled - corners
                    }
                });
            }
        }
        Self { degree: [p, q], points }
    }

    /// The parameters of the point nearest to `point`, from a guess, by Gauss's and Newton's method in the square; and
    /// how far it is.
    pub fn project(&self, point: DVec3, guess: [f64; 2]) -> ([f64; 2], f64) {
        let [mut u, mut v] = guess;
        let [mut at, mut du, mut dv] = self.at(u, v);
        let mut best = at.distance_squared(point);
        // Far from a curved patch Gauss's steps are many.
        for _ in 0..200 {
            let off = at - point;
            let (g, h) = (off.dot(du), off.dot(dv));
            let (a, b, c) = (du.dot(du), du.dot(dv), dv.dot(dv));
            let determinant = a * c - b * b;
            let (mut s, mut t) = if determinant > 1e-12 * a * c {
                ((c * g - b * h) / determinant, (a * h - b * g) / determinant)
            } else {
                (if a > 1e-24 { g / a } else { 0.0 }, if c > 1e-24 { h / c } else { 0.0 })
            };
            // At a border, the parameter along it alone.
            let held = |x: f64, step: f64| x <= 0.0 && step > 0.0 || x >= 1.0 && step < 0.0;
            if held(u, s) && c > 0.0 {
                (s, t) = (0.0, h / c);
            } else if held(v, t) && a > 0.0 {
                (s, t) = (g / a, 0.0);
            }
            let mut share = 1.0;
            let mut gained = false;
            while share > 1e-3 && !gained {
                let next = [(u - s * share).clamp(0.0, 1.0), (v - t * share).clamp(0.0, 1.0)];
                let there = self.at(next[0], next[1]);
                let distance = there[0].distance_squared(point);
                if distance < best {
                    gained = best - distance > 1e-16 * best;
                    [u, v] = next;
                    ([at, du, dv], best) = (there, distance);
                    break;
                }
                share *= 0.3;
            }
            if !gained {
                break;
            }
        }
        ([u, v], best.sqrt())
    }
}
