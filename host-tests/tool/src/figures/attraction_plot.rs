//! Figure 7 as the paper draws it.

use super::attraction::{Basin, Run, STARTS, Target, start_grid};
use super::attraction::{Comparison, DRAWN};
use super::page::{THICK, scene, sight, view_of};
use super::subject::Subject;
use crate::plot::{Anchor, Area, Axes, Axis, FIGURE, Ink, Mark, Svg, View, draw as svg};

/// Number of points of the surface that a drawn step passes through.
const STEP_POINTS: usize = 16;
/// Maximum number of steps of a path that is drawn with dots.
const MOST_DOTS: usize = 60;

/// The figure, as SVG text.
pub fn draw(subject: &Subject, comparison: &Comparison) -> String {
    svg(FIGURE, 3_200.0, |svg, area| {
        let panels = area.split(2 * DRAWN.len(), 1);
        let target = &comparison.targets[comparison.drawn];
        let view = view_of(subject, &[comparison.start, target.closest.parameters]);
        for (row, contender) in DRAWN.into_iter().enumerate() {
            let name = contender.title();
            let letters = [["A", "B"], ["C", "D"], ["E", "F"], ["G", "H"]][row];
            let (run, basin) = (&comparison.runs[row], &comparison.basins[row]);
            path(svg, panels[2 * row], &format!("({}) {name}", letters[0]), subject, &view, target, run);
            let share = 100.0 * basin.share();
            square(svg, panels[2 * row + 1], &format!("({}) converge from {share:.0} %", letters[1]), target, basin);
        }
    })
}

fn path(svg: &mut Svg, area: Area, title: &str, subject: &Subject, view: &View, target: &Target, run: &Run) {
    let probe = target.probe.as_dvec3();
    let mut chart = scene(svg, area, (title, &[]), subject, view, &[probe]);
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
    chart.line(Ink::Blue, THICK, thinned);
    let steps = run.path.iter().take(run.path.len() - usize::from(run.left)).take(MOST_DOTS);
    chart.dots(Ink::Blue, 2.5, steps.map(|at| seen(*at)));
    sight(&mut chart, view, probe, target.closest.point);
    chart.dot(seen(run.path[0]), "P₀", Ink::Blue, (-20.0, -10.0));
    if run.left {
        chart.crosses(Ink::Blue, 6.0, [end]);
        chart.words(end, (10.0, -4.0), Anchor::Start, Ink::Blue, "leaves");
    }
}

/// How much of a step lies in the square.
fn fraction_inside(from: [f64; 2], to: [f64; 2]) -> f64 {
    (0..2).fold(1.0, |fraction: f64, i| {
        let change = to[i] - from[i];
        let room = if change > 0.0 { 1.0 - from[i] } else { -from[i] };
        if change == 0.0 { fraction } else { fraction.min(room / change) }
    })
}

fn square(svg: &mut Svg, area: Area, title: &str, target: &Target, basin: &Basin) {
    let half = 0.5 / (STARTS - 1) as f64;
    let range = [-half, 1.0 + half];
    let keys = [("arrives", Ink::Blue, Mark::Ring), ("does not", Ink::Dark, Mark::Fill), ("P*", Ink::Red, Mark::Dot)];
    let mut chart = Axes { title, x: Axis::linear("u", range), y: Axis::linear("v", range), keys: &keys }.on(svg, area);
    let marks: Vec<_> = start_grid().zip(basin.starts.iter().map(|(found, _)| *found)).collect();
    // A column's neighbouring cells that fail are one rectangle.
    for column in marks.chunks(STARTS) {
        for run in column.chunk_by(|a, b| a.1 == b.1).filter(|run| !run[0].1) {
            let ([u, low], [_, high]) = (run[0].0, run[run.len() - 1].0);
            // A little wider, so that no seam shows between columns.
            chart.fill(Ink::Dark, [[(u - 1.05 * half, low - half), (u + 1.05 * half, high + half)]]);
        }
    }
    let of = |wanted: bool| marks.iter().filter(move |(_, found)| *found == wanted).map(|([u, v], _)| (*u, *v));
    chart.rings(Ink::Blue, 4.0, of(true));
    chart.crosses(Ink::Paper, 3.0, of(false));
    let [u, v] = target.closest.parameters;
    chart.dots(Ink::Red, 4.5, [(u, v)]);
}
