//! Faces that lie the wrong way round: a file that says so against all their neighbours is taken to be mistaken.
//!
//! A face whose loops enclose the outside of it has them turned. Then every edge that two faces share must be run
//! along once each way, seen from outside; of each piece of the body the faces are turned that are fewer.
//!
//! A loop on a surface that closes on itself bounds two faces, one on either side. Such a face may be turned by its
//! sense, or by its loops: then it is the other part of the surface. The part is right that does not fold back along its
//! edges onto its neighbours; if neither does, the one that has the seam of the file.

use crate::error::ImportError;
use crate::heal::Seam;
use crate::mesh::Mesh;
use crate::part::Part;
use crate::trace::{self, Traced};
use glam::DVec3;

/// Reverses faces with the wrong orientation; `tolerance` is the maximum distance of an edge from its face,
/// millimetres.
///
/// # Errors
/// A fault of a loop.
pub fn turn(part: &mut Part, seams: &[Seam], tolerance: f64) -> Result<(), ImportError> {
    let mut inside_out = Vec::new();
    let mut borders = Vec::new();
    let mesh = Mesh::new(part);
    for (face, of) in part.faces.iter().enumerate() {
        let loops = of.loops.iter().map(|uses| trace::trace(&mesh, face, uses, tolerance));
        let loops = loops.collect::<Result<Vec<_>, _>>()?;
        borders.push(borders_of(part, face, &loops));
        if is_inside_out(part, face, &loops) {
            inside_out.push(face);
        }
    }
    for face in inside_out {
        reverse_loops(part, face, &mut borders);
    }
    turn_the_fewer(part, seams, &mut borders)
}

/// The unit vectors from an edge into a face, at [`SHARES`] of the edge.
struct Border {
    edge: usize,
    inward: [DVec3; SHARES.len()],
}

const SHARES: [f64; 3] = [0.25, 0.5, 0.75];
/// Cosine of the angle between two faces below which they lie on each other: less than a degree.
const FOLDED: f64 = 0.9999;

fn borders_of(part: &Part, face: usize, loops: &[Traced]) -> Vec<Border> {
    let surface = &part.faces[face].surface;
    let sides = loops.iter().flat_map(|of| &of.sides);
    let border = |(edge, reversed, path): (usize, bool, &crate::path::Path)| {
        let inward = SHARES.map(|share| {
            let (t, way) = if reversed { (1.0 - share, -1.0) } else { (share, 1.0) };
            surface.normal(path.at(t)).cross(part.edges[edge].at(share)[1] * way).normalize_or_zero()
        });
        Border { edge, inward }
    };
    sides.filter_map(|side| side.wire.map(|(edge, reversed)| (edge, reversed, &side.path))).map(border).collect()
}

fn reverse_loops(part: &mut Part, face: usize, borders: &mut [Vec<Border>]) {
    part.faces[face].is_healed = true;
    for uses in &mut part.faces[face].loops {
        uses.reverse();
        uses.iter_mut().for_each(|used| used.reversed = !used.reversed);
    }
    borders[face].iter_mut().for_each(|border| border.inward = border.inward.map(|inward| -inward));
}

/// Whether a face lies on a neighbour along an edge of theirs; with its loops as they are (1) or reversed (−1).
fn folds(face: usize, borders: &[Vec<Border>], sense: f64) -> bool {
    borders[face].iter().any(|own| {
        let others = borders.iter().enumerate().filter(|(other, _)| *other != face).flat_map(|(_, of)| of);
        others
            .filter(|other| other.edge == own.edge)
            .any(|other| own.inward.iter().zip(other.inward).all(|(own, other)| sense * own.dot(other) > FOLDED))
    })
}

/// Whether the seams of a face go off its edges into it, as its loops run; `None` if it had none.
fn holds_seams(part: &Part, face: usize, seams: &[Seam]) -> Option<bool> {
    let of = &part.faces[face];
    let into = |seam: &Seam| {
        let used = of.loops.iter().flatten().find(|used| part.ends(**used)[0] == seam.start)?;
        let edge = &part.edges[used.edge];
        let along = if used.reversed { -edge.at(1.0)[1] } else { edge.at(0.0)[1] };
        let normal = of.surface.normal(of.surface.locate(part.vertices[seam.start]).uv);
        Some(normal.cross(along).normalize_or_zero().dot(seam.along.normalize_or_zero()))
    };
    let all: Vec<f64> = seams.iter().filter(|seam| seam.face == face).filter_map(into).collect();
    let is_decided = !all.is_empty() && (all.iter().all(|into| *into > 0.1) || all.iter().all(|into| *into < -0.1));
    is_decided.then(|| all[0] > 0.0)
}

/// Whether the surface of a face closes on itself, so that its loops bound another face on their other side.
fn has_other_side(part: &Part, face: usize) -> bool {
    let surface = &part.faces[face].surface;
    (0..2).any(|axis| surface.closed[axis] && (surface.closed[1 - axis] || surface.poles[1 - axis] == [true; 2]))
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
    if has_other_side(part, face) || loops.is_empty() || loops.iter().any(|of| of.winding != [0, 0]) {
        return false;
    }
    let areas = loops.iter().map(|of| trace::area(&of.sides));
    areas.max_by(|a, b| a.abs().total_cmp(&b.abs())).is_some_and(|largest| largest < 0.0)
}

/// Turns, in each piece of the body, the faces that disagree with the most others.
fn turn_the_fewer(part: &mut Part, seams: &[Seam], borders: &mut [Vec<Border>]) -> Result<(), ImportError> {
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
            let is_other_side = has_other_side(part, face);
            if is_other_side {
                let folds = [1.0, -1.0].map(|sense| folds(face, borders, sense));
                match (folds, holds_seams(part, face, seams)) {
                    ([true, false], _) | ([false, false], Some(false)) => {
                        reverse_loops(part, face, borders);
                        let label = part.faces[face].label();
                        part.remarks
                            .push(format!("healed: the outline of {label} runs the wrong way round in the file"));
                        continue;
                    }
                    ([false, true], _) | ([false, false], Some(true)) => {}
                    _ => {
                        let reason = "its outline runs the same way as its neighbours', and bounds two parts of its \
                                      surface: the file does not say which; export the part again, with the face split";
                        return Err(ImportError::face(part.faces[face].label(), reason));
                    }
                }
            }
            let of = &mut part.faces[face];
            of.flip = !of.flip;
            part.remarks.push(format!("healed: {} lies the wrong way round in the file", of.label()));
        }
    }
    Ok(())
}
