//! Whether a body is convex, as far as its features say.

use crate::bake::survey::{Convexity, Survey};
use crate::bake::topology::Topology;
use crate::bake::{BakedPatch, NurbsPatch};
use palpate::body::EdgeKind;

/// See [`super::BakedBody::new`] for what it takes, and what of it is proved.
pub(super) fn is_convex(topology: &Topology, patches: &[NurbsPatch], baked: &[BakedPatch]) -> bool {
    let edges = topology.edges.iter().all(|edge| matches!(edge.kind, EdgeKind::Convex | EdgeKind::Smooth));
    let face = |(patch, baked): (&NurbsPatch, &BakedPatch)| {
        matches!(Survey::new(patch, baked).convexity, Convexity::Proved | Convexity::UpToRounding(_))
    };
    edges && topology.is_closed() && topology.components() == 1 && patches.iter().zip(baked).all(face)
}
