//! Removes artefacts of the file format.
//!
//! Seams of closed surfaces are no features: an edge that a face uses in both senses is removed, which splits the loop
//! in two.

use crate::part::{Part, Use};
use glam::DVec3;

/// A seam that was taken out, seen from one of its ends.
pub struct Seam {
    /// The face that it closes.
    pub face: usize,
    /// Its vertex.
    pub start: usize,
    /// Its direction there, off the vertex.
    pub along: DVec3,
}

/// Takes the seams out of every face whose surface closes smoothly, and gives them.
pub fn take_out_seams(part: &mut Part) -> Vec<Seam> {
    let mut seams = Vec::new();
    for face in 0..part.faces.len() {
        if part.faces[face].surface.closed == [false; 2] {
            continue;
        }
        let all: Vec<Use> = part.faces[face].loops.concat();
        let is_seam = |used: &Use| all.contains(&Use { reversed: !used.reversed, ..*used });
        if !all.iter().any(is_seam) {
            continue;
        }
        for used in all.iter().filter(|used| is_seam(used)) {
            let edge = &part.edges[used.edge];
            let along = if used.reversed { -edge.at(1.0)[1] } else { edge.at(0.0)[1] };
            seams.push(Seam { face, start: part.ends(*used)[0], along });
        }
        let loops: Vec<Vec<Use>> = part.faces[face].loops.clone();
        let mut chained = Vec::new();
        for uses in loops {
            // In the order of the loop, so that at a vertex that is passed twice the right one follows.
            let mut left: Vec<Use> = uses.iter().copied().filter(|used| !is_seam(used)).collect();
            while !left.is_empty() {
                let mut chain = vec![left.remove(0)];
                let start = part.ends(chain[0])[0];
                loop {
                    let end = part.ends(chain[chain.len() - 1])[1];
                    if end == start {
                        break;
                    }
                    let Some(next) = left.iter().position(|used| part.ends(*used)[0] == end) else { break };
                    chain.push(left.remove(next));
                }
                chained.push(chain);
            }
        }
        part.faces[face].loops = chained;
    }
    seams
}
