//! The sheets around the active feature are the border of its Voronoi region.

use crate::browser::Page;
use anyhow::{Context as _, ensure};

/// How far out along a ray is looked back at the body, in its sizes.
const OUT: f64 = 0.3;
/// A place of a sheet is rounded to `f32`, and so is its distance: a few 6e-8 of twice the size. The search that looks
/// back ends where no step is proved to bring it nearer.
const NEAR: f64 = 2e-6;

/// From a place on a sheet of a convex body, the closest point of all is where its ray begins: what is nearer lies in
/// no region.
#[test]
fn what_lies_on_a_sheet_is_closest_to_where_its_ray_begins() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    for body in ["capped_box", "rounded_cylinder"] {
        page.ask(&format!("palpate.take({body:?})"))?;
        let about = page.ask("palpate.about()")?;
        let size = about["size"].as_f64().context("size")?;
        for (kind, count) in ["faces", "edges", "vertices"].iter().enumerate() {
            let features = about[*count].as_u64().context("how many features")?;
            let (mut rays, mut worst) = (0, 0.0_f64);
            for index in 0..features {
                let found = page.ask(&format!(
                    "(() => {{ const rays = palpate.sheets({code}), far = {far}; const off = []; \
                     for (let at = 0; at < rays.length; at += 6) {{ \
                     const place = [0, 1, 2].map((axis) => rays[at + axis] + far * rays[at + 3 + axis]); \
                     off.push(Math.abs(palpate.closest(place).distance - far)); }} return off; }})()",
                    code = (kind << 14) as u64 + index,
                    far = OUT * size,
                ))?;
                let off: Vec<f64> = serde_json::from_value(found)?;
                rays += off.len();
                worst = off.iter().fold(worst, |worst, off| worst.max(off / size));
            }
            println!("{body}: {features} {count}, {rays} rays: {worst:.1e} sizes nearer at most");
            ensure!(worst < NEAR, "{body}: {count}: {worst}");
            ensure!(rays as u64 >= features, "{body}: {count} without a sheet");
        }
    }
    Ok(())
}

#[test]
fn the_sheet_that_is_shown_is_that_of_the_feature_the_stylus_is_over() -> anyhow::Result<()> {
    let page = Page::held_still()?;
    page.ask("palpate.take('capped_box')")?;
    let about = page.ask("palpate.about()")?;
    let size = about["size"].as_f64().context("size")?;
    let middle: Vec<f64> = serde_json::from_value(about["middle"].clone())?;
    let mut kinds = [0; 3];
    for step in 0..24_u32 {
        let angle = 0.9 * f64::from(step);
        let place = [angle.cos(), angle.sin(), 1.4 * (1.7 * angle).sin()];
        let at = [0, 1, 2].map(|axis| middle[axis] + 0.8 * size * place[axis]);
        page.ask(&format!("palpate.hold({at:?}, 300)"))?;
        let state = page.ask("palpate.state()")?;
        ensure!(state["region"] == state["feature"], "{state}");
        kinds[state["feature"].as_u64().context("no feature")? as usize >> 14] += 1;
    }
    ensure!(kinds.iter().all(|kind| *kind > 0), "faces, edges and vertices: {kinds:?}");
    Ok(())
}
