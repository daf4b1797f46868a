//! Curves in a face's parameters.

use crate::nurbs::Surface;
use glam::{DVec2, DVec3};

/// Intervals between the samples of a path that is not straight.
pub const INTERVALS: usize = 32;

/// A curve in the parameters of a surface over `[0, 1]`: equally spaced samples, a cubic through four of them between.
/// Two samples are a straight line.
#[derive(Clone, Debug)]
pub struct Path(Vec<DVec2>);

impl Path {
    /// A straight line.
    pub fn line(from: DVec2, to: DVec2) -> Self {
        Self(vec![from, to])
    }

    /// Through the values of a function.
    pub fn sampled(mut at: impl FnMut(f64) -> DVec2) -> Self {
        Self((0..=INTERVALS).map(|k| at(k as f64 / INTERVALS as f64)).collect())
    }

    /// Its start.
    pub fn start(&self) -> DVec2 {
        self.0[0]
    }

    /// Where it ends.
    pub fn end(&self) -> DVec2 {
        self.0[self.0.len() - 1]
    }

    /// The point at `t`.
    pub fn at(&self, t: f64) -> DVec2 {
        let last = self.0.len() - 1;
        if last == 1 {
            return self.0[0] * (1.0 - t) + self.0[1] * t;
        }
        let x = t * last as f64;
        let first = (x.floor() as isize - 1).clamp(0, last as isize - 3) as usize;
        let x = x - first as f64;
        let [a, b, c, d] = [x, x - 1.0, x - 2.0, x - 3.0];
        // Lagrange's cubic through 0, 1, 2, 3.
        self.0[first] * (-b * c * d / 6.0)
            + self.0[first + 1] * (a * c * d / 2.0)
            + self.0[first + 2] * (-a * b * d / 2.0)
            + self.0[first + 3] * (a * b * c / 6.0)
    }

    /// The derivative at `t`.
    pub fn slope(&self, t: f64) -> DVec2 {
        if self.0.len() == 2 {
            return self.0[1] - self.0[0];
        }
        let step = 1e-4;
        let (low, high) = ((t - step).max(0.0), (t + step).min(1.0));
        (self.at(high) - self.at(low)) / (high - low)
    }

    /// The part between two values of `t`.
    pub fn part(&self, from: f64, to: f64) -> Self {
        if self.0.len() == 2 {
            return Self::line(self.at(from), self.at(to));
        }
        Self::sampled(|t| self.at(from + (to - from) * t))
    }

    /// The other way round.
    pub fn reversed(&self) -> Self {
        Self(self.0.iter().rev().copied().collect())
    }

    /// Moved.
    pub fn shifted(&self, by: DVec2) -> Self {
        Self(self.0.iter().map(|point| *point + by).collect())
    }

    /// The same ends, the samples brought to the feet of points in space.
    pub fn polished(&self, surface: &Surface, point: impl Fn(f64) -> DVec3) -> Self {
        let last = (self.0.len() - 1) as f64;
        let polish = |(k, uv): (usize, &DVec2)| surface.project(point(k as f64 / last), *uv).uv;
        Self(self.0.iter().enumerate().map(polish).collect())
    }

    /// Points for drawing and for tests of what lies inside: all but the last.
    pub fn polyline(&self) -> impl Iterator<Item = DVec2> + '_ {
        let count = if self.0.len() == 2 { 1 } else { 16 };
        (0..count).map(move |k| self.at(k as f64 / count as f64))
    }
}
