//! What is wrong with a body as a whole, though every patch and every seam is right: it cuts itself, pieces of it cut
//! or lie in each other, or it is open where it may not be meant to be.
//!
//! Looked for on facets (`facets`); a cut counts only where the surfaces themselves are found to meet there
//! (`crossing`). That finds what is larger than the facets, and proves nothing.

mod crossing;
mod facets;
mod flaw;
mod gaps;
mod nesting;

pub use flaw::Flaw;

use crate::patch::NurbsPatch;
use crate::topology::Topology;

/// All flaws of a body.
pub fn find(patches: &[NurbsPatch], topology: &Topology) -> Vec<Flaw> {
    let facets = facets::Facets::of(patches);
    let crossings = crossing::find(patches, &facets, topology.size);
    let mut flaws = Vec::new();
    if let Some(first) = crossings.first() {
        flaws.push(Flaw::Crossing { patches: first.patches, pairs: crossings.len(), at: first.at });
    }
    // Where pieces cut each other a point of one says nothing of the rest of it.
    flaws.extend(nesting::find(patches, &facets, topology, &crossings));
    flaws.extend(gaps::find(patches, topology));
    flaws
}
