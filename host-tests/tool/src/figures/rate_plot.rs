//! Local rate and lag of the paper's law and of that of second order.

use super::page::{Axes, THIN, key, legend, page};
use super::rate::{Lag, Rate};
use crate::drawing::{BLUE_INK, Drawing, DrawingResult, GREEN_INK, RED_INK, TEXT_INK};
use plotters::element::PathElement;
use plotters::prelude::*;

/// Less is drawn as this: single precision holds parameters to 6e-8.
const LEAST: f64 = 1e-8;
const INKS: [RGBColor; 4] = [BLUE_INK, GREEN_INK, RED_INK, TEXT_INK];

/// The figure, as SVG text.
///
/// # Errors
/// A panel that cannot be drawn.
pub fn draw(rates: &[Rate], lags: &[Lag]) -> anyhow::Result<String> {
    page((1000, 420), |area| {
        let panels = area.split_evenly((1, 2));
        arriving(&panels[0], rates)?;
        following(&panels[1], lags)
    })
}

/// Second order as lines with dots, the paper's law as thin lines.
fn arriving(area: &Drawing<'_>, rates: &[Rate]) -> DrawingResult {
    let title = "(A) arriving: dots second order, thin the paper's law";
    let ticks = rates.first().map_or(1, |rate| rate.errors[0].len() - 1);
    let y = (LEAST.log10(), 0.0);
    let mut chart =
        Axes { title, x: (0.0, ticks as f64), y, x_label: "tick", y_label: "log₁₀ ‖x − x*‖" }.chart(area)?;
    for (Rate { place, errors }, ink) in rates.iter().zip(INKS) {
        let [first, second] = [0, 1].map(|law| {
            let point = |(tick, error): (usize, &f64)| (tick as f64, error.max(LEAST).log10());
            errors[law].iter().enumerate().map(point).collect::<Vec<_>>()
        });
        chart.draw_series([PathElement::new(first, ink.stroke_width(1))])?;
        chart.draw_series(second.iter().map(|at| Circle::new(*at, 5, ink.filled())))?;
        chart.draw_series([PathElement::new(second, ink.stroke_width(THIN + 1))])?.label(*place).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::UpperRight)
}

fn following(area: &Drawing<'_>, lags: &[Lag]) -> DrawingResult {
    let title = "(B) following: greatest lag at 4 kHz";
    let [x_label, y_label] = ["log₁₀ speed, m/s", "log₁₀ ‖x − x*‖"];
    let mut chart = Axes { title, x: (-2.0, 0.0), y: (LEAST.log10(), 0.0), x_label, y_label }.chart(area)?;
    for (law, name, ink) in [(0, "the paper's law, certified gain", GREEN_INK), (1, "second order", BLUE_INK)] {
        let line: Vec<_> = lags.iter().map(|lag| (lag.speed.log10(), lag.errors[law].max(LEAST).log10())).collect();
        chart.draw_series(line.iter().map(|at| Circle::new(*at, 5, ink.filled())))?;
        chart.draw_series([PathElement::new(line, ink.stroke_width(THIN + 1))])?.label(name).legend(key(ink));
    }
    legend(&mut chart, SeriesLabelPosition::UpperLeft)
}
