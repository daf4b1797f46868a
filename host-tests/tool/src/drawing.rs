//! Parts shared by all drawings: inks, the view of a surface, and SVG text.

use anyhow::anyhow;
use glam::DVec3;
use palpate::patch::Patch;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::ops::Range;

pub const BLUE_INK: RGBColor = RGBColor(31, 111, 235);
pub const RED_INK: RGBColor = RGBColor(209, 36, 47);
pub const GREEN_INK: RGBColor = RGBColor(26, 127, 55);
pub const SURFACE_INK: RGBColor = RGBColor(174, 182, 191);
pub const TEXT_INK: RGBColor = RGBColor(27, 31, 36);

/// More points than a screen has pixels show nothing more.
const MOST_POINTS: usize = 1_800;

pub type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type DrawingResult = Result<(), Box<dyn std::error::Error>>;

/// Draws into an SVG of this size.
pub fn draw(size: (u32, u32), content: impl FnOnce(&Drawing<'_>) -> DrawingResult) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        content(&area).and_then(|()| Ok(area.present()?)).map_err(|error| anyhow!("cannot draw a plot: {error}"))?;
    }
    Ok(text)
}

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

/// Keeps the minimum and the maximum of each bin, so that no peak is lost.
pub fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let bin = points.len().div_ceil(MOST_POINTS / 2);
    let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    points
        .chunks(bin)
        .flat_map(|chunk| {
            let mut pair: Vec<_> =
                chunk.iter().min_by(by_value).into_iter().chain(chunk.iter().max_by(by_value)).collect();
            pair.sort_by(|a, b| a.0.total_cmp(&b.0));
            pair
        })
        .copied()
        .collect()
}
