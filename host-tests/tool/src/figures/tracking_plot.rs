//! Figure 8 as the paper draws it, and the limits of stability beside their predictions.

use super::page::{Axes, THICK, THIN, dot, key, legend, page, scene, view_across};
use super::subject::Subject;
use super::tracking::{Configuration, Limit, PAPER_LIMIT, PERIOD, Sample};
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, GREEN_INK, RED_INK, SURFACE_INK, thinned};
use palpate::track::Integrator;
use plotters::element::{DashedPathElement, PathElement};
use plotters::prelude::*;

/// Ticks between the snapshots of panel (A): with `K = 50` and a step of 1 ms the correction of the start shows in the
/// first few.
const SNAPSHOT: usize = 12;

/// The figure, as SVG text: runs at the good, the chattering and the slow gain, and those without a gain to choose.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw(subject: &Subject, runs: &[Vec<Sample>; 3], certified: &[Vec<Sample>; 2]) -> anyhow::Result<String> {
    page((1000, 1140), |area| {
        let rows = area.split_evenly((3, 1));
        let (upper, lower) = (rows[0].split_evenly((1, 2)), rows[1].split_evenly((1, 2)));
        path(&upper[0], subject, &runs[0])?;
        errors(&upper[1], "(B) K = 50 1/s", &runs[0])?;
        errors(&lower[0], "(C) K = 1300 1/s: chatter", &runs[1])?;
        errors(&lower[1], "(D) K = 0.02 1/s: slow", &runs[2])?;
        lags(&rows[2], [&runs[0], &certified[0], &certified[1]])
    })
}

/// What single precision leaves of the errors, and what is drawn of less.
const LEAST: f64 = 1e-8;

fn lags(area: &Drawing<'_>, runs: [&Vec<Sample>; 3]) -> DrawingResult {
    let end = runs[0].last().map_or(1.0, |sample| sample.time);
    let title = "(E) what a tick leaves, powers of ten";
    let mut chart =
        Axes { title, x: (0.0, end), y: (LEAST.log10(), 0.0), x_label: "time, s", y_label: "log₁₀ ‖Ψ‖" }.chart(area)?;
    let laws = [
        ("the paper's law, K = 50 1/s", RED_INK),
        ("the paper's law, certified gain", GREEN_INK),
        ("second order", BLUE_INK),
    ];
    for (run, (name, ink)) in runs.into_iter().zip(laws) {
        let size = |sample: &Sample| sample.left.max(LEAST).log10();
        let line: Vec<_> = run.iter().map(|sample| (sample.time, size(sample))).collect();
        chart.draw_series([PathElement::new(line, ink.stroke_width(THIN + 1))])?.label(name).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

fn path(area: &Drawing<'_>, subject: &Subject, run: &[Sample]) -> DrawingResult {
    // The start is on its own way; after it the lines show how far the witness point lags.
    let lines: Vec<_> =
        run.iter().skip(100).step_by(SNAPSHOT).map(|sample| (sample.parameters, sample.probe)).collect();
    let view = view_across(subject, &lines);
    let probes: Vec<_> = run.iter().map(|sample| sample.probe).collect();
    let mut chart = scene(area, "(A) tracking, K = 50 1/s", subject, &view, &probes)?;
    let lines = run.iter().step_by(SNAPSHOT);
    let lines = lines.map(|sample| vec![view.seen(sample.witness), view.seen(sample.probe)]);
    chart.draw_series(lines.map(|line| PathElement::new(line, SURFACE_INK.stroke_width(THIN))))?;
    let path_of =
        |point: fn(&Sample) -> glam::DVec3| run.iter().map(|sample| view.seen(point(sample))).collect::<Vec<_>>();
    chart.draw_series([PathElement::new(path_of(|sample| sample.probe), RED_INK.stroke_width(THICK))])?;
    chart.draw_series([PathElement::new(path_of(|sample| sample.witness), BLUE_INK.stroke_width(THICK))])?;
    let shown = run.iter().step_by(SNAPSHOT);
    chart.draw_series(shown.map(|sample| Circle::new(view.seen(sample.witness), 5, BLUE_INK.filled())))?;
    if let [first, ..] = run {
        dot(&mut chart, view.seen(first.witness), "P₀", BLUE_INK, (12, 4))?;
        dot(&mut chart, view.seen(first.probe), "Q", RED_INK, (-34, -34))?;
    }
    Ok(())
}

fn errors(area: &Drawing<'_>, title: &str, run: &[Sample]) -> DrawingResult {
    let end = run.last().map_or(1.0, |sample| sample.time);
    let mut chart =
        Axes { title, x: (0.0, end), y: (-1.1, 1.1), x_label: "time, s", y_label: "Ψ / max |Ψ|" }.chart(area)?;
    for (axis, name, ink) in [(0, "Ψᵘ", BLUE_INK), (1, "Ψᵛ", RED_INK)] {
        let peak = run.iter().map(|sample| sample.errors[axis].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let line: Vec<_> = run.iter().map(|sample| (sample.time, sample.errors[axis] / peak)).collect();
        let line = thinned(&line);
        chart.draw_series([PathElement::new(line, ink.stroke_width(THIN + 1))])?.label(name).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

/// The limits of stability: predictions as lines, measurements as dots.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_limits(limits: &[Limit], rest: &Configuration) -> anyhow::Result<String> {
    page((720, 460), |area| {
        let x = limits.iter().map(|limit| limit.product).fold(0.0, f64::max) + 0.1;
        // Both lines from the start on: 2.785 / h at most.
        let y = 2_900.0;
        let title = "Greatest stable gain, step 1 ms: lines predicted, marks measured";
        let x_label = "κ ‖ΔR‖";
        let mut chart = Axes { title, x: (0.0, x), y: (0.0, y), x_label, y_label: "K, 1/s" }.chart(area)?;
        for (integrator, name, ink, radius) in [
            (Integrator::RungeKutta4, "Runge–Kutta: 2.785 / (h (1 + κ ‖ΔR‖))", GREEN_INK, 7),
            (Integrator::Heun, "Euler (dots), Heun (rings): 2 / (h (1 + κ ‖ΔR‖))", BLUE_INK, 11),
            (Integrator::Euler, "", BLUE_INK, 6),
        ] {
            let of_this = || limits.iter().filter(move |limit| limit.integrator == integrator);
            if !name.is_empty() {
                let at = |step: i32| f64::from(step) * x / 100.0;
                let predicted = |x: f64| f64::from(integrator.stability_bound()) / (PERIOD * (1.0 + x));
                let line = (0..=100).map(|step| (at(step), predicted(at(step))));
                chart.draw_series(LineSeries::new(line, ink.stroke_width(THIN)))?.label(name).legend(key(ink));
            }
            let style = if integrator == Integrator::Heun { ink.stroke_width(THIN) } else { ink.filled() };
            chart.draw_series(of_this().map(|limit| Circle::new((limit.product, limit.measured), radius, style)))?;
        }
        let product = rest.curvature * rest.distance;
        let cross = vec![(0.0, PAPER_LIMIT), (product, PAPER_LIMIT), (product, 0.0)];
        let dashed = DashedPathElement::new(cross, 10, 8, RED_INK.stroke_width(THIN));
        chart.draw_series([dashed])?.label("the paper's 1250 1/s").legend(key(RED_INK));
        legend(&mut chart, SeriesLabelPosition::UpperRight)
    })
}
