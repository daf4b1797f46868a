//! The plot: maximum stiffness against damping, one panel a rate, one curve a delay, the passive bound dashed.

use crate::plot::{Axes, Axis, FIGURE, Ink, Key, Mark, draw};
use palpate_sim::zwidth::{Limit, Slice};

/// Where a damping of zero is drawn on the logarithmic axis, N·s/m.
const ZERO: f64 = 0.003;

/// A sweep as SVG.
pub fn plot(slice: &Slice, limits: &[Limit]) -> String {
    let mut rates: Vec<f64> = limits.iter().map(|limit| limit.rate).collect();
    rates.dedup();
    let mut delays: Vec<f64> = limits.iter().map(|limit| limit.delay_periods).collect();
    delays.dedup();
    delays.truncate(super::DELAYS.len());
    let names: Vec<String> = delays.iter().map(|delay| format!("delay {delay} T")).collect();
    let named = names.iter().zip(Ink::FAMILY).map(|(name, ink)| (name.as_str(), ink, Mark::Line));
    let keys: Vec<Key<'_>> = named.chain([("passive", Ink::Text, Mark::Dashed)]).collect();
    draw(FIGURE, 360.0 * rates.len() as f64, |svg, area| {
        for (panel, rate) in area.split(rates.len(), 1).into_iter().zip(rates) {
            let title = format!("{}, {} kHz", slice.name, rate / 1_000.0);
            let x = Axis::log("damping of the wall, N·s/m (left edge: none)", [ZERO, 200.0]);
            let y = Axis::log("maximum stiffness, N/m", [1.0, 100_000.0]);
            let mut chart = Axes { title: &title, x, y, keys: &keys }.on(svg, panel);
            for (delay, ink) in delays.iter().zip(Ink::FAMILY) {
                let curve = |value: fn(&Limit) -> f64| -> Vec<(f64, f64)> {
                    let here =
                        |limit: &&Limit| limit.rate == rate && limit.delay_periods == *delay && value(limit) >= 1.0;
                    limits.iter().filter(here).map(|limit| (limit.damping.max(ZERO), value(limit))).collect()
                };
                let simulated = curve(|limit| limit.simulated);
                chart.line(ink, 2.0, simulated.iter().copied());
                chart.dots(ink, 3.0, simulated);
                // To its end at B = b, where nothing is left.
                let mut passive = curve(|limit| limit.passive);
                if let Some((_, stiffness)) = passive.last().copied()
                    && slice.viscous > ZERO
                {
                    passive.push((slice.viscous, (stiffness * 0.01).max(1.0)));
                }
                chart.dashed(ink, 2.0, passive);
            }
        }
    })
}
