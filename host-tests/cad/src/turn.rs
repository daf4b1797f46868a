//! Faces that lie the wrong way round: a file that says so against all their neighbours is taken to be mistaken.
//!
//! A face whose loops enclose the outside of it has them turned. Then every edge that two faces share must be run
//! along once each way, seen from outside; of each piece of the body the faces are turned that are fewer.

use crate::error::ImportError;
use crate::mesh::Mesh;
use crate::part::Part;
use crate::trace::{self, Traced};

/// Reverses faces with the wrong orientation; `tolerance` is the maximum distance of an edge from its face,
/// millimetres.
///
/// # Errors
/// A fault of a loop.
pub fn turn(part: &mut Part, tolerance: f64) -> Result<(), ImportError> {
    let mut inside_out = Vec::new();
    let mesh = Mesh::new(part);
    for (face, of) in part.faces.iter().enumerate() {
        let loops = of.loops.iter().map(|uses| trace::trace(&mesh, face, uses, tolerance));
        let loops = loops.collect::<Result<Vec<_>, _>>()?;
        if is_inside_out(part, face, &loops) {
            inside_out.push(face);
        }
    }
    for face in inside_out {
        for uses in &mut part.faces[face].loops {
            uses.reverse();
            uses.iter_mut().for_each(|used| used.reversed = !used.reversed);
        }
    }
    turn_the_fewer(part);
    Ok(())
}

/// Whether the loops of a face go the wrong way about it.
fn is_inside_out(part: &Part, face: usize, loops: &[Traced]) -> bool {
    let surface = &part.faces[face].surface;
    for axis in 0..2 {
        // Between two loops that go round: the face lies on the left, above a loop along rising u.
        let round = |sign: i32| loops.iter().find(|of| of.winding[axis] == sign);
        if let (Some(a), Some(b)) = (round(1), round(-1)) {
            let [rising, falling] = [a, b].map(|of| of.sides[0].path.start()[1 - axis]);
            return !surface.closed[1 - axis] && (rising > falling) == (axis == 0);
        }
    }
    let is_closed =
        (0..2).any(|axis| surface.closed[axis] && (surface.closed[1 - axis] || surface.poles[1 - axis] == [true; 2]));
    if is_closed || loops.is_empty() || loops.iter().any(|of| of.winding != [0, 0]) {
        return false;
    }
    let areas = loops.iter().map(|of| trace::area(&of.sides));
    areas.max_by(|a, b| a.abs().total_cmp(&b.abs())).is_some_and(|largest| largest < 0.0)
}

/// Turns, in each piece of the body, the faces that disagree with the most others.
fn turn_the_fewer(part: &mut Part) {
    let mut uses: Vec<Vec<(usize, bool)>> = vec![Vec::new(); part.edges.len()];
    for (face, of) in part.faces.iter().enumerate() {
        for used in of.loops.iter().flatten() {
            uses[used.edge].push((face, used.reversed != of.flip));
        }
    }
    let mut beside: Vec<Vec<(usize, bool)>> = vec![Vec::new(); part.faces.len()];
    for uses in &uses {
        if let [(a, sense), (b, other)] = uses[..]
            && a != b
        {
            beside[a].push((b, sense == other));
            beside[b].push((a, sense == other));
        }
    }
    let mut turned: Vec<Option<bool>> = vec![None; part.faces.len()];
    for first in 0..part.faces.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let (mut piece, mut next) = (vec![first], 0);
        while next < piece.len() {
            let face = piece[next];
            next += 1;
            for (other, differs) in &beside[face] {
                if turned[*other].is_none() {
                    turned[*other] = turned[face].map(|turned| turned != *differs);
                    piece.push(*other);
                }
            }
        }
        let (these, those): (Vec<_>, Vec<_>) = piece.into_iter().partition(|face| turned[*face] == Some(true));
        for face in if these.len() <= those.len() { these } else { those } {
            let of = &mut part.faces[face];
            of.flip = !of.flip;
            part.remarks.push(format!("healed: {} lies the wrong way round in the file", of.label()));
        }
    }
}
