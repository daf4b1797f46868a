//! Projected Newton for `½ ‖ΔR‖²` over the unit square, after Bertsekas (1982).

use crate::oracle::OraclePoint;
use glam::DVec3;
use palpate_bake::NurbsPatch;

/// The usual share of the fall that the slope promises (Armijo).
const SUFFICIENT: f64 = 1e-4;
/// Halvings after which a step no longer moves a double.
const HALVINGS: usize = 50;

/// One step: the Hessian where it is positive definite, the first fundamental form where not; parameters that press
/// outward are held; halved until the distance falls enough. `None` at a stationary point.
pub(super) fn step(patch: &NurbsPatch, surface: &OraclePoint, at: [f64; 2], probe: DVec3) -> Option<[f64; 2]> {
    let difference = surface.point - probe;
    let gradient = [difference.dot(surface.tangent_u), difference.dot(surface.tangent_v)];
    let is_outward = |i: usize, change: f64| (at[i] <= 0.0 && change < 0.0) || (at[i] >= 1.0 && change > 0.0);
    let mut held = [0, 1].map(|i| is_outward(i, -gradient[i]));
    let mut direction = direction(surface, difference, gradient, held);
    // The mixed term can turn a parameter that was free outward: then it is held as well.
    if let Some(i) = (0..2).find(|&i| is_outward(i, direction[i])) {
        held[i] = true;
        direction = self::direction(surface, difference, gradient, held);
    }
    let slope = gradient[0] * direction[0] + gradient[1] * direction[1];
    let value = 0.5 * difference.length_squared();
    let mut length = 1.0;
    for _ in 0..HALVINGS {
        let next = [0, 1].map(|i| (at[i] + length * direction[i]).clamp(0.0, 1.0));
        let there = 0.5 * OraclePoint::evaluate(patch, next[0], next[1]).point.distance_squared(probe);
        if next != at && there <= value + SUFFICIENT * length * slope {
            return Some(next);
        }
        length *= 0.5;
    }
    None
}

fn direction(surface: &OraclePoint, difference: DVec3, gradient: [f64; 2], held: [bool; 2]) -> [f64; 2] {
    let form = [surface.tangent_u.length_squared(), surface.tangent_v.length_squared()];
    let mixed = surface.tangent_u.dot(surface.tangent_v);
    let hessian = [form[0] + difference.dot(surface.second_uu), form[1] + difference.dot(surface.second_vv)];
    let hessian_mixed = mixed + difference.dot(surface.second_uv);
    let alone = |i: usize| -gradient[i] / if hessian[i] > 0.0 { hessian[i] } else { form[i] };
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, alone(1)],
        [false, true] => [alone(0), 0.0],
        [false, false] => {
            let is_positive = hessian[0] > 0.0 && hessian[0] * hessian[1] > hessian_mixed * hessian_mixed;
            let ([a, d], b) = if is_positive { (hessian, hessian_mixed) } else { (form, mixed) };
            let determinant = a * d - b * b;
            [(b * gradient[1] - d * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
        }
    }
}
