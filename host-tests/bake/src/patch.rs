//! A NURBS patch in double precision.

use glam::DVec3;
use std::fmt;

/// Points nearer than this, in sizes of the body, are one.
pub const TOLERANCE: f64 = 1e-6;

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
        borders(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// How many derivatives the knots along one parameter leave continuous; `None` without inner knots.
    pub fn continuity(&self, axis: Axis) -> Option<usize> {
        continuity(&self.knots[axis as usize], self.degree[axis as usize])
    }

    /// The inner knots along one parameter at which the patch is only C⁰.
    pub fn creases(&self, axis: Axis) -> Vec<f64> {
        creases(&self.knots[axis as usize], self.degree[axis as usize])
    }
}

// Which parameter.

/// One of the two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// `u`, along the rows.
    U,
    /// `v`, along the columns.
    V,
}

impl fmt::Display for Axis {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::U => "u",
            Self::V => "v",
        })
    }
}

// Knot vectors: their spans, and how smooth they leave a patch.

/// The knots of a Bézier patch.
pub(super) fn bezier(degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree + 1];
    knots.resize(2 * (degree + 1), 1.0);
    knots
}

/// The distinct knots within the range, from 0 to 1: the borders of the spans.
pub(super) fn borders(knots: &[f64], degree: usize) -> Vec<f64> {
    let mut borders = knots[degree..knots.len() - degree].to_vec();
    borders.dedup();
    borders
}

/// How many derivatives are continuous at all inner knots; `None` if there are no inner knots.
pub(super) fn continuity(knots: &[f64], degree: usize) -> Option<usize> {
    let inner = knots.chunk_by(|a, b| a == b).filter(|group| 0.0 < group[0] && group[0] < 1.0);
    inner.map(|group| degree - group.len()).min()
}

/// The inner knots at which only the points themselves are continuous.
pub(super) fn creases(knots: &[f64], degree: usize) -> Vec<f64> {
    let inner = knots.chunk_by(|a, b| a == b).filter(|group| 0.0 < group[0] && group[0] < 1.0);
    inner.filter(|group| group.len() >= degree).map(|group| group[0]).collect()
}
