//! Cuts that run on: a border that is cut is cut for its other face as well, and so across that face to the next, until
//! the cut ends at a pole or an open border or comes back. Otherwise edges would meet only in part.

use super::{Piece, cut_in_two};
use crate::topology::Topology;

/// A cut through a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// Index of the piece.
    pub piece: usize,
    /// The parameter that is cut: 0 for `u`, 1 for `v`.
    pub axis: usize,
    /// Where, between 0 and 1.
    pub at: f64,
}

/// Cuts nearer to each other or to a border than this are one: a span of `f32` borders cannot be narrower than a few of
/// its units.
const NEAREST: f64 = 1e-5;

/// Cuts pieces, and all that the cuts run through.
pub fn cut(pieces: &[Piece], topology: &Topology, wanted: &[Cut]) -> Vec<Piece> {
    let mut cuts: Vec<[Vec<f64>; 2]> = vec![[Vec::new(), Vec::new()]; pieces.len()];
    let mut open = wanted.to_vec();
    while let Some(Cut { piece, axis, at }) = open.pop() {
        let known = &mut cuts[piece][axis];
        // Also refuses NaN.
        let is_inside = at > NEAREST && at < 1.0 - NEAREST;
        if !is_inside || known.iter().any(|other| (other - at).abs() < NEAREST) {
            continue;
        }
        known.push(at);
        // The cut ends on both borders along which its parameter runs.
        for edge in &topology.edges {
            let Some((partner, sense)) = edge.partner else { continue };
            for (from, to) in [(edge.owner, partner), (partner, edge.owner)] {
                if from.patch == piece && from.axis() == axis {
                    open.push(Cut { piece: to.patch, axis: to.axis(), at: sense.apply(at) });
                }
            }
        }
    }
    let mut all = Vec::new();
    for (piece, mut cuts) in pieces.iter().zip(cuts) {
        cuts.iter_mut().for_each(|cuts| cuts.sort_by(f64::total_cmp));
        let strips = along(piece.clone(), 0, &cuts[0]);
        all.extend(strips.into_iter().flat_map(|strip| along(strip, 1, &cuts[1])));
    }
    all
}

/// A piece cut along one axis, the lowest part first.
fn along(piece: Piece, axis: usize, cuts: &[f64]) -> Vec<Piece> {
    let source = piece.source;
    let (mut parts, mut rest, mut low) = (Vec::new(), piece.patch, 0.0);
    for at in cuts {
        let [below, above] = cut_in_two(&rest, axis, (at - low) / (1.0 - low));
        parts.push(Piece { patch: below, source: source.part(axis, low, *at) });
        (rest, low) = (above, *at);
    }
    parts.push(Piece { patch: rest, source: source.part(axis, low, 1.0) });
    parts
}
