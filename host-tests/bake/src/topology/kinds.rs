//! How the faces of an edge stand to each other.
//!
//! Seen from outside, an edge is a ridge where a face's plane has the other face below it: `N_A · m_B > 0`, with `N_A`
//! the outward normal of one face and `m_B` the conormal of the other that points out of *it*. The sine of the angle by
//! which the normals turn is that number, in absolute value. It is sampled, not proved.

use super::border::{Border, BorderPoint};
use super::matching::Sense;
use crate::NurbsPatch;
use palpate::body::EdgeKind;

/// Normals that turn by less than this (radians) count as equal. The distance to an edge that is taken for smooth is
/// wrong by at most the square of it times half the distance, 5e-9 of it: less than `f32` resolves. Coordinates of nine
/// digits turn normals by some 1e-8.
pub const SMOOTH_ANGLE: f64 = 1e-4;

/// Where an edge is looked at: the middles of this many intervals, never its ends, which may be poles.
const SAMPLES: usize = 64;

/// The kind of an edge with two faces.
pub fn kind(patches: &[NurbsPatch], faces: [Border; 2], sense: Sense) -> EdgeKind {
    let (mut ridge, mut valley, mut fold) = (false, false, false);
    for k in 0..SAMPLES {
        let t = (k as f64 + 0.5) / SAMPLES as f64;
        let [a, b] = [(faces[0], t), (faces[1], sense.apply(t))].map(|(face, t)| face.at(&patches[face.patch], t));
        match turn(&a, &b) {
            Turn::Ridge => ridge = true,
            Turn::Valley => valley = true,
            Turn::Fold => fold = true,
            Turn::None => {}
        }
    }
    match (ridge, valley, fold) {
        (_, _, true) | (true, true, _) => EdgeKind::Mixed,
        (true, false, _) => EdgeKind::Convex,
        (false, true, _) => EdgeKind::Reflex,
        (false, false, false) => EdgeKind::Smooth,
    }
}

enum Turn {
    None,
    Ridge,
    Valley,
    /// The faces lie on each other: a knife's edge or the bottom of a crack, this point alone cannot say.
    Fold,
}

fn turn(a: &BorderPoint, b: &BorderPoint) -> Turn {
    let sine = a.normal.dot(b.conormal());
    if sine > SMOOTH_ANGLE {
        Turn::Ridge
    } else if sine < -SMOOTH_ANGLE {
        Turn::Valley
    } else if a.normal.dot(b.normal) < 0.0 {
        Turn::Fold
    } else {
        Turn::None
    }
}
