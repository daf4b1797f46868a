//! The race as a picture: instructions a query on a logarithmic scale, with the share of misses.

use super::judge::Score;
use super::table::{CALL, OURS, described, grouped};
use crate::plot::{Anchor, Area, Axes, Axis, FIGURE, Ink, Mark, Svg, draw as svg};

/// Height of a line, and of what stands above and below the lines of a panel, px.
const LINE: f64 = 40.0;
const BESIDES: f64 = 126.0;
/// The scale: instructions.
const SCALE: [f64; 2] = [100.0, 1e9];

/// One panel a scene, as SVG text.
pub fn draw(scenes: &[Vec<Score>]) -> String {
    let panels: Vec<Vec<&Score>> =
        scenes.iter().map(|scores| scores.iter().filter(|score| score.contestant != CALL).collect()).collect();
    let height = |panel: &Vec<&Score>| BESIDES + LINE * panel.len() as f64;
    svg(FIGURE, panels.iter().map(height).sum(), |svg, mut area| {
        for panel in &panels {
            let (here, below) = area.split_at(height(panel));
            draw_panel(svg, here, panel);
            area = below;
        }
    })
}

fn draw_panel(svg: &mut Svg, area: Area, scores: &[&Score]) {
    let Some(first) = scores.first() else { return };
    let title = format!("{} {}, {} queries; share of misses", first.model, first.task.name(), first.queries);
    // A phone has no room for words beside a bar: they stand over it.
    let names = vec![String::new(); scores.len()];
    let keys = [
        ("palpate", Ink::Blue, Mark::Fill),
        ("Newton", Ink::Green, Mark::Fill),
        ("others", Ink::Red, Mark::Fill),
        ("to 99 % of the queries", Ink::Text, Mark::Line),
    ];
    let x = Axis::log("instructions a query, median", SCALE);
    let mut chart = Axes { title: &title, x, y: Axis::named("", &names), keys: &keys }.on(svg, area);
    // Upwards, so the first comes last.
    for (line, score) in scores.iter().rev().enumerate() {
        let middle = line as f64;
        let ink = match score.contestant.as_str() {
            ours if ours.starts_with(OURS) => Ink::Blue,
            newton if newton.starts_with("newton") => Ink::Green,
            _ => Ink::Red,
        };
        let [median, most] =
            [score.instructions.median, score.instructions.most].map(|count| (count as f64).max(SCALE[0]));
        let bar = middle - 0.2;
        chart.fill(ink, [[(SCALE[0], bar - 0.15), (median, bar + 0.15)]]);
        chart.line(ink, 2.0, [(median, bar), (most, bar)]);
        let misses = 100.0 * score.misses as f64 / score.queries as f64;
        let misses = if score.misses == 0 { "no miss".to_owned() } else { format!("{misses:.1} % missed") };
        let label = format!("{}: {}, {misses}", described(score), grouped(score.instructions.median));
        chart.words((SCALE[0], middle + 0.22), (4.0, 0.0), Anchor::Start, Ink::Text, &label);
    }
}
