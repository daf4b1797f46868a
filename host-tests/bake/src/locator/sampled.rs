//! Samples of a list that is not proved: they find where it fails, so that its rectangles are divided there. Where they
//! find nothing it is sampled, and no more than that.
//!
//! A list is searched with the firmware's own code: in `f32`, by its own steps and with its own bound of them.

use super::faces::{Faces, Region};
use super::field::Probes;
use super::list::Entry;
use super::tables;
use super::unique::Rectangle;
use crate::random::Random;
use glam::DVec3;
use palpate::body::{Candidate, Descending, GRID, Judgement, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX};
use palpate::math::Vec3;

/// Starts of descents that a list is compared with, the nearest ones.
const STARTS: usize = 16;

/// The closer point, if one of `count` probes of a cell is led to a point that is more than `tolerance` metres farther
/// than another that is found: its face and parameters.
pub(super) fn failure(
    faces: &Faces,
    probes: &Probes,
    entries: &[Entry],
    regions: &[Region<'_>],
    count: usize,
    [tolerance, size]: [f64; 2],
) -> Option<(u16, [f64; 2])> {
    let list: Vec<_> = tables::list(entries).into_iter().map(Candidate::unpack).collect();
    let starts: Vec<(Vec3, Candidate, f32)> = regions.iter().map(|region| start(faces, region)).collect();
    let mut random = Random::new(7);
    (0..count).find_map(|index| {
        // Normals meet where the closest point is not unique, in a line or in a point that no probe of a box would hit.
        let on_normal = if index % 2 == 1 { on_a_normal(faces, probes, entries, &mut random) } else { None };
        let probe = on_normal.unwrap_or_else(|| {
            let place = DVec3::from_array(std::array::from_fn(|_| random.between(-1.0, 1.0)));
            probes.centre + probes.half * place
        });
        let probe = probe.as_vec3();
        let listed = searched(faces, &list, probe, size as f32);
        // No point of a region is farther from its middle than its diameter.
        let near = starts.iter().filter_map(|start| {
            let (squared, reach) = (start.0.distance_squared(probe), (listed - tolerance) as f32 + start.2);
            (reach > 0.0 && squared < reach * reach).then_some((squared, start))
        });
        let mut near: Vec<_> = near.collect();
        if near.len() > STARTS {
            near.select_nth_unstable_by(STARTS, |a, b| a.0.total_cmp(&b.0));
            near.truncate(STARTS);
        }
        near.iter().enumerate().find_map(|(index, (_, (_, candidate, _)))| {
            // Regions smaller than a step of the grid share their rectangle, and with it the descent.
            if near[..index].iter().any(|(_, (_, known, _))| known == candidate) {
                return None;
            }
            let mut best = f32::INFINITY;
            let parameters = descended(faces, candidate, probe, &mut best, size as f32);
            let distance = f64::from((2.0 * best).sqrt());
            (listed > distance + tolerance).then_some((candidate.face, parameters.map(f64::from)))
        })
    })
}

/// The middle of a region, its rectangle with a step of the grid around it, so that a descent may leave it for a
/// neighbour's minimum, and its diameter, metres.
fn start(faces: &Faces, region: &Region<'_>) -> (Vec3, Candidate, f32) {
    let face = region.face(faces);
    let Rectangle { lower, upper } = Rectangle::around(region.rectangle(faces));
    let candidate = Candidate {
        face,
        lower: lower.map(|step| step.saturating_sub(1)),
        upper: upper.map(|step| (step + 1).min(GRID as u8)),
        convex: false,
        more: false,
    };
    let [low, high] = region.rectangle(faces);
    let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
    (faces.surfaces[usize::from(face)].evaluate(middle).point.as_vec3(), candidate, region.diameter() as f32)
}

/// The parameters at which a descent on a rectangle ends. `best` is the least `½ ‖P − Q‖²` known, m², this descent's
/// included.
fn descended(faces: &Faces, candidate: &Candidate, probe: Vec3, best: &mut f32, size: f32) -> [f32; 2] {
    let mut descending = Descending::new(*candidate, MAX_EVALUATIONS_PER_CANDIDATE_CONVEX);
    loop {
        let face = usize::from(candidate.face);
        let progress = descending.step(&faces.tables[face], faces.poles(face), probe, *best, size);
        *best = best.min(descending.half_squared);
        if progress != Judgement::Falling {
            return descending.parameters;
        }
    }
}

/// A probe of the cell on the normal at some point of some candidate, if that normal meets the cell.
fn on_a_normal(faces: &Faces, probes: &Probes, entries: &[Entry], random: &mut Random) -> Option<DVec3> {
    let entry = &entries[(random.between(0.0, entries.len() as f64) as usize).min(entries.len() - 1)];
    let [low, high] = entry.rectangle.parameters();
    let parameters = [0, 1].map(|axis| random.between(low[axis], high[axis]));
    let at = faces.surfaces[usize::from(entry.face)].evaluate(parameters);
    let normal = at.first[0].cross(at.first[1]).try_normalize()?;
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

/// The distance that the firmware's search of a list ends with, as [`palpate::body::Search`] goes about it.
fn searched(faces: &Faces, list: &[Candidate], probe: Vec3, size: f32) -> f64 {
    let mut best = f32::INFINITY;
    for candidate in list {
        descended(faces, candidate, probe, &mut best, size);
    }
    f64::from((2.0 * best).sqrt())
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
