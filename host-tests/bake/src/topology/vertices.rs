//! Vertices: where edges end, and poles.

use super::border::Border;
use super::edges::{BorderRole, Sense, TopologyEdge};
use crate::NurbsPatch;
use crate::jet::Jet;
use glam::DVec3;
use std::f64::consts::PI;

/// A vertex with the ends of edges that meet there.
#[derive(Clone, Debug)]
pub struct TopologyVertex {
    /// Metres.
    pub point: DVec3,
    /// The edges that end here, in their order.
    pub spokes: Vec<TopologySpoke>,
    /// The unit vector along the sum of the faces' normals, each times the angle that it fills there; zero where that
    /// vanishes. A probe that is closest to the vertex is outside a closed body where it lies on this side.
    pub outward: DVec3,
}

/// One end of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopologySpoke {
    /// The edge.
    pub edge: usize,
    /// Whether it is the end at 1.
    pub at_upper_end: bool,
    /// Unit tangent away from the vertex.
    pub direction: DVec3,
}

/// Points that are one within the tolerance. The first that comes stands for all.
#[derive(Debug, Default)]
pub(super) struct Cluster {
    pub points: Vec<DVec3>,
}

impl Cluster {
    /// The index of a point's vertex, a new one if it is near none.
    pub fn place(&mut self, point: DVec3, tolerance: f64) -> usize {
        let known = self.points.iter().position(|known| known.distance(point) <= tolerance);
        known.unwrap_or_else(|| {
            self.points.push(point);
            self.points.len() - 1
        })
    }
}

/// The vertices with their spokes.
pub(super) fn with_spokes(
    points: Vec<DVec3>,
    roles: &[[BorderRole; 4]],
    edges: &[TopologyEdge],
    patches: &[NurbsPatch],
) -> Vec<TopologyVertex> {
    let outward = outward(patches, roles, edges, points.len());
    let bare = |(point, outward)| TopologyVertex { point, spokes: Vec::new(), outward };
    let mut vertices: Vec<_> = points.into_iter().zip(outward).map(bare).collect();
    for (edge, of) in edges.iter().enumerate() {
        for at_upper_end in [false, true] {
            let direction = departure(of.owner, &patches[of.owner.patch], at_upper_end);
            vertices[of.ends[usize::from(at_upper_end)]].spokes.push(TopologySpoke { edge, at_upper_end, direction });
        }
    }
    vertices
}

/// A derivative shorter than this, beside the next one, is nothing but rounding.
const VANISHING: f64 = 1e-9;

/// The direction in which a border leaves one of its ends: that of its first derivative which does not vanish there,
/// the second if the first does, a chord if both do.
fn departure(border: Border, patch: &NurbsPatch, at_upper_end: bool) -> DVec3 {
    let (t, inward) = if at_upper_end { (1.0, -1.0) } else { (0.0, 1.0) };
    let at = border.at(patch, t);
    let chord = |reach: f64| border.point(patch, t + inward * reach) - at.point;
    let scale = chord(0.5).length();
    if at.tangent.length() > VANISHING * scale {
        (at.tangent * inward).normalize()
    } else if at.second.length() > VANISHING * scale {
        at.second.normalize()
    } else {
        chord(1e-4).normalize_or_zero()
    }
}

// Which way is out at a vertex.
//
// The tangent cone of the surface at a vertex is made of rays; the part of a face is swept by a unit direction `d`,
// and its normal there times the angle swept is `d × dd`, up to the sense. `N = ∮ d × dd` over all faces is the
// angle-weighted pseudonormal, for planar and for curved cones alike.
//
// # Why its sign is right
// By the divergence theorem on the part of a small ball that is inside the body, `N = −∫ s dω` over the directions `s`
// that lead inside. Where the vertex is the closest point of a probe in the direction `q`, no ray of the cone has `d ·
// q > 0`: the half space beyond the plane normal to `q` has no surface in it, so it is inside altogether or outside
// altogether, and with it the probe. Outside, every `s` has `s · q ≤ 0` and `N · q ≥ 0`; inside the same holds of the
// complement, whose integral is `−N`, and `N · q ≤ 0` (after J. Bærentzen and H. Aanæs, *Signed distance computation
// using the angle weighted pseudonormal*, 2005, who show it of polyhedra).

/// Number of rays of the cone that the sum along a pole uses; for the cone of these rays the sum is exact.
const STEPS: usize = 256;
/// A vector shorter than this, relative to its terms, is rounding.
const CONE_VANISHING: f64 = 1e-9;
/// The sine below which two opposite rays span no plane.
const OPPOSITE: f64 = 1e-6;
/// Where the cone fills no angle, as at the tip of a cusp, its rays are chords of this much of the parameters.
const CHORD: f64 = 1e-3;

/// For every vertex the unit vector along `N`; zero where it vanishes.
pub(super) fn outward(
    patches: &[NurbsPatch],
    roles: &[[BorderRole; 4]],
    edges: &[TopologyEdge],
    vertices: usize,
) -> Vec<DVec3> {
    let tangents = sums(patches, roles, edges, vertices, Rays::Tangents);
    let is_known = |(sum, weight): &(DVec3, f64)| sum.length() > CONE_VANISHING * weight;
    if tangents.iter().all(is_known) {
        return tangents.iter().map(|(sum, _)| sum.normalize()).collect();
    }
    let chords = sums(patches, roles, edges, vertices, Rays::Chords);
    let best =
        tangents.into_iter().zip(chords).map(|(tangents, chords)| if is_known(&tangents) { tangents } else { chords });
    best.map(|sum| if is_known(&sum) { sum.0.normalize() } else { DVec3::ZERO }).collect()
}

/// Representation of the rays of the tangent cone.
#[derive(Clone, Copy, PartialEq)]
enum Rays {
    Tangents,
    Chords,
}

/// `N` of every vertex, and the angle that was summed.
fn sums(
    patches: &[NurbsPatch],
    roles: &[[BorderRole; 4]],
    edges: &[TopologyEdge],
    vertices: usize,
    rays: Rays,
) -> Vec<(DVec3, f64)> {
    let mut sums = vec![(DVec3::ZERO, 0.0); vertices];
    let mut add = |vertex: usize, (sum, angle): (DVec3, f64)| {
        sums[vertex].0 += sum;
        sums[vertex].1 += angle;
    };
    for (patch, roles) in patches.iter().zip(roles) {
        let is_pole = |side: usize| matches!(roles[side], BorderRole::Pole { .. });
        for (side, role) in roles.iter().enumerate() {
            if let BorderRole::Pole { vertex } = role {
                add(*vertex, swept_along_pole(patch, side, rays));
            }
        }
        for corner in 0..4 {
            let [u, v] = [corner & 1, corner >> 1];
            // Of the corners at a pole the pole has taken care.
            if let BorderRole::Edge { edge, sense } = roles[u]
                && !is_pole(2 + v)
            {
                let end = if sense == Sense::Reversed { 1 - v } else { v };
                add(edges[edge].ends[end], at_corner(patch, [u, v].map(|end| end as f64), rays));
            }
        }
    }
    sums
}

/// `∫ d × dd` around a pole, in the sense of the outward normal.
fn swept_along_pole(patch: &NurbsPatch, side: usize, rays: Rays) -> (DVec3, f64) {
    let (is_along_v, pole) = (side < 2, (side % 2) as f64);
    let at = |along: f64, away: f64| {
        let across = pole + (1.0 - 2.0 * pole) * away;
        if is_along_v { [across, along] } else { [along, across] }
    };
    let rays = (0..=STEPS).map(|step| {
        let along = step as f64 / STEPS as f64;
        let across = if is_along_v { 0 } else { 1 };
        ray(patch, at(along, 0.0), |reach| at(along, reach), across, 1.0 - 2.0 * pole, rays)
    });
    // With `a d` the derivative away from the pole, `f_u × f_v` is `a² d × d'` beside `u = 0` and `v = 1`, and the
    // opposite beside the two others.
    let turn = if (side == 0 || side == 3) != patch.flip { 1.0 } else { -1.0 };
    fan(&rays.collect::<Vec<_>>(), turn, || inner_normal(patch, at(0.5, CHORD)))
}

/// The sector of a face at a corner.
fn at_corner(patch: &NurbsPatch, corner: [f64; 2], rays: Rays) -> (DVec3, f64) {
    let inward = corner.map(|at| 1.0 - 2.0 * at);
    let along = |axis: usize| {
        let moved = |reach: f64| {
            let mut at = corner;
            at[axis] += inward[axis] * reach;
            at
        };
        ray(patch, corner, moved, axis, inward[axis], rays)
    };
    let within = [0, 1].map(|axis| corner[axis] + inward[axis] * CHORD);
    let mut directions = vec![along(0), along(1)];
    if rays == Rays::Chords {
        directions.insert(1, chord(patch, corner, within));
    }
    let turn = if (inward[0] * inward[1] > 0.0) != patch.flip { 1.0 } else { -1.0 };
    fan(&directions, turn, || inner_normal(patch, within))
}

/// The unit direction in which a curve of the patch leaves a point.
fn ray(
    patch: &NurbsPatch,
    from: [f64; 2],
    moved: impl Fn(f64) -> [f64; 2],
    axis: usize,
    inward: f64,
    rays: Rays,
) -> DVec3 {
    if rays == Rays::Tangents {
        let surface = Jet::of(patch, from[0], from[1]);
        let tangent = if axis == 0 { surface.tangent_u } else { surface.tangent_v };
        let [u, v] = moved(0.5);
        if tangent.length() > CONE_VANISHING * Jet::of(patch, u, v).point.distance(surface.point) {
            return (tangent * inward).normalize();
        }
    }
    chord(patch, from, moved(CHORD))
}

fn chord(patch: &NurbsPatch, [u, v]: [f64; 2], to: [f64; 2]) -> DVec3 {
    (Jet::of(patch, to[0], to[1]).point - Jet::of(patch, u, v).point).normalize_or_zero()
}

fn inner_normal(patch: &NurbsPatch, [u, v]: [f64; 2]) -> DVec3 {
    let surface = Jet::of(patch, u, v);
    let normal = surface.tangent_u.cross(surface.tangent_v).normalize_or_zero();
    if patch.flip { -normal } else { normal }
}

/// The sum over the plane sectors between rays that follow each other. Where two are opposite, or the same, the plane
/// is `normal`'s.
fn fan(rays: &[DVec3], turn: f64, normal: impl Fn() -> DVec3) -> (DVec3, f64) {
    rays.windows(2).fold((DVec3::ZERO, 0.0), |(sum, swept), pair| {
        let cross = pair[0].cross(pair[1]);
        let (sine, cosine) = (cross.length(), pair[0].dot(pair[1]));
        let angle = sine.atan2(cosine);
        // Nearly opposite rays say nothing of the plane: the decimals of a model turn them by as much.
        let is_plane = sine > OPPOSITE || cosine > 0.0;
        // For a small angle the cross product itself, which is exact there.
        let unit = if !is_plane { normal() } else { cross * (turn / sine.max(f64::MIN_POSITIVE)) };
        (sum + unit * angle.min(PI), swept + angle)
    })
}
