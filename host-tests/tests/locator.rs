//! The locator's lists against the oracle.

use palpate_host::bake::locator::{self, LocatorOptions, Seams, StoredSurface};
use palpate_host::bake::{BakedPatch, Model};
use palpate_host::locating;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

#[test]
#[ignore = "a tool"]
fn tune() -> Result<(), Box<dyn Error>> {
    let text = |name: &str, default: &str| std::env::var(name).unwrap_or_else(|_| default.to_owned());
    let file = text("MODEL", "capped_box.toml");
    let model = Model::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(&file))?;
    let patches = model.patches.iter().map(BakedPatch::without_shape).collect::<Result<Vec<_>, _>>()?;
    let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
    let size = 0.06;
    let seams = Seams::find(&surfaces, 1e-6 * size);
    println!("edges {:?} vertices {}", seams.edges.iter().map(Vec::len).collect::<Vec<_>>(), seams.vertices.len());
    let creases = vec![[vec![], vec![]]; patches.len()];
    let default = LocatorOptions::default();
    let options = LocatorOptions {
        entries: text("ENTRIES", "4").parse()?,
        depth: text("DEPTH", "5").parse()?,
        fineness: text("FINE", "0.5").parse()?,
        tolerance: text("TOL", "1e-4").parse()?,
        deep_entries: text("DEEP", "6").parse()?,
        ..default
    };
    let start = Instant::now();
    let progress = |depth, cells| println!("depth {depth}: {cells} cells, {:?}", start.elapsed());
    let baked = locator::bake(&patches, seams, &creases, &options, &progress).ok_or("no bake")?;
    println!(
        "{}\nnodes {} entries {} fits {} in {:?}",
        baked.report,
        baked.nodes.len(),
        baked.entries.len(),
        baked.report.fits,
        start.elapsed()
    );
    let start = Instant::now();
    let tolerance = if file.starts_with("teapot") { 1e-4 } else { 1e-5 };
    let checked = locating::check(&model, &surfaces, &baked, text("PROBES", "20000").parse()?, 0.2, tolerance);
    println!(
        "{} probes, {} inside, {} misses, worst {:e}, evaluations {}, {:?}",
        checked.probes,
        checked.inside,
        checked.misses.len(),
        checked.worst,
        checked.evaluations,
        start.elapsed()
    );
    for miss in checked.misses.iter().take(8) {
        println!("{miss:?}");
    }
    Ok(())
}
