//! Drawing of a model: its patches as nets of lines.

use crate::plot::{Chart, Ink, View, draw};
use palpate::patch::SplinePatch;
use palpate_bake::{BakedPatch, Model};

const SIZE: (f64, f64) = (480.0, 360.0);

/// Draws a model from the front right: nets grey, the borders of its patches blue. `file` is what messages call it.
///
/// # Errors
/// A patch that cannot be baked.
pub fn draw_shape(model: &Model, file: &str) -> anyhow::Result<String> {
    let baked = BakedPatch::all(model, file)?;
    let patches: Vec<SplinePatch<'_>> = baked.iter().map(BakedPatch::to_patch).collect::<Result<_, _>>()?;
    let nets: Vec<_> = patches.iter().map(|patch| View::FRONT_RIGHT.net(patch)).collect();
    let all: Vec<_> = nets.iter().flatten().flatten().copied().collect();
    // A net's first four lines are its border.
    let (borders, nets): (Vec<_>, Vec<_>) = nets
        .into_iter()
        .map(|mut net| {
            let inner = net.split_off(4.min(net.len()));
            (net, inner)
        })
        .unzip();
    Ok(draw(SIZE.0, SIZE.1, |svg, area| {
        let mut chart = Chart::scene(svg, area, "", &[], all);
        chart.lines(Ink::Grey, 0.8, nets.into_iter().flatten());
        chart.lines(Ink::Blue, 1.0, borders.into_iter().flatten());
    }))
}
