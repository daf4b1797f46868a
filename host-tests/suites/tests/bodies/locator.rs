//! The locator's lists against golden points and the oracle. `PALPATE_PROBES` sets the number of random probes,
//! `PALPATE_MODEL`, `PALPATE_TOLERANCE` and `PALPATE_CONVEX` which model a further run is about, and how.

use glam::DVec3;
use palpate::body::{Candidate, GRID};
use palpate_bake::locator::{self, BakedLocator, BorderSide, LocatorOptions, Seams, StoredSurface, extent};
use palpate_bake::{Axis, BakedPatch, Model};
use palpate_truth::locating::{self, Checked};
use palpate_truth::oracle::golden::{self, ClosestRow};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Of the size: a minimum of a convex body is the global one but for the rounding of its table.
const CONVEX: f64 = 1e-5;
/// Of the size: what the bake lets pass as good enough elsewhere.
const ANY: f64 = 1e-4;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

struct Subject {
    model: Model,
    patches: Vec<BakedPatch>,
    surfaces: Vec<StoredSurface>,
    seams: Seams,
    creases: Vec<[Vec<f64>; 2]>,
    size: f64,
}

impl Subject {
    fn read(file: &str) -> Result<Self, Box<dyn Error>> {
        let model = Model::read(&folder("../models").join(file))?;
        let patches = model.patches.iter().map(BakedPatch::without_shape).collect::<Result<Vec<_>, _>>()?;
        let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
        let [low, high] = extent(&surfaces);
        let size = (high - low).max_element();
        let seams = Seams::find(&surfaces, 1e-6 * size);
        let creases = model.patches.iter().map(|patch| [Axis::U, Axis::V].map(|axis| patch.creases(axis))).collect();
        Ok(Self { model, patches, surfaces, seams, creases, size })
    }

    fn bake(&self, options: &LocatorOptions) -> Result<BakedLocator, Box<dyn Error>> {
        Ok(locator::bake(&self.patches, self.seams.clone(), &self.creases, options, None, &|_, _| ())?)
    }
}

fn probes(default: usize) -> Result<usize, std::num::ParseIntError> {
    std::env::var("PALPATE_PROBES").map_or(Ok(default), |count| count.parse())
}

/// Bakes, prints what came of it and tries random probes.
fn run(
    subject: &Subject,
    options: &LocatorOptions,
    tolerance: f64,
    count: usize,
) -> Result<(BakedLocator, Checked), Box<dyn Error>> {
    let start = Instant::now();
    let baked = subject.bake(options)?;
    println!("{}: {}; {:.1?}", subject.model.name, baked.report, start.elapsed());
    let checked = locating::check(&subject.model, &subject.surfaces, &baked, count, options.inside, tolerance);
    println!(
        "{} probes, {} of them inside: {} misses, at worst {:.1e} of the size too far; {} evaluations of f64 at most",
        checked.probes,
        checked.inside,
        checked.misses.len(),
        checked.worst,
        checked.evaluations
    );
    assert!(checked.misses.is_empty(), "{:?}", &checked.misses[..checked.misses.len().min(5)]);
    Ok((baked, checked))
}

/// Every golden probe in the root cube and within the depth, in the model's unit.
fn golden_probes(subject: &Subject, baked: &BakedLocator, file: &str, tolerance: f64) -> Result<(), Box<dyn Error>> {
    let rows: Vec<ClosestRow> = golden::read(&folder("../truth/golden").join(file))?;
    let locator = baked.to_locator();
    let per_metre = subject.model.unit.per_metre();
    let mut tried = 0;
    for row in &rows {
        let probe: DVec3 = row.query() / per_metre;
        if !locator.holds(probe.as_vec3()) || row.inside == Some(1) && row.distance / per_metre > 0.2 * subject.size {
            continue;
        }
        let located = locating::locate(&subject.surfaces, &locator, probe);
        let excess = located.distance - row.distance / per_metre;
        assert!(
            excess <= tolerance * subject.size,
            "{file}: {probe:?} is {} away, not {}",
            located.distance,
            row.distance
        );
        tried += 1;
    }
    println!("{file}: {tried} of {} golden probes", rows.len());
    assert!(tried > rows.len() / 2);
    Ok(())
}

#[test]
fn the_capped_box_is_proved_everywhere_and_located_without_a_miss() -> Result<(), Box<dyn Error>> {
    let subject = Subject::read("capped_box.toml")?;
    let (baked, _) =
        run(&subject, &LocatorOptions { tolerance: CONVEX, ..LocatorOptions::default() }, CONVEX, probes(20_000)?)?;
    golden_probes(&subject, &baked, "capped_box_closest.csv", CONVEX)?;
    assert!((baked.report.proved - 1.0).abs() < 1e-12, "{}", baked.report);
    // What the body's 8 KiB leave it.
    assert!(baked.report.bytes <= 3277, "{}", baked.report);
    // 32 evaluations are enough for so many.
    assert!(baked.report.longest <= 6, "{}", baked.report);
    Ok(())
}

#[test]
fn the_tables_do_not_depend_on_the_number_of_threads() -> Result<(), Box<dyn Error>> {
    let subject = Subject::read("capped_box.toml")?;
    let options = LocatorOptions { depth: 4, ..LocatorOptions::default() };
    let with = |threads: usize| -> Result<BakedLocator, Box<dyn Error>> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        pool.install(|| subject.bake(&options).map_err(|error| error.to_string())).map_err(Into::into)
    };
    assert_eq!(with(1)?, with(3)?);
    Ok(())
}

/// A check that nothing can fail is none: an entry that is taken away, or shrunk to a corner, is missed.
#[test]
fn a_spoiled_list_is_found_by_the_check() -> Result<(), Box<dyn Error>> {
    let subject = Subject::read("capped_box.toml")?;
    let options = LocatorOptions { depth: 4, ..LocatorOptions::default() };
    let mut baked = subject.bake(&options)?;
    for entry in &mut baked.entries {
        let candidate = Candidate::unpack(*entry);
        if candidate.face == 0 {
            *entry = Candidate { upper: candidate.lower, ..candidate }.pack();
        }
    }
    let checked = locating::check(&subject.model, &subject.surfaces, &baked, 2000, options.inside, CONVEX);
    assert!(checked.misses.len() > 100, "{}", checked.misses.len());
    Ok(())
}

#[test]
fn wrong_seams_are_refused() -> Result<(), Box<dyn Error>> {
    let subject = Subject::read("capped_box.toml")?;
    // The only face, with no border of its own but one: probes beyond the others have nothing. No list is short enough,
    // so that cells are small.
    let other = |side| vec![BorderSide { face: 0, side, reversed: false }];
    let seams = Seams { edges: vec![other(0)], vertices: Vec::new(), poles: vec![[false; 4]] };
    let options = LocatorOptions { depth: 4, entries: 0, deep_entries: 0, fineness: 0.25, ..LocatorOptions::default() };
    let refused = locator::bake(&subject.patches[5..], seams, &subject.creases[5..], &options, None, &|_, _| ());
    assert!(refused.unwrap_err().to_string().contains("seams"));
    Ok(())
}

/// Coarser than what ships, for the time it takes; the whole is [`the_teapot_is_located_without_a_miss`].
#[test]
fn a_coarse_locator_of_the_teapot_misses_nothing_either() -> Result<(), Box<dyn Error>> {
    let subject = Subject::read("teapot.toml")?;
    let options = LocatorOptions { depth: 3, ..LocatorOptions::default() };
    let (baked, _) = run(&subject, &options, ANY, 300)?;
    golden_probes(&subject, &baked, "teapot_closest.csv", ANY)?;
    assert!(
        baked.entries.iter().all(|entry| Candidate::unpack(*entry).upper.iter().all(|step| u32::from(*step) <= GRID))
    );
    Ok(())
}

#[test]
#[ignore = "minutes: the whole teapot, or the model that PALPATE_MODEL names"]
fn the_teapot_is_located_without_a_miss() -> Result<(), Box<dyn Error>> {
    let file = std::env::var("PALPATE_MODEL").unwrap_or_else(|_| "teapot.toml".to_owned());
    let tolerance = std::env::var("PALPATE_TOLERANCE").map_or(Ok(ANY), |text| text.parse())?;
    let subject = Subject::read(&file)?;
    let convex = std::env::var_os("PALPATE_CONVEX").is_some();
    let options = if convex { LocatorOptions::convex() } else { LocatorOptions::default() };
    let (baked, _) = run(&subject, &options, tolerance, probes(100_000)?)?;
    if file == "teapot.toml" {
        golden_probes(&subject, &baked, "teapot_closest.csv", tolerance)?;
    }
    Ok(())
}
