//! Cuts handed on: a region with four corners wants as many cuts on a side as on the one opposite, at about the same
//! places.

use super::corners::{Shape, four};
use crate::mesh::{Mesh, Side};

/// Cuts sides until opposite ones of every region with four corners agree. Gives up on those that would make more than
/// so many wires: they are divided as they are.
pub fn balance(mesh: &mut Mesh<'_>) {
    let most = 4 * mesh.wires.len() + 400;
    while mesh.wires.len() < most {
        let Some((face, place, at)) = (0..mesh.regions.len()).find_map(|face| wanted(mesh, face)) else { return };
        cut_at(mesh, face, place, at);
    }
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
fn wanted(mesh: &Mesh<'_>, face: usize) -> Option<(usize, usize, f64)> {
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
        let wished: Vec<f64> = shares(mesh, many).iter().map(|share| 1.0 - share).collect();
        let borders = shares(mesh, few);
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
        return Some((face, (start + piece) % sides.len(), at));
    }
    None
}

/// The shares of the length at which a list of sides is cut; of poles, of their number.
fn shares(mesh: &Mesh<'_>, sides: &[&Side]) -> Vec<f64> {
    let length = |side: &&Side| side.wire.map_or(1e-12, |(wire, _)| mesh.extent(wire).0);
    let lengths: Vec<f64> = sides.iter().map(length).collect();
    let whole: f64 = lengths.iter().sum();
    let mut sum = 0.0;
    let mut along = |length: &f64| {
        sum += length;
        sum / whole
    };
    lengths[..lengths.len() - 1].iter().map(&mut along).collect()
}
