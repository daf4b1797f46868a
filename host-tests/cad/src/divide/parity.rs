//! Even numbers of sides: no region with an odd number falls into quads.
//!
//! Each cut of a wire turns the parity of both its faces. Odd regions are joined in pairs by the shortest ways from
//! face to face; the wires on the way are cut. Through a region with four corners a way goes straight, and leaves it
//! even.

use super::corners::{Shape, four, is_triangle};
use crate::error::ImportError;
use crate::mesh::{Mesh, Side};
use std::collections::{HashMap, VecDeque};

/// Cuts wires until every region has an even number of sides.
///
/// # Errors
/// If an odd region finds no way to another, nor to a free border.
pub fn even(mesh: &mut Mesh<'_>) -> Result<(), ImportError> {
    for face in 0..mesh.regions.len() {
        halve_triangle(mesh, face);
    }
    for _ in 0..2 * mesh.regions.len() + 2 {
        let Some(face) = (0..mesh.regions.len()).find(|face| is_odd(mesh, *face)) else { return Ok(()) };
        let Some(way) = way(mesh, face, false).or_else(|| way(mesh, face, true)) else {
            let reason = "its outline has an odd number of sides, and no neighbour can take the one more";
            return Err(ImportError::too_much(mesh.part, face, reason));
        };
        for wire in way {
            let at = mesh.even(wire, 2);
            mesh.cut(wire, &at);
        }
        balance(mesh)?;
    }
    let face = (0..mesh.regions.len()).find(|face| is_odd(mesh, *face));
    face.map_or(Ok(()), |face| Err(ImportError::too_much(mesh.part, face, "its outline keeps an odd number of sides")))
}

/// A triangle among odd regions is cut on all sides: three quads, and its neighbours are even.
fn halve_triangle(mesh: &mut Mesh<'_>, face: usize) {
    if !is_triangle(mesh, face) {
        return;
    }
    let wires: Vec<usize> =
        mesh.regions[face].loops[0].iter().filter_map(|side| side.wire.map(|(wire, _)| wire)).collect();
    let is_beside_odd = |wire: &usize| {
        let has = |other: usize| {
            mesh.regions[other].loops.iter().flatten().any(|side| side.wire.is_some_and(|(of, _)| of == *wire))
        };
        (0..mesh.regions.len()).any(|other| other != face && is_odd(mesh, other) && has(other))
    };
    if wires.iter().all(is_beside_odd) {
        for wire in wires {
            let at = mesh.even(wire, 2);
            mesh.cut(wire, &at);
        }
    }
}

/// Whether a region has an odd number of sides and is no triangle, which becomes a quad with a side of no length.
fn is_odd(mesh: &Mesh<'_>, face: usize) -> bool {
    let loops = &mesh.regions[face].loops;
    let count: usize = loops.iter().map(Vec::len).sum();
    count % 2 == 1 && !is_triangle(mesh, face)
}

/// The wires to cut between an odd region and the nearest other one, or a triangle if that is allowed, or a wire with
/// one face.
fn way(mesh: &Mesh<'_>, from: usize, into_triangles: bool) -> Option<Vec<usize>> {
    let mut faces: HashMap<usize, Vec<usize>> = HashMap::new();
    for (face, region) in mesh.regions.iter().enumerate() {
        for side in region.loops.iter().flatten() {
            if let Some((wire, _)) = side.wire {
                faces.entry(wire).or_default().push(face);
            }
        }
    }
    // Breadth first over faces and the wire by which each was entered.
    let mut queue: VecDeque<State> = VecDeque::from([(from, None)]);
    let mut before: HashMap<State, State> = HashMap::new();
    while let Some((face, entered)) = queue.pop_front() {
        let is_end = is_odd(mesh, face) || into_triangles && is_triangle(mesh, face);
        if entered.is_some() && face != from && is_end {
            return Some(back((face, entered), &before));
        }
        if ends_in_pole(mesh, face, entered) {
            return Some(back((face, entered), &before));
        }
        for wire in exits(mesh, face, entered) {
            let beyond = faces[&wire].iter().copied().find(|other| *other != face);
            match beyond {
                // Of the same face on both sides: its parity stays.
                None if faces[&wire].len() > 1 => {}
                None => {
                    let mut way = back((face, entered), &before);
                    way.push(wire);
                    return Some(way);
                }
                Some(next) => {
                    let state = (next, Some(wire));
                    if next != from && !before.contains_key(&state) {
                        before.insert(state, (face, entered));
                        queue.push_back(state);
                    }
                }
            }
        }
    }
    None
}

/// A region, and the wire by which it was come to.
type State = (usize, Option<usize>);

fn back(mut state: State, before: &HashMap<State, State>) -> Vec<usize> {
    let mut way = Vec::new();
    while let Some(wire) = state.1 {
        way.push(wire);
        let Some(earlier) = before.get(&state) else { break };
        state = *earlier;
    }
    way.reverse();
    way
}

/// Whether the side opposite the one by which a region with four corners was entered is a pole: it is cut without a
/// neighbour.
fn ends_in_pole(mesh: &Mesh<'_>, face: usize, entered: Option<usize>) -> bool {
    let (Some(entered), Shape::Grid(starts)) = (entered, Shape::of(mesh, face)) else { return false };
    let all = four(&mesh.regions[face].loops[0], starts);
    let on = |sides: &[&crate::mesh::Side]| sides.iter().any(|side| side.wire.is_some_and(|(of, _)| of == entered));
    (0..4).find(|k| on(&all[*k])).is_some_and(|k| all[(k + 2) % 4].iter().all(|side| side.wire.is_none()))
}

/// The wires by which a way may leave a face: of one with four corners, those opposite.
fn exits(mesh: &Mesh<'_>, face: usize, entered: Option<usize>) -> Vec<usize> {
    let loops = &mesh.regions[face].loops;
    if entered.is_some() && is_triangle(mesh, face) {
        // A triangle would become a pentagon.
        return Vec::new();
    }
    let wires = |side: &crate::mesh::Side| side.wire.map(|(wire, _)| wire).filter(|wire| Some(*wire) != entered);
    if let (Some(entered), Shape::Grid(starts)) = (entered, Shape::of(mesh, face)) {
        let all = four(&loops[0], starts);
        let on = |sides: &[&crate::mesh::Side]| sides.iter().any(|side| side.wire.is_some_and(|(of, _)| of == entered));
        if let Some(k) = (0..4).find(|k| on(&all[*k])) {
            return all[(k + 2) % 4].iter().filter_map(|side| wires(side)).collect();
        }
    }
    loops.iter().flatten().filter_map(wires).collect()
}

// Cuts handed on: a region with four corners wants as many cuts on a side as on the one opposite, at about the same
// places.

/// Cuts sides until opposite ones of every region with four corners agree.
///
/// # Errors
/// If that does not end, as where a face meets itself through others, once more cut on one side: the face that asks for
/// the most cuts.
pub fn balance(mesh: &mut Mesh<'_>) -> Result<(), ImportError> {
    let most = 4 * mesh.wires.len() + 400;
    let before = (mesh.part.is_loose && mesh.loose.len() < 8).then(|| mesh.clone());
    let mut lengths = HashMap::new();
    // How often each face was, and where nothing is to be cut until a side of the face is.
    let mut asked = vec![0; mesh.regions.len()];
    let mut settled = vec![false; mesh.regions.len()];
    while mesh.wires.len() < most {
        let open = (0..mesh.regions.len()).find_map(|face| {
            let cut = if settled[face] || mesh.loose.contains(&face) { None } else { wanted(mesh, face, &mut lengths) };
            settled[face] = cut.is_none();
            cut.map(|(place, at)| (face, place, at))
        });
        let Some((face, place, at)) = open else { return Ok(()) };
        asked[face] += 1;
        let wire = mesh.regions[face].loops[0][place].wire.map(|(wire, _)| wire);
        for (other, region) in mesh.regions.iter().enumerate() {
            let has = |side: &Side| side.wire.map(|(of, _)| of) == wire;
            settled[other] &= other != face && !region.loops.iter().flatten().any(has);
        }
        cut_at(mesh, face, place, at);
    }
    let busiest = (0..asked.len()).max_by_key(|face| asked[*face]).unwrap_or(0);
    if let Some(mut before) = before {
        before.loose.push(busiest);
        *mesh = before;
        return balance(mesh);
    }
    let reason = "cuts across it come back to it without end, as where it winds round more than once";
    Err(ImportError::too_much(mesh.part, busiest, reason))
}

/// Cuts one side of a face's outer outline at a parameter.
pub fn cut_at(mesh: &mut Mesh<'_>, face: usize, place: usize, at: f64) {
    let side = mesh.regions[face].loops[0][place].clone();
    if let Some((wire, against)) = side.wire {
        mesh.cut(wire, &[if against { 1.0 - at } else { at }]);
        return;
    }
    let middle = side.path.at(at);
    let parts =
        [Side::pole(side.ends[0], side.path.start(), middle), Side::pole(side.ends[0], middle, side.path.end())];
    mesh.regions[face].loops[0].splice(place..=place, parts);
}

/// A side that is to be cut, and where.
fn wanted(mesh: &Mesh<'_>, face: usize, lengths: &mut HashMap<usize, f64>) -> Option<(usize, f64)> {
    let Shape::Grid(starts) = Shape::of(mesh, face) else { return None };
    let sides = &mesh.regions[face].loops[0];
    let all = four(sides, starts);
    for k in 0..2 {
        let (a, b) = (&all[k], &all[k + 2]);
        if a.len() == b.len() {
            continue;
        }
        let (many, few, start) = if a.len() > b.len() { (a, b, starts[k + 2]) } else { (b, a, starts[k]) };
        // Where the longer list is cut, seen from the other end.
        let wished: Vec<f64> = shares(mesh, many, lengths).iter().map(|share| 1.0 - share).collect();
        let borders = shares(mesh, few, lengths);
        let lonely = |share: &f64| borders.iter().map(|border| (border - share).abs()).fold(f64::INFINITY, f64::min);
        let share = wished.iter().copied().max_by(|x, y| lonely(x).total_cmp(&lonely(y)))?;
        let ends: Vec<f64> = [0.0].into_iter().chain(borders).chain([1.0]).collect();
        let piece = ends.windows(2).position(|pair| share >= pair[0] && share <= pair[1])?;
        let (low, high) = (ends[piece], ends[piece + 1]);
        // Never a sliver: at worst the middle of the longest piece.
        let at = (share - low) / (high - low).max(f64::MIN_POSITIVE);
        let (piece, at) = if (0.05..=0.95).contains(&at) {
            (piece, at)
        } else {
            let widest =
                (0..ends.len() - 1).max_by(|i, j| (ends[i + 1] - ends[*i]).total_cmp(&(ends[j + 1] - ends[*j])))?;
            (widest, 0.5)
        };
        return Some(((start + piece) % sides.len(), at));
    }
    None
}

/// The shares of the length at which a list of sides is cut; of poles, of their number. `known` has lengths of wires.
fn shares(mesh: &Mesh<'_>, sides: &[&Side], known: &mut HashMap<usize, f64>) -> Vec<f64> {
    let mut length = |wire: usize| *known.entry(wire).or_insert_with(|| mesh.extent(wire).0);
    let lengths: Vec<f64> = sides.iter().map(|side| side.wire.map_or(1e-12, |(wire, _)| length(wire))).collect();
    let whole: f64 = lengths.iter().sum();
    let mut sum = 0.0;
    let mut along = |length: &f64| {
        sum += length;
        sum / whole
    };
    lengths[..lengths.len() - 1].iter().map(&mut along).collect()
}
