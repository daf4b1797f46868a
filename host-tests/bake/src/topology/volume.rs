//! The volume inside a closed body, by the divergence theorem.

use crate::jet::Jet;
use crate::{Axis, NurbsPatch};

/// Gauss's points and weights on `[0, 1]`, exact up to degree 9.
const GAUSS: [[f64; 2]; 5] = [
    [0.046_910_077_030_668, 0.118_463_442_528_094_5],
    [0.230_765_344_947_158_45, 0.239_314_335_249_683_2],
    [0.5, 0.284_444_444_444_444_4],
    [0.769_234_655_052_841_6, 0.239_314_335_249_683_2],
    [0.953_089_922_969_332, 0.118_463_442_528_094_5],
];

/// `∮ P · N dA / 3`, m³. Of polynomial patches up to degree 3 exact up to rounding; only its sign and its being 0 are
/// asked for.
pub fn volume(patches: &[NurbsPatch]) -> f64 {
    patches.iter().map(flux).sum::<f64>() / 3.0
}

/// `∫ P · N dA` of one patch.
fn flux(patch: &NurbsPatch) -> f64 {
    let nodes = |axis| {
        let on_span = |pair: &[f64]| {
            let (start, width) = (pair[0], pair[1] - pair[0]);
            GAUSS.map(|[at, weight]| [start + width * at, width * weight])
        };
        patch.borders(axis).windows(2).flat_map(on_span).collect::<Vec<_>>()
    };
    let along_v = nodes(Axis::V);
    let at = |u: f64, v: f64| {
        let surface = Jet::of(patch, u, v);
        surface.point.dot(surface.tangent_u.cross(surface.tangent_v))
    };
    let column = |u: f64| along_v.iter().map(|[v, weight]| weight * at(u, *v)).sum::<f64>();
    let total: f64 = nodes(Axis::U).into_iter().map(|[u, weight]| weight * column(u)).sum();
    if patch.flip { -total } else { total }
}
