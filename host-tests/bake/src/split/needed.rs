//! What the tables cannot hold whole.
//!
//! - *Closed patches*: a face that meets itself along a seam is its own neighbour, and a probe that has left it has
//!   not.
//! - *Wide poles*: the region of a face at its pole lies between the separators of its two sides there, which cut out a
//!   wedge only if the sides span less than half a turn.
//! - *Creases*: at a knot of full multiplicity the patch need not be smooth, and nothing that is proved of it holds
//!   across.

use super::{Cut, Piece};
use crate::topology::{Border, BorderRole, Topology};
use crate::{Axis, NurbsPatch};
use glam::DVec3;
use std::f64::consts::PI;

/// Points along a pole's side between which the turning of the tangents is added up.
const SAMPLES: usize = 64;
/// Half a turn, less the rounding of a model's decimals.
const WIDE: f64 = PI * (1.0 - 1e-6);

/// The cuts that are needed, without those that follow from them.
pub(super) fn cuts(pieces: &[Piece], topology: &Topology) -> Vec<Cut> {
    let mut all = Vec::new();
    for (piece, Piece { patch, .. }) in pieces.iter().enumerate() {
        for axis in [0, 1] {
            let creases = creases(patch, axis);
            let at = if !creases.is_empty() {
                creases
            } else if is_closed(topology, piece, axis) {
                vec![1.0 / 3.0, 2.0 / 3.0]
            } else if is_wide_pole(patch, topology, piece, axis) {
                vec![0.5]
            } else {
                continue;
            };
            all.extend(at.into_iter().map(|at| Cut { piece, axis, at }));
        }
    }
    all
}

/// Inner knots of full multiplicity.
fn creases(patch: &NurbsPatch, axis: usize) -> Vec<f64> {
    let inner = patch.borders(if axis == 0 { Axis::U } else { Axis::V });
    let times = |at: f64| patch.knots[axis].iter().filter(|knot| **knot == at).count();
    let inside = inner.into_iter().filter(|at| 0.0 < *at && *at < 1.0);
    inside.filter(|at| times(*at) >= patch.degree[axis]).collect()
}

/// Whether both borders at the ends of a parameter are one edge.
fn is_closed(topology: &Topology, piece: usize, axis: usize) -> bool {
    let edge = |side: usize| match topology.roles[piece][side] {
        BorderRole::Edge { edge, .. } => Some(edge),
        BorderRole::Pole { .. } => None,
    };
    edge(2 * axis).is_some() && edge(2 * axis) == edge(2 * axis + 1)
}

/// Whether a side along which a parameter runs is a pole whose sector spans half a turn or more.
fn is_wide_pole(patch: &NurbsPatch, topology: &Topology, piece: usize, axis: usize) -> bool {
    let mut sides = (0..4).map(|side| Border { patch: piece, side }).filter(|border| border.axis() == axis);
    sides.any(|border| {
        let is_pole = matches!(topology.roles[piece][border.side], BorderRole::Pole { .. });
        is_pole && sector(patch, border) >= WIDE
    })
}

/// The angle through which the tangents across a pole turn about its axis, radians. Their tips lie on a circle about
/// the axis, in the pole's tangent plane or, on a cone, above it.
fn sector(patch: &NurbsPatch, border: Border) -> f64 {
    let directions = (0..=SAMPLES).map(|k| border.at(patch, k as f64 / SAMPLES as f64).across.normalize_or_zero());
    let directions: Vec<_> = directions.collect();
    let off = |index: usize| directions[index] - directions[0];
    let axis = (1..SAMPLES).map(|k| off(k).cross(off(k + 1))).sum::<DVec3>().normalize_or_zero();
    let around = |direction: DVec3| direction - axis * direction.dot(axis);
    let turn = |a: DVec3, b: DVec3| a.cross(b).length().atan2(a.dot(b));
    directions.windows(2).map(|pair| turn(around(pair[0]), around(pair[1]))).sum()
}
