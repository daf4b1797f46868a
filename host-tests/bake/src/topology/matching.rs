//! Which borders are one curve.
//!
//! Two borders are one edge if they are the same *parametrised* curve, or the same run the other way: then the
//! parameter of one is the parameter of the other, and the edge needs one curve. The same curve with another
//! parametrisation is an error with a name of its own, see `super::partial`.

use super::border::Border;
use crate::NurbsPatch;
use glam::DVec3;

/// Points a span at which borders are compared. A span of a border is rational of degree 5 at most; two that agree at
/// 11 parameters agree everywhere, 16 leave some for conditioning.
const SAMPLES: usize = 16;

/// How two borders run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// The same way.
    Same,
    /// Against each other.
    Reversed,
}

impl Sense {
    /// The parameter of the second border at `t` of the first.
    pub const fn apply(self, t: f64) -> f64 {
        match self {
            Self::Same => t,
            Self::Reversed => 1.0 - t,
        }
    }
}

/// A border with what comparing needs at once.
#[derive(Clone, Debug)]
pub struct Candidate<'a> {
    /// Which.
    pub border: Border,
    /// Its patch.
    pub patch: &'a NurbsPatch,
    /// Its ends.
    pub ends: [DVec3; 2],
    /// Points at `k / (count − 1)`.
    pub points: Vec<DVec3>,
}

impl<'a> Candidate<'a> {
    /// Samples a border.
    pub fn new(border: Border, patch: &'a NurbsPatch) -> Self {
        let axis = border.axis();
        let spans = patch.knots[axis].windows(2).filter(|pair| pair[0] < pair[1]).count();
        let intervals = SAMPLES * spans;
        let points: Vec<_> = (0..=intervals).map(|k| border.point(patch, k as f64 / intervals as f64)).collect();
        Self { border, patch, ends: [points[0], points[intervals]], points }
    }

    /// Whether it is one point, within the tolerance.
    pub fn is_pole(&self, tolerance: f64) -> bool {
        self.points.iter().all(|point| point.distance(self.points[0]) <= tolerance)
    }

    /// Length of the polyline through its samples.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Whether another border is the same curve, and how it runs.
    pub fn sense_of(&self, other: &Self, tolerance: f64) -> Option<Sense> {
        [Sense::Same, Sense::Reversed].into_iter().find(|sense| {
            let ends = if *sense == Sense::Same { other.ends } else { [other.ends[1], other.ends[0]] };
            let ends_agree = self.ends.iter().zip(&ends).all(|(a, b)| a.distance(*b) <= tolerance);
            ends_agree && (self.controls_agree(other, *sense, tolerance) || self.deviation(other, *sense) <= tolerance)
        })
    }

    /// The greatest distance at equal parameters, on the finer of both grids.
    pub fn deviation(&self, other: &Self, sense: Sense) -> f64 {
        let (fine, coarse) = if self.points.len() >= other.points.len() { (self, other) } else { (other, self) };
        let intervals = (fine.points.len() - 1) as f64;
        let at = |(k, point): (usize, &DVec3)| {
            point.distance(coarse.border.point(coarse.patch, sense.apply(k as f64 / intervals)))
        };
        fine.points.iter().enumerate().map(at).fold(0.0, f64::max)
    }

    /// Whether knots and weights agree and all control points do: then the curves do everywhere, for a point is a mean
    /// of control points.
    fn controls_agree(&self, other: &Self, sense: Sense, tolerance: f64) -> bool {
        let (axis, axis_other) = (self.border.axis(), other.border.axis());
        if self.patch.degree[axis] != other.patch.degree[axis_other] {
            return false;
        }
        let (Some(own), Some(mut others)) = (self.border.controls(self.patch), other.border.controls(other.patch))
        else {
            return false;
        };
        let mut knots: Vec<f64> = other.patch.knots[axis_other].clone();
        if sense == Sense::Reversed {
            others.reverse();
            knots = knots.iter().rev().map(|knot| 1.0 - knot).collect();
        }
        let knots_agree = knots.len() == self.patch.knots[axis].len()
            && knots.iter().zip(&self.patch.knots[axis]).all(|(a, b)| (a - b).abs() <= f64::EPSILON);
        // Weights count up to a common factor.
        let factor = own[0].1 / others[0].1;
        let agree = |((a, v), (b, w)): (&(DVec3, f64), &(DVec3, f64))| {
            (v - factor * w).abs() <= 4.0 * f64::EPSILON * v && a.distance(*b) <= tolerance
        };
        knots_agree && own.iter().zip(&others).all(agree)
    }
}
