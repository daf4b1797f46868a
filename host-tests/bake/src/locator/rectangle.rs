//! Rectangles of parameters on the grid of a list's entries.

use palpate::body::GRID;

/// A rectangle on the grid: least and greatest step along `u` and `v`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Rectangle {
    pub lower: [u8; 2],
    pub upper: [u8; 2],
}

impl Rectangle {
    /// The least one that holds a rectangle of parameters.
    pub(super) fn around([low, high]: [[f64; 2]; 2]) -> Self {
        let grid = f64::from(GRID);
        // A rectangle that ends on the grid, as all borders do, ends there; anything else is rounded outward by more
        // than rounding.
        Self {
            lower: low.map(|x| (x * grid + if x == 1.0 { 0.0 } else { -1e-9 }).floor().max(0.0) as u8),
            upper: high.map(|x| (x * grid + if x == 0.0 { 0.0 } else { 1e-9 }).ceil().min(grid) as u8),
        }
    }

    pub(super) fn hull(&self, other: &Self) -> Self {
        Self {
            lower: [0, 1].map(|axis| self.lower[axis].min(other.lower[axis])),
            upper: [0, 1].map(|axis| self.upper[axis].max(other.upper[axis])),
        }
    }

    pub(crate) fn parameters(&self) -> [[f64; 2]; 2] {
        [self.lower, self.upper].map(|corner| corner.map(|step| f64::from(step) / f64::from(GRID)))
    }
}
