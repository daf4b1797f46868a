//! Surfaces seen from the side, as lines on the page.

use glam::DVec3;
use palpate::patch::Patch;
use std::ops::Range;

/// A parallel view from above the horizon.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// How far the viewer has walked round the surface from the front, radians.
    pub turn: f64,
    /// Height above the horizon, radians.
    pub tilt: f64,
}

impl View {
    /// From the front right, 30° above the horizon.
    pub const FRONT_RIGHT: Self = Self { turn: 0.6, tilt: std::f64::consts::FRAC_PI_6 };

    /// A point, metres, on the page, millimetres.
    pub fn seen(&self, point: DVec3) -> (f64, f64) {
        let point = point * 1e3;
        let ((turn_sine, turn_cosine), (tilt_sine, tilt_cosine)) = (self.turn.sin_cos(), self.tilt.sin_cos());
        let across = turn_cosine * point.x - turn_sine * point.y;
        let away = turn_sine * point.x + turn_cosine * point.y;
        (across, tilt_sine * away + tilt_cosine * point.z)
    }

    /// The unit vector towards the viewer.
    pub fn viewer(&self) -> DVec3 {
        let ((turn_sine, turn_cosine), (tilt_sine, tilt_cosine)) = (self.turn.sin_cos(), self.tilt.sin_cos());
        DVec3::new(-tilt_cosine * turn_sine, -tilt_cosine * turn_cosine, tilt_sine)
    }

    /// A patch as a net of lines, its border first.
    pub fn net<P: Patch>(&self, patch: &P) -> Vec<Vec<(f64, f64)>> {
        self.net_of(|u, v| patch.evaluate(u, v).point.as_dvec3())
    }

    /// The same of what has a point for each `(u, v)` in `[0, 1]²`.
    pub fn net_of(&self, point: impl Fn(f32, f32) -> DVec3) -> Vec<Vec<(f64, f64)>> {
        let grid = |index: usize| index as f32 / 24.0;
        let seen = |u: f32, v: f32| self.seen(point(u, v));
        [0, 24]
            .into_iter()
            .chain((2..24).step_by(2))
            .map(grid)
            .flat_map(|fixed| {
                let along_v = (0..=24).map(|index| seen(fixed, grid(index))).collect();
                let along_u = (0..=24).map(|index| seen(grid(index), fixed)).collect();
                [along_v, along_u]
            })
            .collect()
    }
}

/// Ranges that hold all points with equal scales on a page of this size, so that the surface keeps its shape.
pub fn equal_scale(
    points: impl IntoIterator<Item = (f64, f64)>,
    (width, height): (f64, f64),
) -> (Range<f64>, Range<f64>) {
    let (mut low, mut high) = ((f64::MAX, f64::MAX), (f64::MIN, f64::MIN));
    for (x, y) in points {
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x), high.1.max(y));
    }
    // 2 % of room at each side.
    let half = 0.52 * (high.0 - low.0).max((high.1 - low.1) * width / height);
    let (x, y) = (0.5 * (low.0 + high.0), 0.5 * (low.1 + high.1));
    ((x - half)..(x + half), (y - half * height / width)..(y + half * height / width))
}
