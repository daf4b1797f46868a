//! Whether a body is convex, as far as its features say.

use crate::convexity::{Convexity, convexity};
use crate::topology::Topology;
use crate::{BakedPatch, NurbsPatch};
use glam::DVec3;
use palpate::body::EdgeKind;

/// See [`super::BakedBody::new`] for what it takes, and what of it is proved.
pub(super) fn is_convex(topology: &Topology, patches: &[NurbsPatch], baked: &[BakedPatch]) -> bool {
    let edges = topology.edges.iter().all(|edge| matches!(edge.kind, EdgeKind::Convex | EdgeKind::Smooth));
    let face = |(patch, baked): (&NurbsPatch, &BakedPatch)| {
        // A plane is straight all over, whatever its parameters do at a pole.
        is_plane(patch) || matches!(convexity(patch, baked), Convexity::Proved | Convexity::UpToRounding(_))
    };
    edges && topology.is_closed() && topology.components() == 1 && patches.iter().zip(baked).all(face)
}

/// Of the size: nine digits of a model file leave no more.
const FLAT: f64 = 1e-8;

/// Whether all control points lie in one plane, and with them, as means of them, all points.
fn is_plane(patch: &NurbsPatch) -> bool {
    let first = patch.points[0];
    let far = |a: &&DVec3, b: &&DVec3| a.distance(first).total_cmp(&b.distance(first));
    let Some(second) = patch.points.iter().max_by(far) else { return false };
    let along = (*second - first).normalize_or_zero();
    let across = |point: &DVec3| along.cross(*point - first);
    let Some(normal) = patch.points.iter().map(across).max_by(|a, b| a.length().total_cmp(&b.length())) else {
        return false;
    };
    let normal = normal.normalize_or_zero();
    patch.points.iter().all(|point| (*point - first).dot(normal).abs() <= FLAT * patch.size())
}
