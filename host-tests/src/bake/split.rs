//! Pieces of a model's patches.

use super::model::Model;
use super::patch::NurbsPatch;

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

/// What messages call a piece: its patch, and which part of it unless it is the whole.
pub fn label(source: Provenance, model: &Model) -> String {
    let Provenance { patch, lower, upper } = source;
    let name = model.patches[patch].name.as_ref().map_or_else(|| patch.to_string(), |name| format!("\"{name}\""));
    if source == Provenance::whole(patch) {
        return name;
    }
    format!("{name} (u {:.4} to {:.4}, v {:.4} to {:.4})", lower[0], upper[0], lower[1], upper[1])
}
