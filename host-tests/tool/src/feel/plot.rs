//! The probe's motion under a hand that rests or slides, by frequency, beside the threshold of perception.

use super::clean::{Clean, ENCODERS, TRIED};
use super::rows::Row;
use crate::drawing::{BLUE_INK, GREEN_INK, RED_INK, SURFACE_INK, TEXT_INK, draw};
use palpate_sim::feel::{Deed, Spectrum, Threshold, thirds};
use plotters::prelude::*;

/// Displacements drawn, m: what lies below is not drawn.
const RANGE: [f64; 2] = [1e-10, 1e-4];
const FREQUENCIES: [f64; 2] = [20.0, 1_000.0];
const INKS: [RGBColor; 6] = [BLUE_INK, RED_INK, GREEN_INK, SURFACE_INK, RGBColor(130, 80, 223), RGBColor(188, 76, 0)];

/// The curves of a device, as SVG text.
///
/// # Errors
/// An error of the drawing.
pub fn spectra(rows: &[Row], threshold: &Threshold) -> anyhow::Result<String> {
    let steady = |row: &&Row| matches!(row.script.deed, Deed::Rest | Deed::Slide | Deed::Across(None) | Deed::Air);
    let curves: Vec<(&str, &Spectrum)> =
        rows.iter().filter(steady).map(|row| (row.script.name.as_str(), &row.figures.displacement)).collect();
    of_curves(&curves, threshold)
}

/// Displacement by third of an octave.
///
/// # Errors
/// An error of the drawing.
pub fn of_curves(curves: &[(&str, &Spectrum)], threshold: &Threshold) -> anyhow::Result<String> {
    draw((900, 460), |area| {
        area.fill(&WHITE)?;
        let mut chart =
            ChartBuilder::on(area).margin(12).x_label_area_size(42).y_label_area_size(76).build_cartesian_2d(
                (FREQUENCIES[0]..FREQUENCIES[1]).log_scale(),
                (RANGE[0] * 1e6..RANGE[1] * 1e6).log_scale(),
            )?;
        chart
            .configure_mesh()
            .x_desc("frequency, Hz, by thirds of an octave")
            .y_desc("peak displacement of the probe, µm")
            .light_line_style(WHITE)
            .draw()?;
        let limit = (0..=200).map(|index| {
            let frequency = FREQUENCIES[0] * (FREQUENCIES[1] / FREQUENCIES[0]).powf(f64::from(index) / 200.0);
            (frequency, threshold.at(frequency) * 1e6)
        });
        chart
            .draw_series(LineSeries::new(limit, TEXT_INK.stroke_width(3)))?
            .label("people feel what lies above")
            .legend(|(x, y)| PathElement::new([(x, y), (x + 18, y)], TEXT_INK.stroke_width(3)));
        for ((name, spectrum), ink) in curves.iter().zip(INKS.into_iter().cycle()) {
            let points = thirds(spectrum, threshold).into_iter().map(|[frequency, level]| {
                let displacement = threshold.at(frequency) * 10_f64.powf(level / 20.0);
                (frequency, displacement.clamp(RANGE[0], RANGE[1]) * 1e6)
            });
            chart
                .draw_series(LineSeries::new(points, ink.stroke_width(2)))?
                .label(*name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], ink.stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        Ok(())
    })
}

/// The maximum clean stiffness by rate, a panel a device and a curve an encoder, as SVG text.
///
/// # Errors
/// An error of the drawing.
pub fn clean(all: &[(&str, Vec<Clean>)]) -> anyhow::Result<String> {
    let lines = all.len().div_ceil(3) as u32;
    draw((1_080, 300 * lines.max(1)), |area| {
        area.fill(&WHITE)?;
        for (panel, (name, points)) in area.split_evenly((lines as usize, all.len().clamp(1, 3))).iter().zip(all) {
            let mut chart = ChartBuilder::on(panel)
                .caption(name, ("sans-serif", 16))
                .margin(8)
                .x_label_area_size(38)
                .y_label_area_size(64)
                .build_cartesian_2d((0.9..11.0).log_scale(), (TRIED[0] * 0.9..TRIED[1] * 1.1).log_scale())?;
            chart
                .configure_mesh()
                .x_desc("servo rate, kHz")
                .y_desc("clean stiffness, N/m")
                .light_line_style(WHITE)
                .draw()?;
            for ((finer, ink), width) in ENCODERS.into_iter().zip([RED_INK, BLUE_INK, GREEN_INK]).zip([3, 2, 1]) {
                // A wall of which not even the softest is clean is drawn on the lower edge.
                let curve = points.iter().filter(|point| point.finer == finer);
                let curve = curve.map(|point| (f64::from(point.rate) / 1e3, point.clean.max(TRIED[0] * 0.9)));
                let curve: Vec<(f64, f64)> = curve.collect();
                chart
                    .draw_series(LineSeries::new(curve.clone(), ink.stroke_width(width)))?
                    .label(format!("counts 1/{finer} as wide"))
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], ink.stroke_width(width)));
                chart.draw_series(curve.into_iter().map(|point| Circle::new(point, 3, ink.filled())))?;
            }
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::LowerRight)
                .background_style(WHITE.mix(0.8))
                .border_style(BLACK.mix(0.3))
                .draw()?;
        }
        Ok(())
    })
}
