//! Pieces, and where they are from.

use crate::model::Model;
use crate::patch::NurbsPatch;

/// Which part of a model a piece is: `(u, v)` of the piece is `lower + (u, v) · (upper − lower)` of the patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Provenance {
    /// Index of the patch.
    pub patch: usize,
    /// The least parameters.
    pub lower: [f64; 2],
    /// The greatest.
    pub upper: [f64; 2],
}

impl Provenance {
    /// The whole of a patch.
    pub const fn whole(patch: usize) -> Self {
        Self { patch, lower: [0.0; 2], upper: [1.0; 2] }
    }

    /// A part of this part, from `low` to `high` of its own parameter along one axis.
    pub fn part(&self, axis: usize, low: f64, high: f64) -> Self {
        let mut part = *self;
        let width = self.upper[axis] - self.lower[axis];
        part.lower[axis] = self.lower[axis] + low * width;
        // Ends stay the ends to the last bit.
        part.upper[axis] = if high == 1.0 { self.upper[axis] } else { self.lower[axis] + high * width };
        part
    }

    /// The parameters of the model's patch at those of the piece.
    pub fn parameters(&self, piece: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| self.lower[axis] + piece[axis] * (self.upper[axis] - self.lower[axis]))
    }
}

/// A piece with where it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The surface over the unit square.
    pub patch: NurbsPatch,
    /// Its place in the model.
    pub source: Provenance,
}

impl Piece {
    /// Every patch of a model, whole.
    pub fn whole(model: &Model) -> Vec<Self> {
        let whole =
            |(patch, surface): (usize, &NurbsPatch)| Self { patch: surface.clone(), source: Provenance::whole(patch) };
        model.patches.iter().enumerate().map(whole).collect()
    }
}
