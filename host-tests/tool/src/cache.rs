//! Cache between runs: locators, by the hash of their inputs, so that no model is baked twice.
//!
//! The cache can be deleted at any time. An unreadable or incomplete entry is baked again; a failed write is ignored.

use glam::DVec3;
use palpate::math::Vec3;
use palpate_bake::BakedBody;
use palpate_bake::body::LocatorTable;
use palpate_bake::locator::{LeafCounts, LocatorError, LocatorOptions, LocatorReport};
use sha2::{Digest as _, Sha256};
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;
use std::{env, fmt, fs};

/// Locators that are kept, the youngest; each takes at most some 650 KB.
const KEPT: usize = 64;

/// `PALPATE_CACHE`, or `palpate` in the user's cache folder, if there is one.
pub fn folder() -> Option<PathBuf> {
    let variable = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    variable("PALPATE_CACHE")
        .or_else(|| variable("XDG_CACHE_HOME").map(|cache| cache.join("palpate")))
        .or_else(|| variable("HOME").map(|home| home.join(".cache/palpate")))
}

/// The evidence for a locator, in brief.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Evidence {
    /// Worst-case error of a cold query's distance where it is bounded, mm.
    pub bound_mm: f32,
    /// Share of the leaves without a bound, for which only random probes speak.
    pub sampled: f32,
}

impl Evidence {
    /// Of a locator's report.
    pub fn of(report: &LocatorReport) -> Self {
        let LeafCounts { sampled, deep, .. } = report.leaves_by;
        Self { bound_mm: (1e3 * report.loosest) as f32, sampled: (sampled + deep) as f32 / report.leaves.max(1) as f32 }
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bound_mm, sampled } = *self;
        write!(
            formatter,
            "worst-case error of a cold query: {bound_mm:.4} mm (proved bound if it ends at a second minimum, not measured)"
        )?;
        if sampled > 0.0 {
            let percent = 100.0 * sampled;
            write!(
                formatter,
                " in {:.1} % of the locator's cells; {percent:.1} % are sampled: no bound",
                100.0 - percent
            )?;
        }
        Ok(())
    }
}

/// A body with its locator, from the cache or baked; `text` is its model's. With `wanted`, metres, the locator covers
/// only these probes.
///
/// # Errors
/// Tables that would not fit their indices.
pub fn located(
    body: BakedBody,
    text: &str,
    options: &LocatorOptions,
    wanted: Option<&[DVec3]>,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<(BakedBody, Evidence), LocatorError> {
    let whole = Kept::new(text, options, None);
    let part = wanted.map(|probes| Kept::new(text, options, Some(probes)));
    let known = whole.as_ref().and_then(Kept::read);
    if let Some(locator) = known.or_else(|| part.as_ref().and_then(|part| part.as_ref()?.read())) {
        let (locator, evidence) = locator;
        return Ok((BakedBody { locator, ..body }, evidence));
    }
    let (body, evidence, kept) = match wanted {
        Some(probes) => (body.located_for(probes, options, progress)?, Evidence::default(), part.flatten()),
        None => {
            let (body, report) = body.located(options, progress)?;
            (body, Evidence::of(&report), whole)
        }
    };
    if let Some(kept) = kept {
        kept.write(&body.locator, evidence);
    }
    Ok((body, evidence))
}

/// The file of one locator.
struct Kept(PathBuf);

impl Kept {
    /// By everything that it follows from, this program included.
    fn new(text: &str, options: &LocatorOptions, wanted: Option<&[DVec3]>) -> Option<Self> {
        let program = fs::metadata(env::current_exe().ok()?).ok()?;
        let built = program.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
        let mut hash = Sha256::new();
        hash.update(format!("{} {built:?} {options:?} {}\n{text}\n", program.len(), text.len()));
        for probe in wanted.unwrap_or_default() {
            probe.to_array().iter().for_each(|coordinate| hash.update(coordinate.to_le_bytes()));
        }
        hash.update([u8::from(wanted.is_some())]);
        let name: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        Some(Self(folder()?.join("locators").join(name)))
    }

    fn read(&self) -> Option<(LocatorTable, Evidence)> {
        let bytes = fs::read(&self.0).ok()?;
        let (bytes, digest) = bytes.split_at_checked(bytes.len().checked_sub(32)?)?;
        if Sha256::digest(bytes).as_slice() != digest {
            return None;
        }
        let mut words = bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
        let mut word = || words.next();
        let (nodes, entries) = (word()? as usize, word()? as usize);
        let [x, y, z, side] = [word()?, word()?, word()?, word()?].map(f32::from_bits);
        let [bound_mm, sampled] = [word()?, word()?].map(f32::from_bits);
        let mut node = || -> Option<[u16; 8]> {
            let mut node = [0; 8];
            for pair in node.chunks_exact_mut(2) {
                let both = word()?;
                (pair[0], pair[1]) = (both as u16, (both >> 16) as u16);
            }
            Some(node)
        };
        let nodes = (0..nodes).map(|_| node()).collect::<Option<_>>()?;
        let entries = (0..entries).map(|_| word()).collect::<Option<_>>()?;
        let locator = LocatorTable { corner: Vec3::new(x, y, z), side, nodes, entries };
        Some((locator, Evidence { bound_mm, sampled }))
    }

    fn write(&self, locator: &LocatorTable, evidence: Evidence) {
        let [x, y, z] = locator.corner.to_array();
        let head = [locator.nodes.len() as u32, locator.entries.len() as u32];
        let head =
            head.into_iter().chain([x, y, z, locator.side, evidence.bound_mm, evidence.sampled].map(f32::to_bits));
        let nodes = locator.nodes.iter().flatten().flat_map(|child| child.to_le_bytes());
        let mut bytes: Vec<u8> = head.flat_map(u32::to_le_bytes).chain(nodes).collect();
        bytes.extend(locator.entries.iter().flat_map(|entry| entry.to_le_bytes()));
        let digest = Sha256::digest(&bytes);
        bytes.extend_from_slice(&digest);
        // A run that is stopped leaves nothing that could be taken for a whole one.
        let beside = self.0.with_extension(std::process::id().to_string());
        let written = self.0.parent().map(fs::create_dir_all).is_some_and(|made| made.is_ok())
            && fs::write(&beside, bytes).is_ok()
            && fs::rename(&beside, &self.0).is_ok();
        if written && let Some(folder) = self.0.parent() {
            drop_the_oldest(folder);
        }
    }
}

fn drop_the_oldest(folder: &Path) {
    let Ok(files) = fs::read_dir(folder) else { return };
    let age = |file: fs::DirEntry| Some((file.metadata().ok()?.modified().ok()?, file.path()));
    let mut files: Vec<_> = files.flatten().filter_map(age).collect();
    files.sort();
    files.iter().rev().skip(KEPT).for_each(|(_, path)| drop(fs::remove_file(path)));
}
