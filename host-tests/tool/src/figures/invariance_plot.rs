//! Figure 6 as the paper draws it.

use super::invariance::{Passage, Sample};
use super::page::{Axes, Chart, THICK, dot, key, legend, mark_time, page, scene, sight, view_of};
use super::subject::Subject;
use crate::drawing::{BLUE_INK, DrawingResult, GREEN_INK, RED_INK, TEXT_INK};
use palpate::track::BoundaryMode;
use plotters::element::{DashedPathElement, PathElement};
use plotters::prelude::*;

/// The figure, as SVG text.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw(subject: &Subject, passage: &Passage) -> anyhow::Result<String> {
    page((1000, 760), |area| {
        let panels = area.split_evenly((2, 2));
        path(&panels[0], subject, passage)?;
        let border = passage.stretches()[1].first().map_or(BoundaryMode::Interior, |sample| sample.mode);
        let title = format!("(B) mode: 5 interior, {} {}", border as u8, place(border));
        let mut modes = axes(passage, &title, "mode", (0.6, 6.4)).chart(&panels[1])?;
        mark(&mut modes, passage)?;
        modes.draw_series([PathElement::new(steps(passage), BLUE_INK.stroke_width(THICK))])?;
        errors(&panels[2], passage)?;
        let millimetres = |sample: &Sample| sample.distance * 1e3;
        let (least, most) = (passage.closest.distance * 1e3, passage.samples.first().map_or(1.0, millimetres));
        let room = 0.06 * (most - least);
        let mut distance =
            axes(passage, "(D) distance", "‖ΔR‖, mm", (least - room, most + 2.5 * room)).chart(&panels[3])?;
        mark(&mut distance, passage)?;
        let floor = vec![(0.0, least), (end(passage), least)];
        distance.draw_series([DashedPathElement::new(floor, 10, 8, TEXT_INK.stroke_width(1))])?;
        let line = passage.samples.iter().map(|sample| (sample.time, millimetres(sample)));
        distance.draw_series(LineSeries::new(line, BLUE_INK.stroke_width(THICK)))?;
        Ok(())
    })
}

fn path(area: &crate::drawing::Drawing<'_>, subject: &Subject, passage: &Passage) -> DrawingResult {
    let view = view_of(subject, passage.samples.iter().map(|sample| &sample.parameters));
    let probe = passage.probe.as_dvec3();
    let mut chart = scene(area, "(A) path; red dots: ticks of second order", subject, &view, &[probe])?;
    for (stretch, ink) in passage.stretches().into_iter().zip([BLUE_INK, GREEN_INK, BLUE_INK]) {
        let line: Vec<_> = stretch.iter().map(|sample| view.seen(sample.point)).collect();
        chart.draw_series([PathElement::new(line, ink.stroke_width(THICK + 1))])?;
    }
    let ticks: Vec<_> = passage.second_order.iter().map(|point| view.seen(*point)).collect();
    chart.draw_series([PathElement::new(ticks.clone(), RED_INK.stroke_width(1))])?;
    chart.draw_series(ticks.into_iter().map(|tick| Circle::new(tick, 5, RED_INK.filled())))?;
    sight(&mut chart, &view, probe, passage.closest.point)?;
    let [_, on_border, after] = passage.stretches();
    let named = [(passage.samples.first(), "P₀"), (on_border.first(), "t₁"), (after.first(), "t₂")];
    for (sample, name) in named {
        if let Some(sample) = sample {
            dot(&mut chart, view.seen(sample.point), name, BLUE_INK, (12, 4))?;
        }
    }
    Ok(())
}

fn errors(area: &crate::drawing::Drawing<'_>, passage: &Passage) -> DrawingResult {
    let mut chart =
        axes(passage, "(C) projection errors, each over its peak", "Ψ / max |Ψ|", (-1.1, 1.25)).chart(area)?;
    mark(&mut chart, passage)?;
    for (axis, name, ink) in [(0, "Ψᵘ", BLUE_INK), (1, "Ψᵛ", RED_INK)] {
        let peak = passage.samples.iter().map(|sample| sample.errors[axis].abs()).fold(f64::MIN_POSITIVE, f64::max);
        let line = passage.samples.iter().map(|sample| (sample.time, sample.errors[axis] / peak));
        chart.draw_series(LineSeries::new(line, ink.stroke_width(THICK)))?.label(name).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::LowerRight)
}

fn axes<'a>(passage: &Passage, title: &'a str, y_label: &'a str, y: (f64, f64)) -> Axes<'a> {
    Axes { title, x: (0.0, end(passage)), y, x_label: "time, s", y_label }
}

fn end(passage: &Passage) -> f64 {
    passage.samples.last().map_or(1.0, |sample| sample.time)
}

fn mark(chart: &mut Chart<'_, '_>, passage: &Passage) -> DrawingResult {
    let times = [(passage.meets_border, " t₁"), (passage.leaves_border, " t₂"), (passage.arrives, " t₃")];
    times.into_iter().try_for_each(|(time, name)| mark_time(chart, time, name))
}

/// Where a mode holds the witness point.
const fn place(mode: BoundaryMode) -> &'static str {
    match mode {
        BoundaryMode::LowerU => "on u = 0",
        BoundaryMode::UpperU => "on u = 1",
        BoundaryMode::LowerV => "on v = 0",
        BoundaryMode::UpperV => "on v = 1",
        BoundaryMode::Interior => "interior",
        BoundaryMode::Corner => "at a corner",
    }
}

/// The modes as a staircase.
fn steps(passage: &Passage) -> Vec<(f64, f64)> {
    let number = |mode: BoundaryMode| f64::from(mode as u8);
    let pairs = passage.samples.windows(2).filter(|pair| pair[0].mode != pair[1].mode);
    let corners = pairs.flat_map(|pair| [(pair[1].time, number(pair[0].mode)), (pair[1].time, number(pair[1].mode))]);
    let first = passage.samples.first().map(|sample| (0.0, number(sample.mode)));
    let last = passage.samples.last().map(|sample| (sample.time, number(sample.mode)));
    first.into_iter().chain(corners).chain(last).collect()
}
