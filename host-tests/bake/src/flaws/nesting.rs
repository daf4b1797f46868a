//! Closed pieces that lie in each other.
//!
//! The winding number of a closed piece is 1 inside one whose normals point out, −1 inside one whose normals point in,
//! a hollow. A solid piece lies where all others together wind 0 times, a hollow where they do once.

use super::crossing::Crossing;
use super::facets::Facets;
use super::flaw::Flaw;
use crate::patch::NurbsPatch;
use crate::topology::Topology;
use glam::DVec3;
use std::f64::consts::TAU;

/// Patches of a piece from which it is asked where it lies.
const SAMPLES: usize = 16;

/// Flaws of the pieces that no other cuts.
pub(super) fn find(patches: &[NurbsPatch], facets: &Facets, topology: &Topology, crossings: &[Crossing]) -> Vec<Flaw> {
    let turn = |patch: usize| if patches[patch].flip { -1.0 } else { 1.0 };
    let piece_of = &topology.pieces();
    let mut pieces: Vec<usize> = piece_of.clone();
    pieces.sort_unstable();
    pieces.dedup();
    if pieces.len() < 2 {
        return Vec::new();
    }
    let is_cut = |piece: usize| {
        crossings.iter().any(|crossing| {
            let [a, b] = crossing.patches.map(|patch| piece_of[patch]);
            a != b && (a == piece || b == piece)
        })
    };
    let is_closed =
        |piece: usize| topology.edges.iter().all(|edge| edge.partner.is_some() || piece_of[edge.owner.patch] != piece);
    let closed: Vec<usize> = pieces.into_iter().filter(|piece| is_closed(*piece)).collect();
    let patches_of = |piece: usize| (0..piece_of.len()).filter(move |patch| piece_of[*patch] == piece);
    let winding = |piece: usize, at: DVec3| -> f64 {
        patches_of(piece).map(|patch| turn(patch) * angles(facets, patch, at)).sum::<f64>() / TAU
    };
    let volume = |piece: usize| patches_of(piece).map(|patch| turn(patch) * flux(facets, patch)).sum::<f64>();
    let flaw = |&piece: &usize| {
        let hollow = volume(piece) < 0.0;
        // Where pieces touch, a point says nothing; one that is clear of the others does.
        let places = patches_of(piece).take(SAMPLES).filter_map(|patch| facets.patches[patch].first());
        let counts = places.map(|cell| {
            let at = cell.corners.iter().sum::<DVec3>() * 0.25;
            closed.iter().filter(|other| **other != piece).map(|other| winding(*other, at)).sum::<f64>().round() as i32
        });
        let inside = if hollow { counts.max() } else { counts.min() }?;
        let is_right = inside == i32::from(hollow);
        let patch = patches_of(piece).next()?;
        (!is_right && !is_cut(piece)).then_some(Flaw::Nested { patch, inside, hollow })
    };
    closed.iter().filter_map(flaw).collect()
}

/// Half of the solid angles of a patch's facets, seen from a point (A. van Oosterom and J. Strackee, *The solid angle
/// of a plane triangle*, 1983).
fn angles(facets: &Facets, patch: usize, at: DVec3) -> f64 {
    let half = |[a, b, c]: [DVec3; 3]| {
        let [a, b, c] = [a - at, b - at, c - at];
        let [x, y, z] = [a.length(), b.length(), c.length()];
        a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    };
    facets.patches[patch].iter().flat_map(|cell| cell.triangles()).map(half).sum()
}

/// Six times the volume between a patch's facets and the origin.
fn flux(facets: &Facets, patch: usize) -> f64 {
    facets.patches[patch].iter().flat_map(|cell| cell.triangles()).map(|[a, b, c]| a.dot(b.cross(c))).sum()
}
