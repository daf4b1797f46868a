//! The plot: maximum stiffness against damping, one panel a rate, one curve a delay, the passive bound dashed.

use palpate_sim::zwidth::{Limit, Slice};
use plotters::prelude::*;
use std::path::Path;

/// Where a damping of zero is drawn on the logarithmic axis, N·s/m.
const ZERO: f64 = 0.003;

/// Writes the plot of a sweep as SVG.
///
/// # Errors
/// An error of the file system or the drawing.
pub fn plot(path: &Path, slice: &Slice, limits: &[Limit]) -> anyhow::Result<()> {
    let mut rates: Vec<f64> = limits.iter().map(|limit| limit.rate).collect();
    rates.dedup();
    let area = SVGBackend::new(path, (1_100, 200 + 400 * (rates.len() as u32).div_ceil(2))).into_drawing_area();
    area.fill(&WHITE)?;
    let title = format!("Z-width of {}: simulated (solid) and passive (dashed)", slice.name);
    let area = area.titled(&title, ("sans-serif", 22))?;
    let panels = area.split_evenly((rates.len().div_ceil(2), rates.len().min(2)));
    for (panel, rate) in panels.iter().zip(rates) {
        let mut chart = ChartBuilder::on(panel)
            .caption(format!("{} kHz", rate / 1_000.0), ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(62)
            .build_cartesian_2d((ZERO..200.0).log_scale(), (1.0..100_000.0).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("damping of the wall, N·s/m (left edge: none)")
            .y_desc("maximum stiffness, N/m")
            .light_line_style(WHITE)
            .draw()?;
        let mut delays: Vec<f64> = limits.iter().map(|limit| limit.delay_periods).collect();
        delays.dedup();
        delays.truncate(super::DELAYS.len());
        for (index, delay) in delays.into_iter().enumerate() {
            let colour = Palette99::pick(index).to_rgba();
            let curve = |value: fn(&Limit) -> f64| -> Vec<(f64, f64)> {
                let here = |limit: &&Limit| limit.rate == rate && limit.delay_periods == delay && value(limit) >= 1.0;
                limits.iter().filter(here).map(|limit| (limit.damping.max(ZERO), value(limit))).collect()
            };
            let simulated = curve(|limit| limit.simulated);
            chart
                .draw_series(LineSeries::new(simulated.clone(), colour.stroke_width(2)))?
                .label(format!("delay {delay} T"))
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2)));
            chart.draw_series(simulated.into_iter().map(|point| Circle::new(point, 3, colour.filled())))?;
            // To its end at B = b, where nothing is left.
            let mut passive = curve(|limit| limit.passive);
            if let Some((_, stiffness)) = passive.last().copied()
                && slice.viscous > ZERO
            {
                passive.push((slice.viscous, (stiffness * 0.01).max(1.0)));
            }
            chart.draw_series(DashedLineSeries::new(passive, 6, 4, colour.stroke_width(2)))?;
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::LowerRight)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
    }
    area.present()?;
    Ok(())
}
