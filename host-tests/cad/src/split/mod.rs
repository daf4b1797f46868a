//! A face in pieces, along lines of its parameters: what is too much to be divided into quads at once.
//!
//! A line runs from where it comes into the face to where it leaves it ([`line`]); those stretches become edges of both
//! pieces, and the edges they meet are cut there in all faces ([`cut`]). Round a closed parameter that the face goes
//! all about there are two lines. Of many, the line is taken that has few and short stretches, meets the outline
//! squarely and far from its vertices, passes by nothing closely, and leaves as much on one side as on the other
//! ([`choice`]). What was one face's loops are the pieces' then ([`pieces`]).

mod cut;
mod line;

use crate::error::ImportError;
use crate::part::Part;
use crate::trace;
use line::Asked;

/// What is asked of a line at first, and then.
const ASKED: [Asked; 2] = [Asked { sine: 0.3, share: 0.07 }, Asked { sine: 0.12, share: 0.02 }];

/// Splits a face in two or more, in its place; says whether a way was found.
///
/// # Errors
/// What is wrong with its loops.
pub fn split(part: &mut Part, face: usize, tolerance: f64) -> Result<bool, ImportError> {
    let loops = trace::all(part, face, &part.faces[face].loops, tolerance)?;
    let Some(cut) = ASKED.iter().find_map(|asked| line::best(part, face, &loops, asked)) else { return Ok(false) };
    let pieces = cut::carry_out(part, face, &cut, tolerance)?;
    Ok(pieces > 1)
}
