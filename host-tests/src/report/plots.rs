//! The plots of a run, as SVG text.

use super::html::Page;
use super::summary::norm;
use crate::simulation::Trace;
use anyhow::anyhow;
use palpate::patch::Patch;
use palpate::render::Contact;
use plotters::coord::Shift;
use plotters::prelude::*;

const WIDE: (u32, u32) = (920, 240);
const BLUE_INK: RGBColor = RGBColor(31, 111, 235);
const RED_INK: RGBColor = RGBColor(209, 36, 47);
const SURFACE_INK: RGBColor = RGBColor(174, 182, 191);
/// More points than a screen has pixels show nothing more.
const MOST_POINTS: usize = 1_800;

/// The gap over time, mm.
pub fn gap(trace: &Trace) -> anyhow::Result<String> {
    line_plot(trace, "gap, mm", |sample| f64::from(sample.report.gap) * 1e3, BLUE_INK)
}

/// The force over time, N.
pub fn force(trace: &Trace) -> anyhow::Result<String> {
    line_plot(trace, "force, N", |sample| norm(sample.report.force), RED_INK)
}

/// The boundary mode over time.
pub fn mode(trace: &Trace) -> anyhow::Result<String> {
    line_plot(trace, "mode", |sample| f64::from(sample.report.mode), BLUE_INK)
}

/// Instructions a tick over time; `None` where nothing was counted.
pub fn instructions(trace: &Trace) -> anyhow::Result<Option<String>> {
    if trace.samples.iter().all(|sample| sample.report.instructions == 0) {
        return Ok(None);
    }
    line_plot(trace, "instructions", |sample| f64::from(sample.report.instructions), BLUE_INK).map(Some)
}

fn line_plot(
    trace: &Trace,
    label: &str,
    value: impl Fn(&crate::simulation::Sample) -> f64,
    ink: RGBColor,
) -> anyhow::Result<String> {
    let points = thinned(&trace.samples.iter().map(|sample| (sample.time, value(sample))).collect::<Vec<_>>());
    let low = points.iter().map(|point| point.1).fold(0.0, f64::min);
    let high = points.iter().map(|point| point.1).fold(low + 1e-9, f64::max);
    let margin = 0.05 * (high - low);
    let end = points.last().map_or(1.0, |point| point.0);
    draw(WIDE, |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(8)
            .x_label_area_size(36)
            .y_label_area_size(56)
            .build_cartesian_2d(0.0..end, (low - margin)..(high + margin))?;
        chart.configure_mesh().x_desc("time, s").y_desc(label).light_line_style(TRANSPARENT).draw()?;
        chart.draw_series(LineSeries::new(points.iter().copied(), ink))?;
        Ok(())
    })
}

/// Keeps the least and the greatest of each bin, so that no peak is lost.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
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

/// The surface as a net of lines, and the probe's path over it.
pub fn path<P: Patch>(page: &Page<'_, P>) -> anyhow::Result<String> {
    let grid = |index: usize| index as f32 / 24.0;
    let mut net: Vec<Vec<(f64, f64)>> = Vec::new();
    for fixed in (0..=24).step_by(2).map(grid) {
        net.push((0..=24).map(|index| seen(page.patch.evaluate(fixed, grid(index)).point.to_array())).collect());
        net.push((0..=24).map(|index| seen(page.patch.evaluate(grid(index), fixed).point.to_array())).collect());
    }
    let stride = page.trace.samples.len().div_ceil(4 * MOST_POINTS).max(1);
    let samples: Vec<_> = page.trace.samples.iter().step_by(stride).map(|sample| &sample.report).collect();
    let runs =
        samples.chunk_by(|a, b| (a.contact == Contact::Touching as u8) == (b.contact == Contact::Touching as u8));

    let all = || net.iter().flatten().copied().chain(samples.iter().map(|report| seen(report.probe)));
    let extent = |pick: fn((f64, f64)) -> f64| {
        all().map(pick).fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((left, right), (bottom, top)) = (extent(|point| point.0), extent(|point| point.1));
    // Equal scales, so that the surface keeps its shape.
    let half = 0.52 * (right - left).max((top - bottom) * 920.0 / 520.0);
    let (x, y) = (0.5 * (left + right), 0.5 * (bottom + top));
    draw((920, 520), |area| {
        let mut chart = ChartBuilder::on(area)
            .margin(4)
            .build_cartesian_2d((x - half)..(x + half), (y - half * 520.0 / 920.0)..(y + half * 520.0 / 920.0))?;
        for line in net {
            chart.draw_series(LineSeries::new(line, SURFACE_INK))?;
        }
        for run in runs {
            let ink = if run.first().is_some_and(|report| report.contact == Contact::Touching as u8) {
                RED_INK
            } else {
                BLUE_INK
            };
            chart.draw_series(LineSeries::new(run.iter().map(|report| seen(report.probe)), ink))?;
        }
        Ok(())
    })
}

/// A parallel view from the front right, 30° above the horizon; millimetres on the page.
fn seen(point: [f32; 3]) -> (f64, f64) {
    let [x, y, z] = point.map(|component| f64::from(component) * 1e3);
    let (turn_sine, turn_cosine) = 0.6_f64.sin_cos();
    let (tilt_sine, tilt_cosine) = 30.0_f64.to_radians().sin_cos();
    let across = turn_cosine * x - turn_sine * y;
    let away = turn_sine * x + turn_cosine * y;
    (across, tilt_sine * away + tilt_cosine * z)
}

type Drawing<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type DrawingResult = Result<(), Box<dyn std::error::Error>>;

fn draw(size: (u32, u32), content: impl FnOnce(&Drawing<'_>) -> DrawingResult) -> anyhow::Result<String> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        content(&area).and_then(|()| Ok(area.present()?)).map_err(|error| anyhow!("cannot draw a plot: {error}"))?;
    }
    Ok(text)
}
