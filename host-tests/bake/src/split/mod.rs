//! Pieces of a model's patches: what cannot be baked whole is cut, and so are its neighbours where the cut runs out
//! into them.
//!
//! [`prepared`] cuts what the tables cannot hold: patches that close on themselves, sectors of a pole of half a turn or
//! more, and creases. [`cut`] cuts where it is asked to, for a patch that fails a certificate.

mod knots;
mod needed;
mod piece;
mod strips;

pub use knots::cut_in_two;
pub use piece::{Piece, Provenance};
pub use strips::{Cut, cut};

use super::error::{ModelError, PatchFault};
use super::model::Model;
use super::spline;
use super::topology::{SeamFault, Topology};
use palpate::body::MAX_FACES;

/// Cuts that are found one after the other: closed patches first, then what is left of poles and creases.
const ROUNDS: usize = 8;

/// A model in pieces that the tables can hold.
///
/// # Errors
/// Weights too uneven for `f32`; what is wrong between its patches; more pieces than a body can have.
pub fn prepared(model: &Model, file: &str) -> Result<Vec<Piece>, ModelError> {
    let mut pieces = Piece::whole(model);
    for piece in &pieces {
        // What is wrong with a patch is said before what is wrong between patches.
        let uneven = |spline::UnevenSpan([u, v])| ModelError::Patch {
            file: file.to_owned(),
            patch: label(piece.source, model),
            fault: PatchFault::Uneven { u, v },
        };
        spline::extract(&piece.patch).map_err(uneven)?;
    }
    // Looked at before the work begins, and again after each cut.
    let too_many = |count: usize| ModelError::Seam {
        file: file.to_owned(),
        fault: SeamFault::TooMany { count, limit: MAX_FACES },
    };
    if pieces.len() > MAX_FACES {
        return Err(too_many(pieces.len()));
    }
    for _ in 0..ROUNDS {
        let topology = topology(&pieces, model, file)?;
        let wanted = needed::cuts(&pieces, &topology);
        if wanted.is_empty() {
            break;
        }
        pieces = cut(&pieces, &topology, &wanted);
        if pieces.len() > MAX_FACES {
            return Err(too_many(pieces.len()));
        }
    }
    Ok(pieces)
}

/// How pieces hang together.
///
/// # Errors
/// What is wrong between them.
pub fn topology(pieces: &[Piece], model: &Model, file: &str) -> Result<Topology, ModelError> {
    let patches: Vec<_> = pieces.iter().map(|piece| piece.patch.clone()).collect();
    Topology::new(&patches, &|index| label(pieces[index].source, model))
        .map_err(|fault| ModelError::Seam { file: file.to_owned(), fault })
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
