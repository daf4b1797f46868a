//! The race as a picture: instructions a query on a logarithmic scale, with the share of misses.

use super::judge::Score;
use super::table::{CALL, OURS, described, grouped};
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, GREEN_INK, RED_INK, SURFACE_INK, TEXT_INK, draw as svg};
use plotters::element::PathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// A panel: its width, the column of names, and the height of a line.
const WIDTH: i32 = 900;
const NAMES: i32 = 260;
const LINE: i32 = 26;
/// Above and below the lines of a panel.
const HEAD: i32 = 40;
const FOOT: i32 = 34;
/// The scale: powers of ten.
const DECADES: std::ops::RangeInclusive<i32> = 2..=8;

/// One panel a scene, as SVG text.
///
/// # Errors
/// If the drawing fails.
pub fn draw(scenes: &[Vec<Score>]) -> anyhow::Result<String> {
    let panels: Vec<Vec<&Score>> =
        scenes.iter().map(|scores| scores.iter().filter(|score| score.contestant != CALL).collect()).collect();
    let height = |panel: &Vec<&Score>| HEAD + FOOT + LINE * panel.len() as i32;
    let whole: i32 = panels.iter().map(height).sum();
    svg((WIDTH as u32, whole as u32), |area| {
        area.fill(&WHITE)?;
        let mut top = 0;
        for panel in &panels {
            draw_panel(area, panel, top)?;
            top += height(panel);
        }
        Ok(())
    })
}

fn draw_panel(area: &Drawing<'_>, scores: &[&Score], top: i32) -> DrawingResult {
    let Some(first) = scores.first() else { return Ok(()) };
    let title = format!(
        "{} {}, {} queries: instructions a query, median and 99 %; share of misses",
        first.model,
        first.task.name(),
        first.queries
    );
    write(area, &title, (12, top + 18), HPos::Left, 15)?;
    let bottom = top + HEAD + LINE * scores.len() as i32;
    for decade in DECADES {
        let x = across(10_f64.powi(decade));
        area.draw(&PathElement::new([(x, top + HEAD - 4), (x, bottom)], SURFACE_INK.mix(0.4)))?;
        write(area, &grouped(10_u64.pow(decade as u32)), (x, bottom + 12), HPos::Center, 12)?;
    }
    for (line, score) in scores.iter().enumerate() {
        let middle = top + HEAD + LINE * line as i32 + LINE / 2;
        let ink = match score.contestant.as_str() {
            ours if ours.starts_with(OURS) => BLUE_INK,
            newton if newton.starts_with("newton") => GREEN_INK,
            _ => RED_INK,
        };
        let [median, most] = [score.instructions.median, score.instructions.most].map(|count| across(count as f64));
        write(area, described(score), (NAMES - 10, middle), HPos::Right, 13)?;
        area.draw(&Rectangle::new([(NAMES, middle - 7), (median, middle + 7)], ink.filled()))?;
        area.draw(&PathElement::new([(median, middle), (most, middle)], ink.stroke_width(3)))?;
        let misses = 100.0 * score.misses as f64 / score.queries as f64;
        let misses = if score.misses == 0 { "no miss".to_owned() } else { format!("{misses:.1} % missed") };
        let label = format!("{}, {misses}", grouped(score.instructions.median));
        write(area, &label, (most.max(median) + 8, middle), HPos::Left, 12)?;
    }
    Ok(())
}

fn across(count: f64) -> i32 {
    let (low, high) = (f64::from(*DECADES.start()), f64::from(*DECADES.end()));
    let share = (count.max(1.0).log10() - low) / (high - low);
    NAMES + (share.clamp(0.0, 1.0) * f64::from(WIDTH - NAMES - 40)).round() as i32
}

fn write(area: &Drawing<'_>, text: &str, at: (i32, i32), side: HPos, size: i32) -> DrawingResult {
    let style = ("sans-serif", size).into_font().color(&TEXT_INK).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style))?;
    Ok(())
}
