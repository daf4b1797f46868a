//! Modelled cost of a tick on a Cortex-M4F: the counted instructions of each kind of evaluation (`host-tests/budgets`;
//! a test compares), at the cycles of an instruction at the upper end of the model of `palpate cycles`.

use super::curve::SplineCurve;
use crate::patch::{Coefficients, SplinePatch};

/// Instructions of a second-order evaluation of degree (n, n), 1 to 5: polynomial, rational.
const UNROLLED: [[u32; 5]; 2] = [[66, 138, 243, 497, 656], [125, 231, 460, 657, 869]];
/// The same of any other degree, by rows: at all, and for each coefficient of a span.
const BY_ROWS: [[u32; 2]; 2] = [[260, 36], [366, 47]];
/// Instructions of a curve of degree 10: polynomial, rational.
pub const CURVE: [u32; 2] = [357, 456];
/// Instructions of the dearest step or candidate of a search beside the evaluation of its patch.
pub const STEP: u32 = 770;
/// Instructions of a servo tick with one evaluation, whatever its rendering.
pub const SERVO: u32 = 1_850;
/// Instructions to find the spans of a patch of several: eight rounds of bisection along each parameter.
const SPANS: u32 = 2 * 8 * 12;
/// Instructions of a look at a spoke with its edge, that edge's two faces and their curvature.
pub(super) const SPOKE: u32 = 40;
/// Instructions to displace a point with its derivatives and the bounds of its patch.
pub(super) const WARP: u32 = 450;
/// Rounds of the search for the point at rest, each with a displacement, before a candidate is looked at.
const UNDO: u32 = 5;
/// Instructions of a mode in a tick: blended, pushed and moved; and in each round of stops.
const MODE: [u32; 2] = [460, 50];
/// Cycles of ten instructions: 404 for 185 in an evaluation of degree (3, 3), the highest of `palpate cycles`.
const CYCLES_OF_TEN: u32 = 22;

/// Cycles of a tick whose evaluations take these instructions.
pub(super) const fn cycles(evaluations: u32) -> u32 {
    (evaluations + SERVO) * CYCLES_OF_TEN / 10
}

/// Instructions of a body's modes in a tick.
pub const fn modes(count: u32) -> u32 {
    UNDO * WARP + count * (MODE[0] + (count + 1) * MODE[1])
}

const fn is_rational(coefficients: Coefficients<'_>) -> bool {
    matches!(coefficients, Coefficients::Rational(_))
}

/// Instructions of a second-order evaluation.
pub const fn evaluation([u, v]: [u8; 2], is_rational: bool) -> u32 {
    let kind = is_rational as usize;
    if u == v && u >= 1 && u <= 5 {
        return UNROLLED[kind][u as usize - 1];
    }
    let [all, each] = BY_ROWS[kind];
    all + each * (u as u32 + 1) * (v as u32 + 1)
}

/// Instructions of a step on a patch.
pub(super) const fn patch(patch: &SplinePatch<'_>) -> u32 {
    let [breaks_u, breaks_v] = patch.breaks();
    let spans = if breaks_u.len() == 2 && breaks_v.len() == 2 { 0 } else { SPANS };
    evaluation(patch.degree(), is_rational(patch.coefficients())) + spans + STEP
}

/// Instructions of a curve: in proportion to its degree.
pub(super) const fn curve(curve: &SplineCurve<'_>) -> u32 {
    let spans = if curve.breaks.len() == 2 { 0 } else { SPANS / 2 };
    let steps = curve.degree as u32 + 3;
    CURVE[is_rational(curve.coefficients) as usize] * (if steps < 11 { steps } else { 11 }) / 11 + spans
}
