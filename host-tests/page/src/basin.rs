//! From where each method finds the closest point of a patch.

use alloc::vec::Vec;
use palpate::math::Vec3;
use palpate::patch::{CurvedPoint, Patch as _, SplinePatch};
use palpate::track::{Controller, FirstOrder, Outcome, Probe, ProjectionErrors, Witness};

/// A method of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// One of palpate's laws.
    Certified(Controller),
    /// Newton's method.
    Newton(Newton),
}

impl Method {
    /// By its number on the page.
    pub const fn of(number: u32) -> Self {
        match number {
            0 => Self::Certified(Controller::SecondOrder),
            1 => Self::Certified(Controller::FirstOrder(FirstOrder::CERTIFIED)),
            2 => Self::Newton(Newton::Paper),
            3 => Self::Newton(Newton::Saturated),
            _ => Self::Newton(Newton::Textbook),
        }
    }
}

/// Steps after which a start has not arrived.
const MOST_STEPS: usize = 400;
/// A method rests where neither parameter moves by more.
const SETTLED: f32 = 1e-6;
/// Any: the certified gain does not depend on it.
const PERIOD: f32 = 1.0 / 4_000.0;

/// The way from a start: parameters, the start included. The last lie outside of `[0, 1]²` if the method left the
/// patch.
pub fn path(patch: &SplinePatch<'static>, probe: Vec3, start: [f32; 2], method: Method) -> Vec<[f32; 2]> {
    let mut path = Vec::with_capacity(32);
    path.push(start);
    let mut witness = Witness::at(patch, start[0], start[1]);
    let mut at = start;
    for _ in 0..MOST_STEPS {
        let next = match method {
            Method::Newton(newton) => newton.step(patch, at, probe),
            Method::Certified(controller) => {
                let step = controller.step(patch, &mut witness, Probe::at(probe), PERIOD);
                (step.outcome != Outcome::AtRest).then_some(witness.parameters)
            }
        };
        let Some(next) = next else { break };
        path.push(next);
        let moved = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
        at = next;
        // A rejected step is tried again at half its length.
        if is_outside(at) || moved < SETTLED && witness.halvings == 0 {
            break;
        }
    }
    path
}

/// For each of `columns` starts along `v` in a row of starts at `u`: how many steps, and the distance at the end in
/// metres, infinite outside of the patch.
pub fn row(patch: &SplinePatch<'static>, probe: Vec3, u: f32, columns: u32, method: Method, out: &mut Vec<f32>) {
    for column in 0..columns {
        let start = [u, (column as f32 + 0.5) / columns as f32];
        let way = path(patch, probe, start, method);
        let end @ [u, v] = way.last().copied().unwrap_or(start);
        let distance = if is_outside(end) { f32::INFINITY } else { patch.evaluate(u, v).point.distance(probe) };
        out.extend([(way.len() - 1) as f32, distance]);
    }
}

fn is_outside(parameters: [f32; 2]) -> bool {
    !parameters.iter().all(|parameter| (0.0..=1.0).contains(parameter))
}

// What the page shows beside the controller: Newton's method, as the paper compares with it, in the `f32` of the
// firmware's own tables.

/// Which errors it drives to zero, and what it does at a border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Newton {
    /// The paper's: the measure numbers `Ψ` of Eq. (4); what leaves the patch has failed.
    Paper,
    /// The same with saturation: a parameter that would pass its border stops there.
    Saturated,
    /// The textbooks': the gradient of `½ ‖ΔR‖²` by its Hessian, with saturation.
    Textbook,
}

impl Newton {
    /// The next parameters, outside of `[0, 1]²` where the method leaves it; `None` where its matrix is singular.
    pub fn step(self, patch: &SplinePatch<'static>, [u, v]: [f32; 2], probe: Vec3) -> Option<[f32; 2]> {
        let at = patch.evaluate_curved(u, v);
        let (errors, matrix) = if self == Self::Textbook { hessian(&at, probe) } else { measured(&at, probe)? };
        let ([first, second], [[a, b], [c, d]]) = (errors, matrix);
        let determinant = a * d - b * c;
        let next = [u + (b * second - d * first) / determinant, v + (c * first - a * second) / determinant];
        if !next.iter().all(|parameter| parameter.is_finite()) {
            return None;
        }
        Some(if self == Self::Paper { next } else { next.map(|parameter| parameter.clamp(0.0, 1.0)) })
    }
}

/// `g` and its derivative `I + ΔR · D²f`.
fn hessian(at: &CurvedPoint, probe: Vec3) -> ([f32; 2], [[f32; 2]; 2]) {
    let errors = ProjectionErrors::new(&at.surface, probe);
    let [uu, uv, vv] = at.second.along(errors.difference);
    let mixed = errors.form.f + uv;
    (errors.gradient, [[errors.form.e + uu, mixed], [mixed, errors.form.g + vv]])
}

/// `Ψ = I⁻¹ g` and its derivative `M = 1 + I⁻¹ B`, `B_ik = Δ N · f_ik − f_i · Σ_j f_jk Ψ_j`, where `Δ N` is the
/// normal part of `ΔR` (the paper's Figure 2). `None` where the tangents span no plane.
fn measured(at: &CurvedPoint, probe: Vec3) -> Option<([f32; 2], [[f32; 2]; 2])> {
    let errors = ProjectionErrors::new(&at.surface, probe);
    let psi = errors.measure_numbers()?;
    let tangents = [at.surface.tangent_u, at.surface.tangent_v];
    let mixed = at.second.uv;
    let seconds = [[at.second.half_uu * 2.0, mixed], [mixed, at.second.half_vv * 2.0]];
    let normal_part = errors.difference - tangents[0] * psi[0] - tangents[1] * psi[1];
    let (form, determinant) = (errors.form, errors.form.determinant());
    let column = |k: usize| {
        let turning = seconds[0][k] * psi[0] + seconds[1][k] * psi[1];
        let [x, y] = [0, 1].map(|i: usize| normal_part.dot(seconds[i][k]) - tangents[i].dot(turning));
        [(form.g * x - form.f * y) / determinant, (form.e * y - form.f * x) / determinant]
    };
    let [along_u, along_v] = [column(0), column(1)];
    Some((psi, [[1.0 + along_u[0], along_v[0]], [along_u[1], 1.0 + along_v[1]]]))
}
