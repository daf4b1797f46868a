//! Splits a face along lines of its parameters if it is too complex to be divided into quads at once.
//!
//! A line runs from the point where it enters the face to the point where it leaves it ([`line`]); those stretches
//! become edges of both pieces, and the edges that they meet are cut there in all faces ([`cut`]). If the face goes all
//! the way round a closed parameter, there are two lines. The chosen line has few and short stretches, meets the
//! outline squarely and far from its vertices, passes nothing closely, and halves the face ([`choice`]). The loops of
//! the face are then distributed to the pieces ([`pieces`]).

mod cut;
mod line;

use crate::error::ImportError;
use crate::part::Part;
use crate::trace;
use line::Asked;

/// Conditions of the first attempt and of the second.
const ASKED: [Asked; 2] = [Asked { sine: 0.3, share: 0.07 }, Asked { sine: 0.12, share: 0.02 }];

/// Splits a face in place into two or more; returns whether a way was found.
///
/// # Errors
/// A fault of its loops.
pub fn split(part: &mut Part, face: usize, tolerance: f64) -> Result<bool, ImportError> {
    let loops = trace::all(part, face, &part.faces[face].loops, tolerance)?;
    let Some(cut) = ASKED.iter().find_map(|asked| line::best(part, face, &loops, asked)) else { return Ok(false) };
    let pieces = cut::carry_out(part, face, &cut, tolerance)?;
    Ok(pieces > 1)
}
