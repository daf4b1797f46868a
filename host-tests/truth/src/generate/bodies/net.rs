//! A patch as control points and knots, and the text of a model file.

use std::fmt::Write as _;

/// A patch: `points[i][j] = [x, y, z, w]`, not multiplied by the weight; its normal `f_u × f_v` points outward unless
/// it is flipped.
#[derive(Clone, Debug)]
pub(super) struct Net {
    pub degree: [usize; 2],
    /// From 0 to 1; without inner ones it is a Bézier patch.
    pub inner_knots: [Vec<f64>; 2],
    pub points: Vec<Vec<[f64; 4]>>,
    pub flip: bool,
}

impl Net {
    /// A Bézier patch of as high a degree as its points make it.
    pub fn bezier(points: Vec<Vec<[f64; 4]>>) -> Self {
        let degree = [points.len() - 1, points.first().map_or(0, Vec::len) - 1];
        Self { degree, inner_knots: [vec![], vec![]], points, flip: false }
    }

    /// Four corners.
    pub fn bilinear(corners: [[[f64; 3]; 2]; 2]) -> Self {
        Self::bezier(corners.map(|row| row.map(plain).to_vec()).to_vec())
    }

    pub fn flipped(self, flip: bool) -> Self {
        Self { flip, ..self }
    }
}

/// A control point of weight 1.
pub(super) fn plain([x, y, z]: [f64; 3]) -> [f64; 4] {
    [x, y, z, 1.0]
}

/// The file. Every number is the shortest decimal that reads back as the same `f64`.
pub(super) fn text(name: &str, nets: &[Net]) -> String {
    let mut text = format!("name = \"{name}\"\nunit = \"mm\"\n");
    for net in nets {
        let Net { degree, inner_knots, points, flip } = net;
        let clamped = |axis: usize| {
            [vec![0.0; degree[axis] + 1], inner_knots[axis].clone(), vec![1.0; degree[axis] + 1]].concat()
        };
        // A zero has no sign in a file.
        let rows: Vec<Vec<_>> =
            points.iter().map(|row| row.iter().map(|point| point.map(|x| x + 0.0)).collect()).collect();
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n[[patch]]\ndegree = {degree:?}\nflip = {flip}\nknots_u = {:?}\nknots_v = {:?}\npoints = {rows:?}\n",
            clamped(0),
            clamped(1)
        );
    }
    text
}
