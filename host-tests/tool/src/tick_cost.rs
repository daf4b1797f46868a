//! The bound of a tick in modelled cycles of a Cortex-M4F: the evaluations of [`Body::worst_tick`], each with the
//! instructions that the emulator counts for it, at the upper end of the model of `palpate cycles`.

use palpate::body::{Body, Face, Separator, Side, SplineCurve, TickWork};
use palpate::patch::Coefficients;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Cycles of an instruction at the upper end of the model, tenths: the highest of the roots of `palpate cycles`,
/// 404 for 185 in an evaluation of degree (3, 3).
const CYCLES_OF_TEN: u32 = 22;
/// Instructions of a tick beside its evaluations: the row "servo tick, smooth, worst", evaluations included.
const BESIDE: &str = "servo tick, smooth, worst";
/// Instructions of a step or of a search with an evaluation of a patch of [`EVALUATION`].
const STEP: &str = "closest point of the capped box, any, worst";
const EVALUATION: &str = "second order, polynomial, degree (3, 3)";
/// Instructions to find the spans of a patch or curve of several: eight rounds of bisection along each parameter.
const SPANS: u32 = 2 * 8 * 12;
/// Instructions of a look at a spoke with its edge, that edge's two faces and their curvature.
const SPOKE: u32 = 40;

#[derive(Deserialize)]
struct Budget {
    instructions: BTreeMap<String, u32>,
}

impl Budget {
    fn of(&self, row: &str) -> u32 {
        self.instructions.get(row).copied().unwrap_or_else(|| panic!("host-tests/budgets/m4.toml: no row {row:?}"))
    }

    fn patch(&self, face: &Face<'_>) -> u32 {
        let patch = &face.patch;
        let [u, v] = patch.degree().map(u32::from);
        // Degrees that differ are evaluated by rows, as those above 3 are.
        let degree = if u == v { u } else { u.max(v).max(4) };
        let kind = kind(patch.coefficients());
        let spans = if patch.breaks().iter().all(|breaks| breaks.len() == 2) { 0 } else { SPANS };
        let step = self.of(STEP) - self.of(EVALUATION);
        self.of(&format!("second order, {kind}, degree ({degree}, {degree})")) + spans + step
    }

    /// In proportion to the degree, of the row of the highest.
    fn curve(&self, curve: &SplineCurve<'_>) -> u32 {
        let all = self.of(&format!("curve, {}, degree 10", kind(curve.coefficients)));
        let spans = if curve.breaks.len() == 2 { 0 } else { SPANS / 2 };
        all * (u32::from(curve.degree) + 3).min(11) / 11 + spans
    }
}

const fn kind(coefficients: Coefficients<'_>) -> &'static str {
    match coefficients {
        Coefficients::Polynomial(_) => "polynomial",
        Coefficients::Rational(_) => "rational",
    }
}

/// Bound of the modelled cycles of a servo tick on a body.
///
/// # Panics
/// If the budget file in the repository lacks a row.
pub fn cycles(body: &Body<'_>) -> u32 {
    let budget: Budget = toml::from_str(include_str!("../../budgets/m4.toml")).expect("host-tests/budgets/m4.toml");
    let separators = body.faces().iter().flat_map(|face| &face.sides).filter_map(|side| match side {
        Side::Edge { separator: Separator::Ruled(curve), .. } => Some(curve),
        _ => None,
    });
    let curves = body.edges().iter().map(|edge| &edge.curve).chain(separators);
    let weights = TickWork {
        patches: body.faces().iter().map(|face| budget.patch(face)).max().unwrap_or(0),
        curves: curves.map(|curve| budget.curve(curve)).max().unwrap_or(0),
        spokes: SPOKE,
    };
    (body.worst_tick(weights).cost + budget.of(BESIDE)) * CYCLES_OF_TEN / 10
}
