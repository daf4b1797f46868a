//! Figure 7 as the paper draws it.

use super::attraction::{Basin, Run, STARTS, Target, start_grid};
use super::attraction::{Comparison, DRAWN};
use super::page::{Axes, THICK, THIN, dot, page, scene, sight, view_of};
use super::subject::Subject;
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, RED_INK, View};
use plotters::element::PathElement;
use plotters::prelude::*;

/// Does not converge.
const DARK: RGBColor = RGBColor(87, 96, 106);
/// Number of points of the surface that a drawn step passes through.
const STEP_POINTS: usize = 16;
/// Maximum number of steps of a path that is drawn with dots.
const MOST_DOTS: usize = 60;

/// The figure, as SVG text.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw(subject: &Subject, comparison: &Comparison) -> anyhow::Result<String> {
    page((900, 1640), |area| {
        let panels = area.split_evenly((DRAWN.len(), 2));
        let target = &comparison.targets[comparison.drawn];
        let view = view_of(subject, &[comparison.start, target.closest.parameters]);
        for (row, contender) in DRAWN.into_iter().enumerate() {
            let name = contender.title();
            let letters = [["A", "B"], ["C", "D"], ["E", "F"], ["G", "H"]][row];
            let (run, basin) = (&comparison.runs[row], &comparison.basins[row]);
            path(&panels[2 * row], &format!("({}) {name}", letters[0]), subject, &view, target, run)?;
            let share = 100.0 * basin.share();
            square(&panels[2 * row + 1], &format!("({}) converge from {share:.0} %", letters[1]), target, basin)?;
        }
        Ok(())
    })
}

fn path(area: &Drawing<'_>, title: &str, subject: &Subject, view: &View, target: &Target, run: &Run) -> DrawingResult {
    let probe = target.probe.as_dvec3();
    let mut chart = scene(area, title, subject, view, &[probe])?;
    let seen = |at: [f64; 2]| view.seen(subject.at(at).0.point);
    let mut line = vec![seen(run.path[0])];
    for pair in run.path.windows(2) {
        let inside = fraction_inside(pair[0], pair[1]);
        let between = |step: usize| inside * step as f64 / STEP_POINTS as f64;
        line.extend((1..=STEP_POINTS).map(|step| {
            seen([0, 1].map(|i| (pair[0][i] + between(step) * (pair[1][i] - pair[0][i])).clamp(0.0, 1.0)))
        }));
    }
    // What lies within a drawn pixel or so of the last point shows nothing.
    let mut thinned: Vec<(f64, f64)> = Vec::new();
    for point in line {
        if thinned.last().is_none_or(|last| (last.0 - point.0).hypot(last.1 - point.1) > 1e-3 * subject.size * 1e3) {
            thinned.push(point);
        }
    }
    let end = thinned.last().copied().unwrap_or_default();
    chart.draw_series([PathElement::new(thinned, BLUE_INK.stroke_width(THICK))])?;
    let steps = run.path.iter().take(run.path.len() - usize::from(run.left)).take(MOST_DOTS);
    chart.draw_series(steps.map(|at| Circle::new(seen(*at), 5, BLUE_INK.filled())))?;
    sight(&mut chart, view, probe, target.closest.point)?;
    dot(&mut chart, seen(run.path[0]), "P₀", BLUE_INK, (-38, -34))?;
    if run.left {
        chart.draw_series([EmptyElement::at(end) + Cross::new((0, 0), 14, BLUE_INK.stroke_width(THICK))])?;
        dot(&mut chart, end, "leaves", BLUE_INK, (18, -8))?;
    }
    Ok(())
}

/// How much of a step lies in the square.
fn fraction_inside(from: [f64; 2], to: [f64; 2]) -> f64 {
    (0..2).fold(1.0, |fraction: f64, i| {
        let change = to[i] - from[i];
        let room = if change > 0.0 { 1.0 - from[i] } else { -from[i] };
        if change == 0.0 { fraction } else { fraction.min(room / change) }
    })
}

fn square(area: &Drawing<'_>, title: &str, target: &Target, basin: &Basin) -> DrawingResult {
    let half = 0.5 / (STARTS - 1) as f64;
    let range = (-half, 1.0 + half);
    let mut chart = Axes { title, x: range, y: range, x_label: "u", y_label: "v" }.chart(area)?;
    let marks: Vec<_> = start_grid().zip(basin.starts.iter().map(|(found, _)| *found)).collect();
    // A column's neighbouring cells that fail are one rectangle.
    for column in marks.chunks(STARTS) {
        for run in column.chunk_by(|a, b| a.1 == b.1).filter(|run| !run[0].1) {
            let ([u, low], [_, high]) = (run[0].0, run[run.len() - 1].0);
            // A little wider, so that no seam shows between columns.
            let corners = [(u - 1.05 * half, low - half), (u + 1.05 * half, high + half)];
            chart.draw_series([Rectangle::new(corners, DARK.filled())])?;
        }
    }
    for ([u, v], found) in marks {
        if found {
            chart.draw_series([Circle::new((u, v), 8, BLUE_INK.stroke_width(THIN))])?;
        } else {
            chart.draw_series([EmptyElement::at((u, v)) + Cross::new((0, 0), 7, WHITE.stroke_width(THIN))])?;
        }
    }
    let [u, v] = target.closest.parameters;
    chart.draw_series([Circle::new((u, v), 9, RED_INK.filled())])?;
    Ok(())
}
