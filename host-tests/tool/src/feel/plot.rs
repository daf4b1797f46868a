//! The probe's motion under a hand that rests or slides, by frequency, beside the threshold of perception.

use super::clean::{Clean, ENCODERS, TRIED};
use super::rows::Row;
use crate::plot::{Area, Axes, Axis, Ink, Key, Mark, Svg, draw};
use palpate_sim::feel::{Deed, Spectrum, Threshold, thirds};

/// Displacements drawn, m: what lies below is not drawn.
const RANGE: [f64; 2] = [1e-10, 1e-4];
const FREQUENCIES: [f64; 2] = [20.0, 1_000.0];

/// Draws the curves of a device; not that of free air, whose vibration is the scripted hand's own.
pub fn spectra(svg: &mut Svg, area: Area, rows: &[Row], threshold: &Threshold) {
    let steady = |row: &&Row| matches!(row.script.deed, Deed::Rest | Deed::Slide | Deed::Across(None));
    let curves: Vec<(&str, &Spectrum)> =
        rows.iter().filter(steady).map(|row| (row.script.name.as_str(), &row.figures.displacement)).collect();
    of_curves(svg, area, &curves, threshold);
}

/// Displacement by third of an octave.
pub fn of_curves(svg: &mut Svg, area: Area, curves: &[(&str, &Spectrum)], threshold: &Threshold) {
    let inks = || Ink::FAMILY.into_iter().cycle();
    let named = curves.iter().zip(inks()).map(|((name, _), ink)| (*name, ink, Mark::Line));
    let keys: Vec<Key<'_>> =
        [("people feel what lies above", Ink::Text, Mark::Dashed)].into_iter().chain(named).collect();
    let axes = Axes {
        title: "",
        x: Axis::log("frequency, Hz, by thirds of an octave", FREQUENCIES),
        y: Axis::log("peak displacement of the probe, µm", RANGE.map(|metres| metres * 1e6)),
        keys: &keys,
    };
    let mut chart = axes.on(svg, area);
    let limit = (0..=100).map(|index| {
        let frequency = FREQUENCIES[0] * (FREQUENCIES[1] / FREQUENCIES[0]).powf(f64::from(index) / 100.0);
        (frequency, threshold.at(frequency) * 1e6)
    });
    chart.dashed(Ink::Text, 2.0, limit);
    for ((_, spectrum), ink) in curves.iter().zip(inks()) {
        let points = thirds(spectrum, threshold).into_iter().map(|[frequency, level]| {
            let displacement = threshold.at(frequency) * 10_f64.powf(level / 20.0);
            (frequency, displacement.clamp(RANGE[0], RANGE[1]) * 1e6)
        });
        chart.line(ink, 2.0, points);
    }
}

/// The maximum clean stiffness by rate, a panel a device and a curve an encoder, as SVG text.
pub fn clean(all: &[(&str, Vec<Clean>)]) -> String {
    let columns = all.len().clamp(1, 3);
    let lines = all.len().div_ceil(columns).max(1);
    let names = ENCODERS.map(|finer| format!("counts 1/{finer} as wide"));
    let inks = [Ink::Red, Ink::Blue, Ink::Green];
    let keys: Vec<Key<'_>> = names.iter().zip(inks).map(|(name, ink)| (name.as_str(), ink, Mark::Line)).collect();
    draw(300.0 * columns as f64, 340.0 * lines as f64, |svg, area| {
        for (panel, (name, points)) in area.split(lines, columns).into_iter().zip(all) {
            let axes = Axes {
                title: name,
                x: Axis::log("servo rate, kHz", [0.9, 11.0]),
                y: Axis::log("clean stiffness, N/m", [TRIED[0] * 0.9, TRIED[1] * 1.1]),
                keys: &keys,
            };
            let mut chart = axes.on(svg, panel);
            for ((finer, ink), width) in ENCODERS.into_iter().zip(inks).zip([3.0, 2.0, 1.0]) {
                // A wall of which not even the softest is clean is drawn on the lower edge.
                let curve = points.iter().filter(|point| point.finer == finer);
                let curve = curve.map(|point| (f64::from(point.rate) / 1e3, point.clean.max(TRIED[0] * 0.9)));
                let curve: Vec<(f64, f64)> = curve.collect();
                chart.line(ink, width, curve.iter().copied());
                chart.dots(ink, 3.0, curve);
            }
        }
    })
}
