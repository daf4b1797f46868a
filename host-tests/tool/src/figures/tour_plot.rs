//! Figures 3 and 9 as pictures.

use super::page::{Axes, THICK, THIN, dot, font, key, legend, page};
use super::tour::{ROUND, Sample, Slice, Touring};
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, RED_INK, SURFACE_INK, TEXT_INK, View, equal_scale};
use palpate::body::Feature;
use plotters::element::PathElement;
use plotters::prelude::*;

/// Ticks between the lines from probe to witness point.
const SNAPSHOT: usize = 40;

/// Pale inks for faces, in their order and then again.
const FACE_INKS: [RGBColor; 6] = [
    RGBColor(255, 214, 165),
    RGBColor(202, 230, 184),
    RGBColor(187, 216, 247),
    RGBColor(248, 199, 204),
    RGBColor(217, 204, 242),
    RGBColor(246, 238, 172),
];
const EDGE_INKS: [RGBColor; 2] = [RGBColor(150, 160, 172), RGBColor(124, 135, 148)];
const VERTEX_INKS: [RGBColor; 2] = [RGBColor(72, 79, 88), RGBColor(98, 106, 116)];

fn ink(feature: Feature) -> RGBColor {
    let pick = |inks: &[RGBColor], index: u16| inks[usize::from(index) % inks.len()];
    match feature {
        Feature::Face(index) => pick(&FACE_INKS, index),
        Feature::Edge(index) => pick(&EDGE_INKS, index),
        Feature::Vertex(index) => pick(&VERTEX_INKS, index),
    }
}

/// Figure 9: the way around the body, and `u`, `v` and the active feature over time.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_tour(touring: &Touring, samples: &[Sample]) -> anyhow::Result<String> {
    page((1000, 900), |area| {
        let (upper, lower) = area.split_vertically(1080);
        around(&upper, touring, samples)?;
        over_time(&lower, touring, samples)
    })
}

fn around(area: &Drawing<'_>, touring: &Touring, samples: &[Sample]) -> DrawingResult {
    let area = area.titled("(A) P and Q around the body", font(super::page::TITLE))?;
    let view = View { turn: -0.55, ..View::FRONT_RIGHT };
    let nets: Vec<_> = touring.body.faces().iter().flat_map(|face| view.net(&face.patch)).collect();
    let path =
        |point: fn(&Sample) -> glam::DVec3| samples.iter().map(|sample| view.seen(point(sample))).collect::<Vec<_>>();
    let probes = path(|sample| sample.probe);
    let (width, height) = area.dim_in_pixel();
    let all = nets.iter().flatten().chain(&probes).copied();
    let (x, y) = equal_scale(all, (f64::from(width), f64::from(height)));
    let mut chart = ChartBuilder::on(&area).build_cartesian_2d(x, y)?;
    chart.draw_series(nets.into_iter().map(|line| PathElement::new(line, SURFACE_INK.stroke_width(1))))?;
    let lines = samples.iter().step_by(SNAPSHOT);
    let lines = lines.map(|sample| vec![view.seen(sample.witness), view.seen(sample.probe)]);
    chart.draw_series(lines.map(|line| PathElement::new(line, SURFACE_INK.stroke_width(THIN))))?;
    chart.draw_series([PathElement::new(probes, RED_INK.stroke_width(THICK))])?;
    chart.draw_series([PathElement::new(path(|sample| sample.witness), BLUE_INK.stroke_width(THICK))])?;
    if let [first, ..] = samples {
        dot(&mut chart, view.seen(first.witness), "P₀", BLUE_INK, (12, 4))?;
        dot(&mut chart, view.seen(first.probe), "Q", RED_INK, (-34, -34))?;
    }
    Ok(())
}

fn over_time(area: &Drawing<'_>, touring: &Touring, samples: &[Sample]) -> DrawingResult {
    let title = "(B) u, v over the active feature (faces coloured, edges grey, vertices dark)";
    let axes = Axes { title, x: (0.0, ROUND), y: (0.0, 1.12), x_label: "time, s", y_label: "u, v" };
    let mut chart = axes.chart(area)?;
    let stretches = || samples.chunk_by(|a, b| a.feature == b.feature);
    let end = |stretch: &[Sample]| stretch.last().map_or(0.0, |sample| sample.time + super::tour::PERIOD);
    let fill = |stretch: &[Sample]| {
        Rectangle::new([(stretch[0].time, 0.0), (end(stretch), 1.12)], ink(stretch[0].feature).filled())
    };
    chart.draw_series(stretches().map(fill))?;
    for stretch in stretches() {
        if let Feature::Face(face) = stretch[0].feature {
            let middle = 0.5 * (stretch[0].time + end(stretch));
            let style = font(super::page::LABEL - 6).pos(plotters::style::text_anchor::Pos::new(
                plotters::style::text_anchor::HPos::Center,
                plotters::style::text_anchor::VPos::Top,
            ));
            if end(stretch) - stretch[0].time > 0.06 * ROUND {
                chart.draw_series([Text::new(touring.face_name(face), (middle, 1.1), style)])?;
            }
        }
    }
    for (axis, name, line_ink) in [(0, "u", BLUE_INK), (1, "v", RED_INK)] {
        let mut named = false;
        for stretch in stretches().filter(|stretch| matches!(stretch[0].feature, Feature::Face(_))) {
            let line: Vec<_> = stretch.iter().map(|sample| (sample.time, f64::from(sample.parameters[axis]))).collect();
            let drawn = chart.draw_series([PathElement::new(line, line_ink.stroke_width(THICK))])?;
            if !named {
                drawn.label(name).legend(key(line_ink));
                named = true;
            }
        }
    }
    legend(&mut chart, SeriesLabelPosition::LowerRight)
}

/// Figure 3: slices through the Voronoi regions.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw_regions(slices: &[Slice; 2]) -> anyhow::Result<String> {
    page((1000, 520), |area| {
        let panels = area.split_evenly((1, 2));
        slices.iter().zip(&panels).try_for_each(|(slice, panel)| draw_slice(panel, slice))
    })
}

fn draw_slice(area: &Drawing<'_>, slice: &Slice) -> DrawingResult {
    let [x, y] = slice.ranges.map(|[low, high]| (1e3 * low, 1e3 * high));
    let axes = Axes { title: slice.title, x, y, x_label: slice.axes[0], y_label: slice.axes[1] };
    let mut chart = axes.chart(area)?;
    let count = slice.cells.len() as f64;
    let place = |(low, high): (f64, f64), index: usize| low + (high - low) * index as f64 / count;
    for (row, cells) in slice.cells.iter().enumerate() {
        let mut column = 0;
        // One rectangle a run of equal cells.
        for run in cells.chunk_by(|a, b| a == b) {
            let corners = [(place(x, column), place(y, row)), (place(x, column + run.len()), place(y, row + 1))];
            let fill = run[0].map_or(WHITE, ink);
            chart.draw_series([Rectangle::new(corners, fill.filled())])?;
            column += run.len();
        }
    }
    let inside = Text::new("body", (0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1)), font(super::page::LABEL).color(&TEXT_INK));
    chart.draw_series([inside])?;
    Ok(())
}
