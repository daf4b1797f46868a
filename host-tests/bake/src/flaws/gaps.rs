//! Open edges, and which of them may be two sides of one gap.

use super::flaw::Flaw;
use crate::patch::NurbsPatch;
use crate::topology::{Border, Topology};
use glam::DVec3;

/// Open borders that are nowhere farther apart than this, in sizes, are named as a seam that gapes.
const GAPING: f64 = 0.02;
/// Points of a border that are compared.
const SAMPLES: usize = 16;

/// The flaw of a body of several patches with open edges.
pub(super) fn find(patches: &[NurbsPatch], topology: &Topology) -> Option<Flaw> {
    let open: Vec<Border> =
        topology.edges.iter().filter(|edge| edge.partner.is_none()).map(|edge| edge.owner).collect();
    let first = *open.first().filter(|_| patches.len() > 1)?;
    let lines: Vec<Vec<DVec3>> = open.iter().map(|border| line(*border, &patches[border.patch])).collect();
    let place = |border: Border| [border.patch, border.side];
    let mut nearest: Option<([[usize; 2]; 2], f64)> = None;
    for (i, one) in lines.iter().enumerate() {
        for (j, other) in lines.iter().enumerate().skip(i + 1) {
            let forward = one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let backward = one.iter().zip(other.iter().rev()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            let gap = forward.min(backward);
            if gap <= nearest.map_or(GAPING * topology.size, |(_, least)| least) {
                nearest = Some(([place(open[i]), place(open[j])], gap));
            }
        }
    }
    Some(Flaw::Open { edges: open.len(), first: place(first), nearest })
}

fn line(border: Border, patch: &NurbsPatch) -> Vec<DVec3> {
    (0..=SAMPLES).map(|k| border.point(patch, k as f64 / SAMPLES as f64)).collect()
}
