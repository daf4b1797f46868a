//! Even numbers of sides: no region with an odd number falls into quads.
//!
//! Each cut of a wire turns the parity of both its faces. Odd regions are joined in pairs by the shortest ways from
//! face to face; the wires on the way are cut. Through a region with four corners a way goes straight, and leaves it
//! even.

use super::balance;
use super::corners::{Shape, four, is_triangle};
use crate::error::ImportError;
use crate::mesh::Mesh;
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
        balance::balance(mesh);
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
