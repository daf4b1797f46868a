//! A second reading of the file, by its text alone: how many faces lie where, with which vertices and outlines. It
//! shares no code with the first, and the part and its patches are held against it: a unit, a placement, a hole, a
//! face or the sense of an outline that the first got wrong is found without another program.

mod compare;
mod corners;
mod records;
#[cfg(test)]
mod tests;
mod walk;

use crate::remarks::{references, without_remarks};
use glam::{DAffine3, DVec3};
use records::{Records, numbers, reference};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use walk::{SHAPES, Walk};

/// Placed vertices: beyond, nothing is compared.
const MOST_POINTS: usize = 2_000_000;

/// A vertex where the file places it, millimetres.
struct Point {
    at: DVec3,
    vertex: u64,
    face: u64,
}

/// The edges of a face, each with whether it is run along from its first vertex to its second, by the face's bounds:
/// seen from the surface's own normal, the face on the left.
type Outline = HashMap<(u64, bool), usize>;

/// The parts, outlines and places that the file's text states.
pub struct Reread {
    /// Faces by their numbers.
    outlines: HashMap<u64, Outline>,
    /// Faces, each as often as it is placed.
    faces: usize,
    points: Vec<Point>,
    /// Volume and area that the file's own system computed, mm³ and mm².
    stated: [Option<f64>; 2],
}

/// Reads a file again; `None` where it has what this reading does not follow.
pub fn read(path: &Path) -> Option<Reread> {
    let text = String::from_utf8_lossy(&std::fs::read(path).ok()?).into_owned();
    of_text(&text)
}

fn of_text(text: &str) -> Option<Reread> {
    let text = without_remarks(text);
    let records = Records::new(&text);
    let mut walk = Walk::new(&records)?;
    let roots = walk.roots();
    for root in &roots {
        walk.product(*root, DAffine3::IDENTITY, 0)?;
    }
    if walk.placed.is_empty() {
        if !records.all("MAPPED_ITEM").is_empty() {
            return None;
        }
        let units: Vec<f64> = walk.units.values().copied().collect();
        let unit = *units.first()?;
        if units.iter().any(|other| *other != unit) {
            return None;
        }
        let solids: Vec<u64> = SHAPES.iter().flat_map(|kind| records.all(kind)).collect();
        walk.placed.extend(solids.into_iter().map(|solid| (solid, DAffine3::IDENTITY, unit)));
    }
    let placed = std::mem::take(&mut walk.placed);
    let (mut outlines, mut points, mut count) = (HashMap::new(), Vec::new(), 0);
    for (solid, placement, unit) in placed {
        let faces = below(&records, solid, &["ADVANCED_FACE", "FACE_SURFACE"]);
        count += faces.len();
        let mut seen = HashSet::new();
        for face in faces {
            if let Entry::Vacant(vacant) = outlines.entry(face) {
                vacant.insert(outline(&records, face)?);
            }
            for vertex in below(&records, face, &["VERTEX_POINT"]).into_iter().filter(|vertex| seen.insert(*vertex)) {
                let at = point(&records, reference(records.part(vertex, "VERTEX_POINT")?.get(1)?)?)?;
                points.push(Point { at: placement.transform_point3(at * unit), vertex, face });
            }
        }
        if points.len() > MOST_POINTS {
            return None;
        }
    }
    let stated = if roots.len() == 1 { walk.stated(roots[0]) } else { [None; 2] };
    Some(Reread { outlines, faces: count, points, stated })
}

/// All entities of some types that an entity refers to, directly or not.
fn below(records: &Records<'_>, start: u64, kinds: &[&str]) -> Vec<u64> {
    let (mut found, mut next, mut seen) = (Vec::new(), vec![start], HashSet::new());
    while let Some(id) = next.pop() {
        if !seen.insert(id) {
            continue;
        }
        if kinds.iter().any(|kind| records.is(id, kind)) {
            found.push(id);
        } else {
            next.extend(records.references(id));
        }
    }
    found.sort_unstable();
    found
}

fn outline(records: &Records<'_>, face: u64) -> Option<Outline> {
    let is_true = |field: &&str| *field == ".T.";
    let of = records.part(face, "ADVANCED_FACE").or_else(|| records.part(face, "FACE_SURFACE"))?;
    let sense = is_true(of.last()?);
    let mut outline = Outline::new();
    for bound in references(of.get(1)?) {
        let of = records.part(bound, "FACE_BOUND").or_else(|| records.part(bound, "FACE_OUTER_BOUND"))?;
        let way = is_true(of.get(2)?) == sense;
        let Some(edges) = records.part(reference(of.get(1)?)?, "EDGE_LOOP") else { continue };
        for used in references(edges.get(1)?) {
            let used = records.part(used, "ORIENTED_EDGE")?;
            *outline.entry((reference(used.get(3)?)?, is_true(used.get(4)?) == way)).or_insert(0) += 1;
        }
    }
    Some(outline)
}

fn point(records: &Records<'_>, id: u64) -> Option<DVec3> {
    let of = records.part(id, "CARTESIAN_POINT")?;
    let [x, y, z] = numbers(of.get(1)?)[..] else { return None };
    Some(DVec3::new(x, y, z))
}
