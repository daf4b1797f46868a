//! Where patches cut each other.
//!
//! Facets that cut each other are a hint: between two curved surfaces that lie near each other facets cut where the
//! surfaces do not. From each hint Newton's method looks for a point of both surfaces, inside both patches, at which
//! they are not tangent.

use super::facets::{Cell, Facets};
use crate::jet::Jet;
use crate::parallel;
use crate::patch::NurbsPatch;
use glam::{DMat3, DVec3};

/// Two patches that cut each other, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub patches: [usize; 2],
    pub at: DVec3,
}

/// Points of facets nearer than this, in sizes, are one: neighbours share their edge to 1e-6.
const SAME: f64 = 2e-6;
/// Surfaces meet where Newton's method leaves less than this, in sizes.
const MET: f64 = 1e-9;
/// A point this near to a border, of the parameter's range, is on it: bodies that only touch meet at borders.
const BORDER: f64 = 1e-3;
/// Normals at a smaller sine are those of surfaces that touch.
const TRANSVERSAL: f64 = 1e-3;
/// On one patch, places with parameters nearer than this are one place.
const APART: f64 = 1e-2;
/// Hints that are followed for one pair of patches: along a cut each is as good as the next.
const HINTS: usize = 16;

/// One crossing of every pair of patches that cut each other.
pub(super) fn find(patches: &[NurbsPatch], facets: &Facets, size: f64) -> Vec<Crossing> {
    let meets = |[low_a, high_a]: [DVec3; 2], [low_b, high_b]: [DVec3; 2]| {
        low_a.cmple(high_b).all() && low_b.cmple(high_a).all()
    };
    let of_patch = |a: usize, cells: &Vec<Cell>| -> Vec<Crossing> {
        let beyond = (a..patches.len()).filter(|b| meets(facets.boxes[a], facets.boxes[*b]));
        let crossing = |b: usize| {
            let [low, high] = facets.boxes[b];
            let near: Vec<&Cell> = cells.iter().filter(|cell| meets([cell.low, cell.high], [low, high])).collect();
            let [low, high] = facets.boxes[a];
            let others: Vec<&Cell> =
                facets.patches[b].iter().filter(|cell| meets([cell.low, cell.high], [low, high])).collect();
            let pairs = near.iter().flat_map(|cell| others.iter().map(move |other| (*cell, *other)));
            let hints = pairs
                .filter(|(cell, other)| meets([cell.low, cell.high], [other.low, other.high]))
                .filter(|(cell, other)| !share_a_corner(cell, other, SAME * size) && cut(cell, other));
            let mut found = hints
                .take(HINTS)
                .filter_map(|(cell, other)| meeting([&patches[a], &patches[b]], a == b, cell, other, size));
            found.next().map(|at| Crossing { patches: [a, b], at })
        };
        beyond.filter_map(crossing).collect()
    };
    parallel::map(&facets.patches, of_patch).into_iter().flatten().collect()
}

fn share_a_corner(a: &Cell, b: &Cell, tolerance: f64) -> bool {
    a.corners.iter().any(|corner| b.corners.iter().any(|other| corner.distance(*other) <= tolerance))
}

/// Whether any of their triangles cut each other.
fn cut(a: &Cell, b: &Cell) -> bool {
    let pierces = |of: [DVec3; 3], triangle: [DVec3; 3]| {
        [[of[0], of[1]], [of[1], of[2]], [of[2], of[0]]].into_iter().any(|segment| pierced(triangle, segment))
    };
    let (a, b) = (a.triangles(), b.triangles());
    a.iter().any(|first| b.iter().any(|second| pierces(*first, *second) || pierces(*second, *first)))
}

/// Whether a segment goes through a triangle; one that lies in its plane does not.
fn pierced([a, b, c]: [DVec3; 3], [from, to]: [DVec3; 2]) -> bool {
    let volume = |p: DVec3, q: DVec3, r: DVec3, s: DVec3| (q - p).cross(r - p).dot(s - p);
    let (above, below) = (volume(a, b, c, from), volume(a, b, c, to));
    if above * below >= 0.0 {
        return false;
    }
    let sides = [volume(from, to, a, b), volume(from, to, b, c), volume(from, to, c, a)];
    sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
}

/// A point inside both patches at which their surfaces cut each other, from the middles of two cells.
fn meeting(patches: [&NurbsPatch; 2], is_one: bool, a: &Cell, b: &Cell, size: f64) -> Option<DVec3> {
    let mut at = [a.parameters, b.parameters];
    for _ in 0..30 {
        let jets = [0, 1].map(|k| Jet::of(patches[k], at[k][0], at[k][1]));
        let off = jets[1].point - jets[0].point;
        let tangents = [jets[0].tangent_u, jets[0].tangent_v, -jets[1].tangent_u, -jets[1].tangent_v];
        if off.length() <= MET * size {
            let normals = jets.map(|jet| jet.tangent_u.cross(jet.tangent_v).normalize_or_zero());
            let is_inside = at.iter().flatten().all(|at| (BORDER..=1.0 - BORDER).contains(at));
            let is_apart = !is_one || (0..2).any(|axis| (at[0][axis] - at[1][axis]).abs() > APART);
            let crosses = normals[0].cross(normals[1]).length() > TRANSVERSAL;
            return (is_inside && is_apart && crosses).then_some(jets[0].point);
        }
        // The shortest step in all four parameters that closes the gap: δ = Jᵀ (J Jᵀ)⁻¹ off.
        let outer = |v: DVec3| DMat3::from_cols(v * v.x, v * v.y, v * v.z);
        let gram = tangents.iter().fold(DMat3::ZERO, |sum, tangent| sum + outer(*tangent));
        let pull = gram.inverse() * off;
        if !pull.is_finite() {
            return None;
        }
        for (k, tangent) in tangents.iter().enumerate() {
            let parameter = &mut at[k / 2][k % 2];
            *parameter = (*parameter + tangent.dot(pull)).clamp(0.0, 1.0);
        }
    }
    None
}
