//! From where each method finds the closest point of a patch.

use alloc::vec::Vec;
use palpate::math::Vec3;
use palpate::patch::{Patch as _, SplinePatch};
use palpate::track::{Controller, FirstOrder, Outcome, Probe, Witness};

use crate::newton::Newton;

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
            0 => Self::Certified(Controller::SECOND_ORDER),
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
