//! Drawing of a model: its patches as nets of lines.

use crate::drawing::{BLUE_INK, SURFACE_INK, View, draw, equal_scale};
use palpate::patch::SplinePatch;
use palpate_bake::{BakedPatch, Model};
use plotters::prelude::*;

const SIZE: (u32, u32) = (480, 360);

/// Draws a model from the front right: nets grey, the borders of its patches blue. `file` is what messages call it.
///
/// # Errors
/// A patch that cannot be baked.
pub fn draw_shape(model: &Model, file: &str) -> anyhow::Result<String> {
    let baked = BakedPatch::all(model, file)?;
    let patches: Vec<SplinePatch<'_>> = baked.iter().map(BakedPatch::to_patch).collect::<Result<_, _>>()?;
    let nets: Vec<_> = patches.iter().map(|patch| View::FRONT_RIGHT.net(patch)).collect();
    let (across, up) = equal_scale(nets.iter().flatten().flatten().copied(), (f64::from(SIZE.0), f64::from(SIZE.1)));
    draw(SIZE, |area| {
        let mut chart = ChartBuilder::on(area).margin(4).build_cartesian_2d(across, up)?;
        let mut lines = |of: &[Vec<(f64, f64)>], ink: RGBColor| -> Result<(), Box<dyn std::error::Error>> {
            for line in of {
                chart.draw_series(LineSeries::new(line.iter().copied(), ink))?;
            }
            Ok(())
        };
        // A net's first four lines are its border.
        for net in &nets {
            lines(net.get(4..).unwrap_or(&[]), SURFACE_INK)?;
        }
        for net in &nets {
            lines(net.get(..4).unwrap_or(&[]), BLUE_INK)?;
        }
        Ok(())
    })
}
