//! A NURBS patch in double precision.

use super::axis::Axis;
use super::knots;
use glam::DVec3;

/// A NURBS patch over `[0, 1]²`, checked.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsPatch {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Degrees along `u` and `v`.
    pub degree: [usize; 2],
    /// Knots along `u` and `v`; the range is `[0, 1]`, knots of an unclamped vector lie outside.
    pub knots: [Vec<f64>; 2],
    /// Numbers of control points along `u` and `v`.
    pub counts: [usize; 2],
    /// Control points, metres, not multiplied by their weights; point `(i, j)` is entry `i · counts[1] + j`.
    pub points: Vec<DVec3>,
    /// Weights; the largest is 1.
    pub weights: Vec<f64>,
    /// The outward normal is `f_u × f_v`; true turns it round.
    pub flip: bool,
}

impl NurbsPatch {
    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|weight| *weight != self.weights[0])
    }

    /// The borders of the spans along one parameter, from 0 to 1.
    pub fn borders(&self, axis: Axis) -> Vec<f64> {
        knots::borders(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// How many derivatives the knots along one parameter leave continuous; `None` without inner knots.
    pub fn continuity(&self, axis: Axis) -> Option<usize> {
        knots::continuity(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// The inner knots along one parameter at which the patch is only C⁰.
    pub fn creases(&self, axis: Axis) -> Vec<f64> {
        knots::creases(&self.knots[axis as usize], self.degree[axis as usize])
    }
}
