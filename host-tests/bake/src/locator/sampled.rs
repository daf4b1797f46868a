//! Samples of a list that is not proved: they find where it fails, so that its rectangles are divided there. Where they
//! find nothing it is sampled, and no more than that.
//!
//! Only the entries without a proof are in question: a start in a proved one, whose only minimum the search finds, is
//! compared with nothing.
//!
//! A list is searched with the firmware's own code: in `f32`, by its own steps and with its own bound of them.

use super::faces::{Faces, Rectangle, Region, Start, Starts};
use super::list::Entry;
use super::piece::Probes;
use super::tables;
use crate::random::Random;
use glam::DVec3;
use palpate::body::{
    Candidate, CandidateSearch, CandidateStatus, MAX_EVALUATIONS, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX,
};
use palpate::math::Vec3;

/// Starts of descents that a list is compared with, at most.
const STARTS: usize = 16;
/// Probes about one for which a list failed.
const ABOUT: usize = 256;
/// How far they are from it, beside half a side of the cell.
const FARTHEST_ABOUT: f64 = 0.5;
/// The smallest of them.
const NEAREST_ABOUT: f64 = 1e-3;

/// Entries that the longest search always has evaluations for.
const REACH: usize = (MAX_EVALUATIONS / MAX_EVALUATIONS_PER_CANDIDATE_CONVEX as u16) as usize;

/// A fault of a list.
pub(super) enum Fault {
    /// A point, of a face at parameters, is nearer than the result.
    Nearer((u16, [f64; 2])),
    /// The evaluations are used up before the nearest is found.
    Spent,
}

/// How a list is sampled.
pub(super) struct Sampling {
    /// Probes at first.
    pub count: usize,
    /// Evaluations that a search may cost.
    pub evaluations: u16,
    /// An entry that is proved to lose no more needs no samples, metres.
    pub proved: f64,
    /// A list fails if it leads to a point so much farther than another that is found, metres.
    pub tolerance: f32,
    /// Of the body, metres.
    pub size: f32,
}

impl Sampling {
    /// Whether a search always has evaluations for all entries of a list.
    pub(super) fn reaches(&self, entries: &[Entry]) -> bool {
        entries.len() <= in_reach(self.evaluations)
    }
}

/// Probes of a cell, and what its list is compared with.
pub(super) struct Sampler<'a> {
    faces: &'a Faces,
    probes: Probes,
    starts: Starts,
    random: Random,
    /// Those that have to pass one after another, the same for every list.
    drawn: Vec<Vec3>,
    /// Parts of the cell; probes elsewhere are proved to pass. `None` if none are.
    open: Option<Vec<Probes>>,
    next: usize,
    /// That a search may cost.
    evaluations: u16,
    /// Metres.
    tolerance: f32,
    size: f32,
}

impl<'a> Sampler<'a> {
    /// For some probes of a cell.
    pub(super) fn new(
        faces: &'a Faces,
        probes: Probes,
        regions: &[Region<'_>],
        entries: &[Entry],
        sampling: Sampling,
        open: Option<Vec<Probes>>,
    ) -> Self {
        // A longer list may be left before a proved entry has its turn.
        let all_in_reach = sampling.reaches(entries);
        let Sampling { count, evaluations, proved, tolerance, size } = sampling;
        let proved: Vec<_> = entries.iter().filter(|entry| all_in_reach && entry.minima.is_proved(proved)).collect();
        let is_open = |region: &Region<'_>| {
            let (face, around) = (region.face(faces), Rectangle::around(region.rectangle(faces)));
            !proved.iter().any(|entry| entry.face == face && entry.rectangle.holds(&around))
        };
        let mut random = Random::new(7);
        let drawn = (0..count).map(|index| drawn(faces, &probes, entries, index, &mut random)).collect();
        Self {
            faces,
            probes,
            starts: Starts::new(faces, regions.iter().filter(|region| is_open(region))),
            random,
            drawn,
            open,
            next: 0,
            evaluations,
            tolerance,
            size,
        }
    }

    /// The fault of a list for the next probe for which it fails; `None` once all have passed with this list.
    ///
    /// Where one probe failed others near it will: they are added.
    pub(super) fn fault(&mut self, entries: &[Entry]) -> Option<Fault> {
        let list: Vec<_> = tables::list(entries).into_iter().map(Candidate::unpack).collect();
        for _ in 0..self.drawn.len() {
            let probe = self.drawn[self.next];
            let is_open = self.open.as_ref().is_none_or(|open| open.iter().any(|part| part.holds(probe.as_dvec3())));
            if is_open && let Some(fault) = self.fault_at(&list, probe) {
                // The list will be another one.
                self.open = None;
                for _ in 0..ABOUT {
                    let reach = self.probes.half * self.random.scale(NEAREST_ABOUT, FARTHEST_ABOUT);
                    let place = DVec3::from_array(std::array::from_fn(|_| self.random.between(-1.0, 1.0)));
                    let Probes { centre, half } = self.probes;
                    let about = probe.as_dvec3() + reach * place;
                    self.drawn.push(about.clamp(centre - half, centre + half).as_vec3());
                }
                return Some(fault);
            }
            self.next = (self.next + 1) % self.drawn.len();
        }
        None
    }

    /// Why the point that the firmware's search of a list ends with is not the nearest to a probe, as
    /// [`palpate::body::Search`] goes about it.
    fn fault_at(&self, list: &[Candidate], probe: Vec3) -> Option<Fault> {
        if self.passes(list, probe) {
            return None;
        }
        let mut best = f32::INFINITY;
        let mut left = self.evaluations;
        for candidate in list {
            self.descended(candidate, probe, &mut best, &mut left);
        }
        let point = self.nearer(distance(best) - self.tolerance, probe)?;
        Some(if left == 0 { Fault::Spent } else { Fault::Nearer(point) })
    }

    /// Whether a few of a list's entries lead to a point that no start is much nearer than. A search of the whole list
    /// then ends there or nearer: a candidate is only left early for a nearer point than any in it.
    ///
    /// A start that seems nearer names the entry to try next.
    fn passes(&self, list: &[Candidate], probe: Vec3) -> bool {
        let list = &list[..list.len().min(in_reach(self.evaluations))];
        let mut tried = [false; REACH];
        let mut next = Some(0);
        let mut best = f32::INFINITY;
        while let Some(index) = next.filter(|index| !tried[*index]) {
            tried[index] = true;
            self.descended(&list[index], probe, &mut best, &mut { u16::MAX });
            let Some(start) = self.starts.any_nearer(distance(best) - self.tolerance, probe) else { return true };
            let holds = |entry: &Candidate| {
                let Candidate { face, lower, upper, .. } = *entry;
                face == start.candidate.face && Rectangle { lower, upper }.holds(&start.rectangle)
            };
            next = list.iter().position(holds);
        }
        self.nearer(distance(best) - self.tolerance, probe).is_none()
    }

    /// A point nearer to a probe than a distance, metres, to which one of the starts leads.
    fn nearer(&self, enough: f32, probe: Vec3) -> Option<(u16, [f64; 2])> {
        let mut starts = self.starts.nearer(enough, probe);
        // Regions smaller than a step of the grid share their rectangle, and with it the descent.
        starts.dedup_by_key(|(_, start)| start.candidate);
        starts.iter().take(STARTS).find_map(|(_, Start { candidate, .. })| {
            let mut best = f32::INFINITY;
            let parameters = self.descended(candidate, probe, &mut best, &mut { u16::MAX });
            (distance(best) < enough).then_some((candidate.face, parameters.map(f64::from)))
        })
    }

    /// The parameters at which a descent on a rectangle ends. `best` is the smallest known `½ ‖P − Q‖²`, m², including
    /// this descent's; `left` the evaluations left for the search.
    fn descended(&self, candidate: &Candidate, probe: Vec3, best: &mut f32, left: &mut u16) -> [f32; 2] {
        let mut descending = CandidateSearch::new(*candidate, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX);
        loop {
            if *left == 0 {
                return descending.parameters;
            }
            *left -= 1;
            let face = usize::from(candidate.face);
            let progress = descending.step(&self.faces.tables[face], self.faces.poles(face), probe, *best, self.size);
            *best = best.min(descending.half_squared);
            if progress != CandidateStatus::Falling {
                return descending.parameters;
            }
        }
    }
}

/// A probe of a cell: any, or one of every second on a normal. Normals meet where the closest point is not unique, in a
/// line or in a point that no probe of a box would hit.
fn drawn(faces: &Faces, probes: &Probes, entries: &[Entry], index: usize, random: &mut Random) -> Vec3 {
    let on_normal = if index % 2 == 1 { on_a_normal(faces, probes, entries, random) } else { None };
    let probe = on_normal.unwrap_or_else(|| {
        let place = DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
        probes.centre + probes.half * place
    });
    probe.as_vec3()
}

/// First entries of a list, that a search always has evaluations for.
fn in_reach(evaluations: u16) -> usize {
    usize::from(evaluations / u16::from(MAX_EVALUATIONS_PER_CANDIDATE_CONVEX)).min(REACH)
}

fn distance(half_squared: f32) -> f32 {
    (2.0 * half_squared).sqrt()
}

/// A probe of the cell on the normal at some point of some candidate, if that normal meets the cell.
fn on_a_normal(faces: &Faces, probes: &Probes, entries: &[Entry], random: &mut Random) -> Option<DVec3> {
    let entry = &entries[(random.between(0.0, entries.len() as f64) as usize).min(entries.len() - 1)];
    let [low, high] = entry.rectangle.parameters();
    let parameters = [0, 1].map(|axis| random.between(low[axis], high[axis]));
    let at = faces.surfaces[usize::from(entry.face)].evaluate(parameters);
    let normal = at.first[0].cross(at.first[1]);
    let length = normal.length_squared().sqrt();
    if length == 0.0 {
        return None;
    }
    let normal = normal / length;
    // Where the line is inside the box, slab by slab.
    let (towards, half) = (probes.centre - at.point, DVec3::splat(1.0) * probes.half);
    let (mut enters, mut leaves) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        if normal[axis].abs() < 1e-12 {
            if towards[axis].abs() > half[axis] {
                return None;
            }
            continue;
        }
        let [a, b] = [-1.0, 1.0].map(|side| (towards[axis] + side * half[axis]) / normal[axis]);
        (enters, leaves) = (enters.max(a.min(b)), leaves.min(a.max(b)));
    }
    (enters < leaves).then(|| at.point + normal * random.between(enters, leaves))
}

/// Divides the rectangle that a point lies in, so that each half has a start of its own; `false` if none does or it is
/// too small.
pub(super) fn divide(entries: &mut Vec<Entry>, (face, parameters): (u16, [f64; 2])) -> bool {
    let holds = |entry: &Entry| {
        let [low, high] = entry.rectangle.parameters();
        entry.face == face && (0..2).all(|axis| low[axis] <= parameters[axis] && parameters[axis] <= high[axis])
    };
    let width = |entry: &Entry| [0, 1].map(|axis| entry.rectangle.upper[axis] - entry.rectangle.lower[axis]);
    let found = (0..entries.len())
        .filter(|index| holds(&entries[*index]))
        .max_by_key(|index| width(&entries[*index]).into_iter().max());
    let Some(index) = found else { return false };
    let [along_u, along_v] = width(&entries[index]);
    let (axis, steps) = if along_v > along_u { (1, along_v) } else { (0, along_u) };
    if steps < 2 {
        return false;
    }
    let mut upper = entries[index];
    let middle = upper.rectangle.lower[axis] + steps / 2;
    upper.rectangle.lower[axis] = middle;
    entries[index].rectangle.upper[axis] = middle;
    entries.push(upper);
    true
}

#[cfg(test)]
mod tests {
    use super::super::{Seams, StoredSurface};
    use super::*;
    use crate::locator::unique::Minima;
    use crate::{Axis, BakedPatch, Model};
    use palpate::body::GRID;
    use std::error::Error;
    use std::path::Path;

    /// Over the middle of one side of a box, where every face is listed: the entry of that side dropped, and cut to a
    /// corner, beside others that are proved and that are not.
    #[test]
    fn a_spoiled_list_is_found() -> Result<(), Box<dyn Error>> {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/capped_box.toml");
        let model = Model::read(&file)?;
        let patches = model.patches.iter().map(BakedPatch::without_shape).collect::<Result<Vec<_>, _>>()?;
        let surfaces: Vec<_> = patches.iter().map(StoredSurface::new).collect();
        let seams = Seams::find(&surfaces, 1e-7);
        let creases: Vec<_> =
            model.patches.iter().map(|patch| [Axis::U, Axis::V].map(|axis| patch.creases(axis))).collect();
        let faces = Faces::new(&patches, seams, &creases, 1.0).ok_or("a weight")?;
        for near in 0..patches.len() as u16 {
            let middle = surfaces[usize::from(near)].evaluate([0.5; 2]).point;
            let around = Probes::cube(middle, 1e-3);
            let fault = |rectangle: Option<[u8; 2]>, others: Minima| {
                let entry = |face: u16| {
                    let upper = if face == near { rectangle? } else { [GRID as u8; 2] };
                    let minima = if face == near { Minima::Unknown } else { others };
                    Some(Entry { face, rectangle: Rectangle { lower: [0; 2], upper }, minima, distance: 0.0 })
                };
                let entries: Vec<_> = (0..patches.len() as u16).filter_map(entry).collect();
                let sampling = Sampling { count: 64, evaluations: 512, proved: 0.0, tolerance: 1e-6, size: 0.06 };
                Sampler::new(&faces, around, &faces.regions(), &entries, sampling, None).fault(&entries)
            };
            for others in [Minima::One, Minima::Unknown] {
                assert!(fault(Some([GRID as u8; 2]), others).is_none());
                for spoiled in [None, Some([4; 2])] {
                    assert!(matches!(fault(spoiled, others), Some(Fault::Nearer((face, _))) if face == near));
                }
            }
        }
        Ok(())
    }
}
