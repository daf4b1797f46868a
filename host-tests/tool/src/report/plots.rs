//! The plots of a run, as SVG text.

use super::Page;
use super::summary::norm;
use crate::drawing::{BLUE_INK, RED_INK, SURFACE_INK, View, draw, equal_scale, thinned};
use crate::simulation::Trace;
use palpate::math::Vec3;
use palpate::track::Contact;
use palpate::wire::Report;
use plotters::prelude::*;

const WIDE: (u32, u32) = (920, 240);
/// A path of more points shows nothing more.
const MOST_POINTS: usize = 7_200;

/// The gap over time, mm.
pub fn gap(trace: &Trace) -> anyhow::Result<String> {
    line_plot(trace, "gap, mm", |sample| f64::from(sample.report.gap) * 1e3, BLUE_INK)
}

/// The force over time, N.
pub fn force(trace: &Trace) -> anyhow::Result<String> {
    line_plot(trace, "force, N", |sample| norm(sample.report.force), RED_INK)
}

/// The active feature over time, numbered in the order in which features come.
pub fn feature(trace: &Trace) -> anyhow::Result<String> {
    let mut met = Vec::new();
    for sample in &trace.samples {
        if !met.contains(&sample.report.feature) {
            met.push(sample.report.feature);
        }
    }
    let number = |code| met.iter().position(|known| *known == code).unwrap_or_default();
    line_plot(trace, "feature", |sample| number(sample.report.feature) as f64, BLUE_INK)
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

/// The surface as a net of lines, and the probe's path over it.
pub fn path(page: &Page<'_>) -> anyhow::Result<String> {
    let seen = |report: &Report| View::FRONT_RIGHT.seen(Vec3::from_array(report.probe).as_dvec3());
    let net = page.net;
    let stride = page.trace.samples.len().div_ceil(MOST_POINTS).max(1);
    let samples: Vec<_> = page.trace.samples.iter().step_by(stride).map(|sample| &sample.report).collect();
    let runs =
        samples.chunk_by(|a, b| (a.contact == Contact::Touching as u8) == (b.contact == Contact::Touching as u8));

    let all = net.iter().flatten().copied().chain(samples.iter().map(|report| seen(report)));
    let (across, up) = equal_scale(all, (920.0, 520.0));
    draw((920, 520), |area| {
        let mut chart = ChartBuilder::on(area).margin(4).build_cartesian_2d(across, up)?;
        for line in net {
            chart.draw_series(LineSeries::new(line.iter().copied(), SURFACE_INK))?;
        }
        for run in runs {
            let ink = if run.first().is_some_and(|report| report.contact == Contact::Touching as u8) {
                RED_INK
            } else {
                BLUE_INK
            };
            chart.draw_series(LineSeries::new(run.iter().map(|report| seen(report)), ink))?;
        }
        Ok(())
    })
}
