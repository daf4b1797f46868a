//! Checks a locator by other means than its proof: random probes, the distance by many starts of the oracle.

use crate::generate::Random;
use crate::oracle::{Oracle, OraclePoint};
use glam::DVec3;
use palpate::body::Locator;
use palpate_bake::Model;
use palpate_bake::locator::{BakedLocator, StoredSurface};
use rayon::prelude::*;

/// The closest point that a locator's list leads to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ListMinimum {
    /// The face it is on.
    pub face: usize,
    /// Its parameters.
    pub parameters: [f64; 2],
    /// From the probe, metres.
    pub distance: f64,
    /// Entries of the list.
    pub entries: usize,
    /// Evaluations spent.
    pub evaluations: usize,
}

/// The best of the minima in the rectangles of a probe's list, from their centres.
pub fn locate(surfaces: &[StoredSurface], locator: &Locator, probe: DVec3) -> ListMinimum {
    let mut best = ListMinimum { face: 0, parameters: [0.0; 2], distance: f64::INFINITY, entries: 0, evaluations: 0 };
    let mut index = locator.list(probe.as_vec3());
    while let Some(candidate) = locator.candidate(index) {
        let [low, high] = candidate.rectangle().map(|corner| corner.map(f64::from));
        let start = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let found = surfaces[usize::from(candidate.face)].descend(probe, start, [low, high]);
        best.entries += 1;
        best.evaluations += found.evaluations;
        if found.distance < best.distance {
            best = ListMinimum {
                face: candidate.face.into(),
                parameters: found.parameters,
                distance: found.distance,
                ..best
            };
        }
        if !candidate.more {
            break;
        }
        index += 1;
    }
    best
}

/// Result of a check.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Checked {
    /// Checked probes.
    pub probes: usize,
    /// Probes inside the body.
    pub inside: usize,
    /// Probes whose list leads to a distance too large by more than the tolerance.
    pub misses: Vec<Miss>,
    /// The maximum excess, relative to the size.
    pub worst: f64,
    /// Evaluations of the most expensive list.
    pub evaluations: usize,
}

/// A probe whose list does not lead to its closest point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The probe, metres.
    pub probe: DVec3,
    /// The oracle's distance, metres.
    pub distance: f64,
    /// The list's minimum.
    pub located: ListMinimum,
    /// Whether the probe is inside.
    pub inside: bool,
}

/// Tries random probes of the root cube, those that are deeper inside than `inside` sizes left out.
pub fn check(
    model: &Model,
    surfaces: &[StoredSurface],
    baked: &BakedLocator,
    count: usize,
    inside: f64,
    tolerance: f64,
) -> Checked {
    let locator = baked.to_locator();
    let size = f64::from(baked.side) / 2.0;
    let oracles: Vec<_> = model.patches.iter().map(Oracle::new).collect();
    const CHUNK: usize = 1000;
    let chunk = |index: usize| {
        let mut random = Random::new(index as u64);
        let mut checked = Checked::default();
        for _ in 0..CHUNK.min(count - index * CHUNK) {
            let along = DVec3::from_array(std::array::from_fn(|_| random.between(0.0, f64::from(baked.side))));
            // What the target gets is an f32.
            let probe = (baked.corner.as_dvec3() + along).as_vec3().as_dvec3();
            one(model, &oracles, surfaces, &locator, [size, inside, tolerance], probe, &mut checked);
        }
        checked
    };
    let chunks: Vec<_> = (0..count.div_ceil(CHUNK)).into_par_iter().map(chunk).collect();
    chunks.into_iter().fold(Checked::default(), |mut all, chunk| {
        all.probes += chunk.probes;
        all.inside += chunk.inside;
        all.misses.extend(chunk.misses);
        all.worst = all.worst.max(chunk.worst);
        all.evaluations = all.evaluations.max(chunk.evaluations);
        all
    })
}

fn one(
    model: &Model,
    oracles: &[Oracle<'_>],
    surfaces: &[StoredSurface],
    locator: &Locator,
    [size, inside, tolerance]: [f64; 3],
    probe: DVec3,
    checked: &mut Checked,
) {
    let found = oracles.iter().map(|oracle| oracle.closest(probe)).enumerate();
    let Some((face, closest)) = found.min_by(|(_, a), (_, b)| a.distance.total_cmp(&b.distance)) else { return };
    let patch = &model.patches[face];
    let surface = OraclePoint::evaluate(patch, closest.parameters[0], closest.parameters[1]);
    let is_inside = surface.normal(patch.flip).dot(probe - closest.point) < 0.0;
    if is_inside && closest.distance > inside * size {
        return;
    }
    let located = locate(surfaces, locator, probe);
    checked.probes += 1;
    checked.inside += usize::from(is_inside);
    checked.evaluations = checked.evaluations.max(located.evaluations);
    let excess = (located.distance - closest.distance) / size;
    checked.worst = checked.worst.max(excess);
    if excess > tolerance {
        checked.misses.push(Miss { probe, distance: closest.distance, located, inside: is_inside });
    }
}
