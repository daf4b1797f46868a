//! The smooth path of the track on Table I.

use glam::DVec3;
use palpate_bake::NurbsPatch;
use palpate_truth::oracle::OraclePoint;
use std::f64::consts::TAU;

/// The path swings this far beyond the middle of the patch, in parameters: past every border, where the closest point
/// rests on it.
const SWING: f64 = 0.52;
/// Heights over the surface between which the probe rises and sinks, in sizes of the patch.
const HEIGHTS: [f64; 2] = [0.005, 0.1];

/// Probes over a Lissajous figure in the parameters; beyond a border they go on along the tangent.
pub fn probes(patch: &NurbsPatch, rows: usize) -> impl Iterator<Item = DVec3> {
    let size = patch.size();
    (0..rows).map(move |row| {
        let time = row as f64 / rows as f64;
        let swing = |turns: f64, phase: f64| (TAU * (turns * time + phase)).sin();
        let asked = [0.5 + SWING * swing(2.0, 0.1), 0.5 + SWING * swing(3.0, 0.0)];
        let [u, v] = asked.map(|parameter| parameter.clamp(0.0, 1.0));
        let surface = OraclePoint::evaluate(patch, u, v);
        let beyond = surface.tangent_u * (asked[0] - u) + surface.tangent_v * (asked[1] - v);
        let height = 0.5 * (HEIGHTS[0] + HEIGHTS[1]) + 0.5 * (HEIGHTS[1] - HEIGHTS[0]) * swing(5.0, 0.25);
        surface.point + beyond + surface.normal(patch.flip) * (height * size)
    })
}
